"""Paired tests of methods on the same cases: Table III of the paper, with sizes of the effects."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations

import pandas as pd

from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.figure_style import style_of
from mrta_zoo.eval.report.forest import Mark, draw_forest
from mrta_zoo.eval.report.parts import Picture, Section, Table
from mrta_zoo.eval.reproduce.completion import case_counts
from mrta_zoo.eval.reproduce.results import BOOTSTRAP, Group, Results
from mrta_zoo.eval.significance import SIGNIFICANT, PairedTest, holm, paired_test
from mrta_zoo.wording import counted

FURTHEST = 10.0
"""Percentage points that the figure shows; of what lies beyond it gives the number."""


@dataclass(frozen=True, slots=True)
class PairedTests:
    """One method against another on a group of cases.

    Attributes:
        first: a method.
        second: another.
        group: of cases.
        test: of first minus second, in percentage points of tasks completed.
        t_p: p-value of the t-test, adjusted by Holm's method; None if there is none.
        wilcoxon_p: of the Wilcoxon test, adjusted likewise.
    """

    first: str
    second: str
    group: Group
    test: PairedTest
    t_p: float | None
    wilcoxon_p: float | None

    @property
    def significant(self) -> bool:
        """Whether the adjusted t-test (the Wilcoxon test where all differences are the same) says that means differ."""
        p = self.wilcoxon_p if self.t_p is None else self.t_p
        return p is not None and p < SIGNIFICANT

    @property
    def verdict(self) -> str:
        """Which is better, in words."""
        if self.test.note:
            return self.test.note
        if not self.significant:
            return "no significant difference"
        return f"{self.first if self.test.difference.mean > 0 else self.second} better"


def family(results: Results, groups: Iterable[Group], pairs: Iterable[tuple[str, str]]) -> list[PairedTests]:
    """All these pairs of methods on all these groups of cases; p-values are adjusted for all of them together."""
    asked = [(first, second, group) for group in groups for first, second in pairs]
    tests = []
    for first, second, group in asked:
        ours, theirs = results.select(group, first), results.select(group, second)
        percent, other = ours["percent"].to_numpy(float), theirs["percent"].to_numpy(float)
        tests.append(paired_test(percent, other, results.seed, ours["group"].tolist()))
    adjusted = zip(holm([test.t_p for test in tests]), holm([test.wilcoxon_p for test in tests]), strict=True)
    return [PairedTests(*which, test, *p) for which, test, p in zip(asked, tests, adjusted, strict=True)]


def compare(results: Results) -> list[PairedTests]:
    """The reference against every other method, on all cases of a size and by number of robots.

    p-values are adjusted within two families: all comparisons over all cases of a size, and all by number of robots.
    """
    pairs = [(results.against, method) for method in results.methods if method != results.against]
    groups = [results.groups(tasks) for tasks in results.sizes]
    whole, by_robots = [found[0] for found in groups], [group for found in groups for group in found[1:]]
    return family(results, whole, pairs) + family(results, by_robots, pairs)


def comparison_section(results: Results, comparisons: Sequence[PairedTests]) -> Section:
    """Differences as pictures and tables.

    Args:
        results: what was measured.
        comparisons: of the reference with the other methods.
    """
    title = f"{results.against} against each other method"
    if not comparisons:
        return Section(title=title, text=("Only one method was run, so there is nothing to compare.",))
    pictures, tables = [], []
    for tasks in results.sizes:
        whole, *by_robots = results.groups(tasks)
        chosen = [each for each in comparisons if each.group.tasks == tasks]
        pictures.append(_picture(results, tasks, chosen))
        tables.append(_overall_table(results, tasks, [each for each in chosen if each.group == whole]))
        if by_robots:
            tables.append(_by_robots_table(results, tasks, [each for each in chosen if each.group != whole]))
        if len(results.methods) > 2:
            tables.append(_all_pairs_table(results, whole))
    text = (
        f"Every difference is {results.against} minus the other method on the same case, in percentage points: "
        f"a positive one means that {results.against} completes more. The t-test is the paper’s; the Wilcoxon "
        "signed-rank test does not assume that differences are normally distributed. p-values are adjusted by Holm’s "
        "method, once for all comparisons over all cases of a size, once for all those by number of robots. d_z is the "
        "mean difference in standard deviations of the differences (Cohen; 0.2 is often called small, 0.5 medium, 0.8 "
        "large). Each trained method is one set of weights: nothing follows for how it would do when trained again.",
    )
    return Section(title=title, text=text, pictures=tuple(pictures), tables=tuple(tables))


def _picture(results: Results, tasks: int, chosen: Sequence[PairedTests]) -> Picture:
    others = [method for method in results.methods if method != results.against]
    panels = {
        group.label: {
            others.index(each.second): Mark(
                each.test.difference, style_of(each.second, results.methods), each.significant
            )
            for each in chosen
            if each.group == group
        }
        for group in results.groups(tasks)
    }
    label = f"{results.against} minus the method at the left, percentage points"
    return Picture(
        name=f"differences_{tasks}",
        caption=f"Mean of {results.against} minus the method at the left. {case_counts(results, tasks)} Bar: "
        f"{wording.INTERVAL} ({BOOTSTRAP}); filled: Holm-adjusted paired t-test p < {SIGNIFICANT}; arrow: beyond the "
        "axis, with its value.",
        figure=draw_forest(others, panels, label, width=2.4, furthest=FURTHEST),
        data=_data(chosen),
    )


def _overall_table(results: Results, tasks: int, chosen: Sequence[PairedTests]) -> Table:
    shown = [
        {
            f"{results.against} against": each.second,
            "difference": wording.estimate(each.test.difference, 2),
            "more / equal / fewer": f"{each.test.wins} / {each.test.ties} / {each.test.losses}",
            "p, t-test": wording.p_value(each.t_p),
            "p, Wilcoxon": wording.p_value(each.wilcoxon_p),
            "d_z": wording.DASH if each.test.effect is None else wording.number(each.test.effect, 2),
            "verdict": each.verdict,
        }
        for each in chosen
    ]
    caption = (
        f"All cases with {counted(tasks, 'task')}: mean difference with its {wording.INTERVAL} in brackets "
        f"({BOOTSTRAP}; not adjusted, so one may leave out 0 where the adjusted test sees no difference); cases in "
        f"which {results.against} completes more, equally many, fewer tasks; Holm-adjusted p-values, two-sided. "
        f"n = {counted(results.cases(results.groups(tasks)[0]), 'pair')}."
    )
    return Table(name=f"paired_tests_{tasks}", caption=caption, shown=pd.DataFrame(shown), data=_data(chosen))


def _by_robots_table(results: Results, tasks: int, chosen: Sequence[PairedTests]) -> Table:
    caption = (
        f"By number of robots, {counted(tasks, 'task')} (as Table III of the paper): mean difference, and the "
        f"Holm-adjusted p-value of the paired t-test in parentheses. {case_counts(results, tasks)} Bold: p < "
        f"{SIGNIFICANT}. Intervals, d_z and Wilcoxon tests are in the CSV file."
    )
    cells = {
        (each.second, each.group.label): (
            f"{wording.number(each.test.difference.mean, 2)} ({each.test.note or _p(each.t_p)})",
            each.significant,
        )
        for each in chosen
    }
    return _matrix(f"paired_tests_{tasks}_by_robots", caption, f"{results.against} against", cells, chosen)


def _all_pairs_table(results: Results, group: Group) -> Table:
    """A line and a column for each method, the line's mean minus the column's in each cell."""
    pairs = family(results, [group], list(combinations(results.methods, 2)))
    cells = {}
    for line in results.methods:
        for column in results.methods:
            cells[line, column] = (wording.DASH, False)
    for each in pairs:
        mean = each.test.difference.mean
        cells[each.first, each.second] = (wording.number(mean, 2), each.significant)
        cells[each.second, each.first] = (wording.number(-mean, 2), each.significant)
    caption = (
        f"Any two methods, {group.label}: mean of the line’s method minus the column’s. Bold: paired t-test p < "
        f"{SIGNIFICANT}, Holm-adjusted for all these {counted(len(pairs), 'comparison')}. "
        f"n = {counted(results.cases(group), 'pair')}. Intervals are in the CSV file."
    )
    return _matrix(f"all_pairs_{group.tasks}", caption, "line minus column", cells, pairs)


def _matrix(
    name: str,
    caption: str,
    corner: str,
    cells: dict[tuple[str, str], tuple[str, bool]],
    chosen: Sequence[PairedTests],
) -> Table:
    """A table with a cell, bold or not, for each (line, column)."""
    lines, columns = (list(dict.fromkeys(key[place] for key in cells)) for place in (0, 1))
    shown = [{corner: line, **{column: cells[line, column][0] for column in columns}} for line in lines]
    bold = {(lines.index(line), columns.index(column) + 1) for (line, column), (_, is_bold) in cells.items() if is_bold}
    return Table(name=name, caption=caption, shown=pd.DataFrame(shown), data=_data(chosen), bold=frozenset(bold))


def _p(p: float | None) -> str:
    text = wording.p_value(p)
    return f"p {text}" if text.startswith("<") else f"p = {text}"


def _data(chosen: Sequence[PairedTests]) -> pd.DataFrame:
    return pd.DataFrame(
        [
            {
                "first": each.first, "second": each.second, "tasks": each.group.tasks,
                "robots": "all" if each.group.robots is None else each.group.robots,
                "pairs": each.test.difference.n, **each.test.difference.columns("difference"),
                "t_p": each.test.t_p, "t_p_holm": each.t_p,
                "wilcoxon_p": each.test.wilcoxon_p, "wilcoxon_p_holm": each.wilcoxon_p,
                "d_z": each.test.effect, "first_more": each.test.wins, "first_fewer": each.test.losses,
                "verdict": each.verdict,
            }
            for each in chosen
        ]
    )  # fmt: skip
