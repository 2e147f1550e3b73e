"""Rows as tables for people: means by number of tasks and robots, one column for each method."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from statistics import fmean

from mrta_zoo.digits import rounded, share
from mrta_zoo.eval.rows import Row
from mrta_zoo.show.terminal.sheet import Sheet

CellText = Callable[[Sequence[Row]], str]


def summary_tables(rows: Sequence[Row], best_known: Mapping[str, int] | None = None) -> list[Sheet]:
    """Mean completion, share of the best known plan, and planning time.

    Args:
        rows: of any methods and cases.
        best_known: the most tasks that are known to be completed in a case, by the case's name. Only cases in it
            count in the table of shares, which is left out if there are none.
    """
    known = {name: value for name, value in (best_known or {}).items() if value > 0}
    tables = [_table("Tasks completed, mean %", rows, lambda group: _percent([row.completion for row in group]))]
    compared = [row for row in rows if row.case in known]
    if compared:

        def of_best(group: Sequence[Row]) -> str:
            return _percent([row.completed / known[row.case] for row in group])

        tables.append(_table("Share of the best known plan's tasks, mean %", compared, of_best))
    tables.append(
        _table("Planning time, mean milliseconds", rows, lambda group: rounded(1000 * fmean(r.seconds for r in group)))
    )
    return tables


def _table(title: str, rows: Sequence[Row], cell: CellText) -> Sheet:
    methods = list(dict.fromkeys(row.method for row in rows))
    sizes = sorted({(row.tasks, row.robots) for row in rows})
    shown: list[tuple[str, ...]] = []
    for size in sizes:
        group = [row for row in rows if (row.tasks, row.robots) == size]
        shown.append((*map(str, size), *_cells(group, methods, cell)))
    ends = []
    if len(sizes) > 1:
        ends = [len(shown) - 1]
        shown.append(("all", "", *_cells(rows, methods, cell)))
    return Sheet(title, ("tasks", "robots", "cases", *methods), shown, ends=ends)


def _cells(group: Sequence[Row], methods: Sequence[str], cell: CellText) -> list[str]:
    """The number of cases, then a cell for each method."""
    of_method = {method: [row for row in group if row.method == method] for method in methods}
    return [
        str(len({row.case for row in group})),
        *(cell(found) if (found := of_method[method]) else "-" for method in methods),
    ]


def _percent(shares: Sequence[float]) -> str:
    return share(fmean(shares))
