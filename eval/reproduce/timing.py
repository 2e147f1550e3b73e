"""How long planning takes: Table II of the paper."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from mrta_zoo.eval.machine import Machine
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.made import busy_note
from mrta_zoo.eval.report.parts import Section, Table
from mrta_zoo.eval.reproduce.results import Results
from mrta_zoo.wording import counted


def timing_section(results: Results, machines: Sequence[Machine]) -> Section:
    """Time for a whole mission and for a decision, by method and number of tasks."""
    times = times_of(results)
    shown = pd.DataFrame({"method": results.methods})
    for tasks, of_size in times.groupby("tasks"):
        size = counted(int(str(tasks)), "task")
        for title, column in (("mission", "mean"), ("slowest", "slowest"), ("decision", "per_decision")):
            cells = [wording.DASH if pd.isna(each) else wording.seconds(each) for each in of_size[column]]
            shown[f"{title}, {size}"] = cells
    caption = (
        "Time to plan a whole mission, mean over the cases and slowest case, and the mean divided by the tasks "
        "completed, which is the time for one decision of methods that decide task by task. Wall clock, one mission at "
        "a time, without intervals. Methods that search take what budget they are given; by default ils and eils stop "
        "by themselves."
    )
    return Section(
        title="Planning time",
        text=("Times are comparable within this report, and with others only as ratios.", *busy_note(machines)),
        tables=(Table(name="planning_time", caption=caption, shown=shown, data=times),),
    )


def times_of(results: Results) -> pd.DataFrame:
    """Seconds by method and number of tasks: mean, median, fastest, slowest, and mean for each completed task."""
    grouped = results.frame.groupby(["method", "tasks"], sort=False)
    times = grouped["seconds"].agg(cases="count", mean="mean", median="median", fastest="min", slowest="max")
    completed = grouped["completed"].sum()
    return times.assign(per_decision=(grouped["seconds"].sum() / completed).where(completed > 0)).reset_index()
