"""How long planning takes: Table II of the paper."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from mrta_zoo.eval.machine import Machine
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Picture, Section, Table
from mrta_zoo.eval.reproduce import paper
from mrta_zoo.eval.reproduce.figures import draw_seconds
from mrta_zoo.eval.reproduce.results import Group, Results
from mrta_zoo.wording import counted


def timing_section(results: Results, machines: Sequence[Machine]) -> Section:
    """Time for a whole mission and for a decision, by method and number of tasks."""
    times = times_of(results)
    sizes = results.sizes
    theirs = any(method in paper.SECONDS for method in results.methods) and 100 in sizes
    shown = []
    for method in results.methods:
        cells = {"method": method}
        for tasks in sizes:
            (line,) = times[(times["tasks"] == tasks) & (times["method"] == method)].to_dict("records")
            cells[f"mission, {counted(tasks, 'task')}"] = wording.seconds(line["mean"])
            cells[f"decision, {counted(tasks, 'task')}"] = (
                wording.DASH if pd.isna(line["per_decision"]) else wording.seconds(line["per_decision"])
            )
        if theirs:
            found = paper.SECONDS.get(method)
            cells["paper, 100 tasks"] = wording.DASH if found is None else wording.seconds(found)
        shown.append(cells)
    counts = wording.listed([f"{results.cases(Group(tasks))} with {counted(tasks, 'task')}" for tasks in sizes])
    caption = (
        "Time to plan a whole mission, mean over the cases, and the same time divided by the tasks completed, which is "
        "the time for one decision of methods that decide task by task. Wall clock, one mission at a time, on the "
        f"machine named at the end. n = {counts}. Means of what was measured, without intervals. Methods that "
        "search take what budget they are given; by default ils and eils stop by themselves."
    )
    if theirs:
        caption += f" Last column: Table II of the paper ({paper.SOURCE}), measured on another machine."
    return Section(
        title="Planning time",
        text=("Times are comparable within this report, and with others only as ratios.", *busy_note(machines)),
        pictures=(
            Picture(
                name="planning_time",
                caption="Time to plan a whole mission. Mark and number: mean; line: fastest to slowest case. "
                f"n = {counts}.",
                figure=draw_seconds(results, times),
                data=times,
            ),
        ),
        tables=(Table(name="planning_time_table", caption=caption, shown=pd.DataFrame(shown), data=times),),
    )


def busy_note(machines: Sequence[Machine]) -> tuple[str, ...]:
    """A warning if others were at work on the machine; nothing if not."""
    loads = [f"{machine.load:g}" for machine in machines if machine.busy]
    if not loads:
        return ()
    return (
        f"Beware: the machine was busy with other work while this was measured (load {wording.listed(loads)} at the "
        f"beginning, on {counted(machines[0].cores, 'core')}), so times are longer than they would be alone, "
        "and not equally so for all methods. Measure again on a quiet machine before quoting them.",
    )


def times_of(results: Results) -> pd.DataFrame:
    """Seconds by method and number of tasks: mean, median, fastest, slowest, and mean for each completed task."""
    grouped = results.frame.groupby(["method", "tasks"], sort=False)
    times = grouped["seconds"].agg(cases="count", mean="mean", median="median", fastest="min", slowest="max")
    completed = grouped["completed"].sum()
    return times.assign(per_decision=(grouped["seconds"].sum() / completed).where(completed > 0)).reset_index()
