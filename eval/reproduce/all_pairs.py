"""Every method against every other one, in one table."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import pandas as pd

from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Table
from mrta_zoo.eval.reproduce.results import Results
from mrta_zoo.eval.significance import SIGNIFICANT, PairedTest, holm, paired_test
from mrta_zoo.wording import counted

Pairs = Mapping[tuple[str, str], tuple[PairedTest, float | None]]
"""For each two methods, in the order of the results, the test of first minus second and its adjusted p-value."""


def compare_all(results: Results, tasks: int) -> Pairs:
    """Paired tests of any two methods over all cases with so many tasks; p-values adjusted for all of them together."""
    group = results.groups(tasks)[0]
    percent = {method: results.select(group, method)["percent"].to_numpy(float) for method in results.methods}
    strata = results.select(group, results.methods[0])["group"].tolist()
    tests = {
        (first, second): paired_test(percent[first], percent[second], results.seed, strata)
        for first, second in combinations(results.methods, 2)
    }
    adjusted = holm([test.t_p for test in tests.values()])
    return {pair: (test, p) for (pair, test), p in zip(tests.items(), adjusted, strict=True)}


def not_told_apart(pairs: Pairs) -> list[tuple[str, str]]:
    """Methods between which there is no significant difference."""
    return [pair for pair, (_, p) in pairs.items() if p is None or p >= SIGNIFICANT]


def all_pairs_table(results: Results, tasks: int, pairs: Pairs) -> Table:
    """A line and a column for each method, the line's mean minus the column's in each cell."""
    shown, bold = [], set()
    for row, line in enumerate(results.methods):
        cells = {"line minus column": line}
        for column, other in enumerate(results.methods, start=1):
            cells[other] = wording.DASH
            if line == other:
                continue
            test, p = pairs.get((line, other)) or pairs[other, line]
            sign = 1 if (line, other) in pairs else -1
            cells[other] = wording.number(sign * test.difference.mean, 2, signed=True)
            if p is not None and p < SIGNIFICANT:
                bold.add((row, column))
        shown.append(cells)
    data = [
        {
            "first": first, "second": second, "tasks": tasks, "pairs": test.difference.n,
            "difference": test.difference.mean, "low": test.difference.low, "high": test.difference.high,
            "t_p": test.t_p, "t_p_holm": p, "wilcoxon_p": test.wilcoxon_p, "d_z": test.effect, "note": test.note,
        }
        for (first, second), (test, p) in pairs.items()
    ]  # fmt: skip
    return Table(
        name=f"all_pairs_{tasks}",
        caption=f"Any two methods over all cases with {counted(tasks, 'task')}: mean of the line’s method minus "
        f"the column’s, in percentage points. Bold: paired t-test p < {SIGNIFICANT}, Holm-adjusted for all these "
        f"{counted(len(pairs), 'comparison')}. n = {counted(results.cases(results.groups(tasks)[0]), 'pair')}. "
        "Intervals are in the CSV file.",
        shown=pd.DataFrame(shown),
        data=pd.DataFrame(data),
        bold=frozenset(bold),
    )
