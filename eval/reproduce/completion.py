"""How many tasks each method completes: Fig. 3 of the paper, as box plots and as a table."""

from __future__ import annotations

from collections.abc import Callable

import pandas as pd

from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Picture, Section, Table
from mrta_zoo.eval.reproduce.figures import draw_boxes
from mrta_zoo.eval.reproduce.results import Results, tidy
from mrta_zoo.eval.significance import Estimate
from mrta_zoo.wording import counted


def completion_section(results: Results) -> Section:
    """Box plots and means by number of robots, one of each for each number of tasks."""
    pictures, tables = [], []
    for tasks in results.sizes:
        rows = results.frame[results.frame["tasks"] == tasks]
        pictures.append(
            Picture(
                name=f"completion_boxes_{tasks}",
                caption=f"Tasks completed in time, % of the {counted(tasks, 'task')} of a case, by number of "
                f"robots (as Fig. 3 of "
                f"the paper). {case_counts(results, tasks)} Dots: single cases; box: middle half of the cases with the "
                "median; whiskers: furthest case within 1.5 times the length of the box; white diamond: mean.",
                figure=draw_boxes(results, tasks),
                data=rows[["case", "method", "tasks", "robots", "completed", "percent"]],
            )
        )
        tables.append(
            estimate_table(
                results, tasks, "percent", f"completion_{tasks}",
                f"Tasks completed in time, mean % of the {counted(tasks, 'task')} of a case, with the "
                f"{wording.INTERVAL} of the "
                f"mean in brackets ({wording.BOOTSTRAP}). "
                f"{case_counts(results, tasks)} Bold: the highest mean of a column, be the lead significant or not.",
            )
        )  # fmt: skip
    return Section(title="Tasks completed", pictures=tuple(pictures), tables=tuple(tables))


def case_counts(results: Results, tasks: int) -> str:
    """How many cases each column stands on."""
    counts = {group.label: results.cases(group) for group in results.groups(tasks)}
    different = set(list(counts.values())[1:] or counts.values())
    total = f"n = {counted(next(iter(counts.values())), 'case')}"
    if len(counts) == 1:
        return f"{total}."
    if len(different) == 1:
        return f"{total}, {different.pop()} for each number of robots."
    return f"{total}: {', '.join(f'{count} with {label}' for label, count in list(counts.items())[1:])}."


def estimate_table(
    results: Results,
    tasks: int,
    column: str,
    name: str,
    caption: str,
    cell: Callable[[Estimate], str] = wording.percentage,
) -> Table:
    """Means of a column with intervals: a line for each method, a column for each group of cases.

    Args:
        results: what was measured.
        tasks: of cases with so many tasks.
        column: of the results' frame; more is better.
        name: of the table.
        caption: of the table.
        cell: writes a mean with its interval.
    """
    groups = results.groups(tasks)
    found = {(method, group): estimate for method, group, estimate in results.estimates(tasks, column)}
    shown = pd.DataFrame(
        [
            {"method": method, **{group.label: cell(found[method, group]) for group in groups}}
            for method in results.methods
        ]
    )
    best = {group: max(round(found[method, group].mean, 6) for method in results.methods) for group in groups}
    bold = frozenset(
        (row, column_number)
        for row, method in enumerate(results.methods)
        for column_number, group in enumerate(groups, start=1)
        if round(found[method, group].mean, 6) == best[group] and len(results.methods) > 1
    )
    data = tidy(((*key, value) for key, value in found.items()), f"mean_{column}")
    return Table(name=name, caption=caption, shown=shown, data=data, bold=bold)
