"""Paired tests of one method against each other one: Table III of the paper, with sizes of the effects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Picture, Section, Table
from mrta_zoo.eval.reproduce import paper
from mrta_zoo.eval.reproduce.all_pairs import Pairs, all_pairs_table
from mrta_zoo.eval.reproduce.completion import case_counts
from mrta_zoo.eval.reproduce.figures import draw_differences
from mrta_zoo.eval.reproduce.results import Group, Results
from mrta_zoo.eval.significance import SIGNIFICANT, PairedTest, holm, paired_test
from mrta_zoo.wording import counted


@dataclass(frozen=True, slots=True)
class PairedTests:
    """The reference against a method on a group of cases.

    Attributes:
        method: the other method.
        group: of cases.
        test: of reference minus method, in percentage points of tasks completed.
        t_p: p-value of the t-test, adjusted by Holm's method; None if there is none.
        wilcoxon_p: of the Wilcoxon test, adjusted likewise.
    """

    method: str
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
        """Which is better, in words, seen from the reference."""
        if self.test.note:
            return self.test.note
        if not self.significant:
            return "no significant difference"
        return "reference better" if self.test.difference.mean > 0 else "reference worse"


def compare(results: Results) -> list[PairedTests]:
    """The reference against every other method, on all cases of a size and by number of robots.

    p-values are adjusted within two families: all comparisons over all cases of a size, and all by number of robots.
    """
    others = [method for method in results.methods if method != results.against]
    groups = [group for tasks in results.sizes for group in results.groups(tasks)]
    whole = {tasks: results.groups(tasks)[0] for tasks in results.sizes}
    comparisons = []
    for family in (list(whole.values()), [group for group in groups if group not in whole.values()]):
        pairs = [(method, group) for group in family for method in others]
        tests = [_test(results, method, group) for method, group in pairs]
        adjusted = zip(holm([test.t_p for test in tests]), holm([test.wilcoxon_p for test in tests]), strict=True)
        for (method, group), test, (t_p, wilcoxon_p) in zip(pairs, tests, adjusted, strict=True):
            comparisons.append(PairedTests(method, group, test, t_p, wilcoxon_p))
    return comparisons


def _test(results: Results, method: str, group: Group) -> PairedTest:
    ours, theirs = results.select(group, results.against), results.select(group, method)
    return paired_test(
        ours["percent"].to_numpy(float), theirs["percent"].to_numpy(float), results.seed, ours["group"].tolist()
    )


def comparison_section(results: Results, comparisons: list[PairedTests], pairs: Mapping[int, Pairs]) -> Section:
    """Differences as pictures and tables, with the paper's p-values beside.

    Args:
        results: what was measured.
        comparisons: of the reference with the other methods.
        pairs: any two methods, by number of tasks.
    """
    title = f"{results.against} against each other method"
    if not comparisons:
        return Section(title=title, text=("Only one method was run, so there is nothing to compare.",))
    pictures, tables = [], []
    for tasks in results.sizes:
        groups = results.groups(tasks)
        chosen = [each for each in comparisons if each.group in groups]
        pictures.append(
            Picture(
                name=f"differences_{tasks}",
                caption=f"Mean of {results.against} minus the method at the left, in percentage points of the {tasks} "
                f"tasks of a case, over the same cases. {case_counts(results, tasks)} Bar: {wording.INTERVAL} (BCa "
                f"bootstrap); filled mark: significant, Holm-adjusted paired t-test p < {SIGNIFICANT}; hollow: not "
                "significant; arrow: beyond the axis, with its value.",
                figure=draw_differences(
                    results,
                    groups,
                    {(each.method, each.group): (each.test.difference, each.significant) for each in chosen},
                ),
                data=_data(chosen),
            )
        )  # fmt: skip
        tables.append(_overall_table(results, tasks, [each for each in chosen if each.group == groups[0]]))
        if len(groups) > 1:
            tables.append(_by_robots_table(results, tasks, [each for each in chosen if each.group != groups[0]]))
        if len(results.methods) > 2:
            tables.append(all_pairs_table(results, tasks, pairs[tasks]))
    if results.against == "capam":
        tables.append(_paper_table())
    text = (
        f"Every difference is {results.against} minus the other method on the same case, so a positive one means that "
        f"{results.against} completes more. The t-test is the paper’s; the Wilcoxon signed-rank test beside it does "
        "not assume that differences are normally distributed. p-values are adjusted for the number of comparisons by "
        "Holm’s method, once for all comparisons over all cases of a size, once for all those by number of robots. "
        "d_z is the mean difference in standard deviations of the differences (Cohen; 0.2 is often called small, 0.5 "
        "medium, 0.8 large).",
        "What is tested is whether these plans differ on cases like these. A trained method stands here with one set "
        "of weights, so nothing follows for how it would do when trained again.",
    )
    return Section(title=title, text=text, pictures=tuple(pictures), tables=tuple(tables))


def _overall_table(results: Results, tasks: int, chosen: list[PairedTests]) -> Table:
    shown = []
    for each in chosen:
        test = each.test
        effect = wording.DASH
        if test.effect is not None:
            effect = wording.number(test.effect, 2, signed=True)
            if test.effect_low is not None and test.effect_high is not None:
                low, high = (wording.number(end, 2, signed=True) for end in (test.effect_low, test.effect_high))
                effect += f" [{low}, {high}]"
        shown.append(
            {
                f"{results.against} against": each.method,
                "difference": wording.estimate(test.difference, 2, signed=True),
                "more / equal / fewer": f"{test.wins} / {test.difference.n - test.wins - test.losses} / {test.losses}",
                "p, t-test": wording.p_value(each.t_p),
                "p, Wilcoxon": wording.p_value(each.wilcoxon_p),
                "d_z": effect,
                "verdict": each.verdict.replace("reference", results.against),
            }
        )
    caption = (
        f"{results.against} minus each method over all cases with {counted(tasks, 'task')}: mean difference in "
        f"percentage points "
        f"and d_z, each with its {wording.INTERVAL} in brackets ({wording.BOOTSTRAP}; "
        f"noncentral t); cases in which {results.against} completes more, equally many, fewer tasks; Holm-adjusted "
        "p-values, two-sided. Intervals are for each line alone and not adjusted, so one may leave out 0 where the "
        f"adjusted test sees no difference. n = {counted(results.cases(results.groups(tasks)[0]), 'pair')}."
    )
    return Table(name=f"paired_tests_{tasks}", caption=caption, shown=pd.DataFrame(shown), data=_data(chosen))


def _by_robots_table(results: Results, tasks: int, chosen: list[PairedTests]) -> Table:
    cells: dict[str, dict[str, str]] = {}
    bold = set()
    for each in chosen:
        line = cells.setdefault(each.method, {f"{results.against} against": each.method})
        line[each.group.label] = (
            f"{wording.number(each.test.difference.mean, 2, signed=True)} ({each.test.note or _p(each.t_p)})"
        )
        if each.significant:
            bold.add((list(cells).index(each.method), list(line).index(each.group.label)))
    caption = (
        f"{results.against} minus each method by number of robots, {counted(tasks, 'task')} (as Table III of the "
        f"paper): mean "
        "difference in percentage points, and the Holm-adjusted p-value of the paired t-test in parentheses. "
        f"{case_counts(results, tasks)} Bold: p < {SIGNIFICANT}. Intervals, d_z and Wilcoxon tests are in the CSV file."
    )  # fmt: skip
    return Table(
        name=f"paired_tests_{tasks}_by_robots",
        caption=caption,
        shown=pd.DataFrame(list(cells.values())),
        data=_data(chosen),
        bold=frozenset(bold),
    )


def _paper_table() -> Table:
    shown = [
        {"CapAM against": method, **{counted(robots, "robot"): f"{p:.2g}" for robots, p in values.items()}}
        for method, values in paper.P_VALUES.items()
    ]
    data = [
        {"method": method, "robots": robots, "p": p}
        for method, values in paper.P_VALUES.items()
        for robots, p in values.items()
    ]
    return Table(
        name="paired_tests_paper",
        caption=f"The paper’s Table III ({paper.SOURCE}): p-values of paired t-tests on 24 cases each with 100 tasks, "
        "not adjusted. The paper gives no sizes of differences.",
        shown=pd.DataFrame(shown),
        data=pd.DataFrame(data),
    )


def _p(p: float | None) -> str:
    text = wording.p_value(p)
    return f"p {text}" if text.startswith("<") else f"p = {text}"


def _data(chosen: list[PairedTests]) -> pd.DataFrame:
    return pd.DataFrame(
        [
            {
                "method": each.method, "tasks": each.group.tasks,
                "robots": "all" if each.group.robots is None else each.group.robots,
                "pairs": each.test.difference.n, "difference": each.test.difference.mean,
                "low": each.test.difference.low, "high": each.test.difference.high,
                "t_p": each.test.t_p, "t_p_holm": each.t_p,
                "wilcoxon_p": each.test.wilcoxon_p, "wilcoxon_p_holm": each.wilcoxon_p,
                "d_z": each.test.effect, "d_z_low": each.test.effect_low, "d_z_high": each.test.effect_high,
                "reference_more": each.test.wins, "reference_fewer": each.test.losses,
                "verdict": each.verdict,
            }
            for each in chosen
        ]
    )  # fmt: skip
