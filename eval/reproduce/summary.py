"""The report in a few sentences: which method is better than which, by how much, and what is not significant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mrta_zoo.eval.machine import Machine
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.reproduce.all_pairs import Pairs, not_told_apart
from mrta_zoo.eval.reproduce.optimality import EXACT
from mrta_zoo.eval.reproduce.paired_tests import PairedTests
from mrta_zoo.eval.reproduce.results import Group, Results
from mrta_zoo.eval.reproduce.timing import busy_note
from mrta_zoo.eval.significance import SIGNIFICANT
from mrta_zoo.wording import counted

MOST_NAMED = 6
"""Pairs of methods that one sentence can name."""


def summary(
    results: Results, comparisons: Sequence[PairedTests], pairs: Mapping[int, Pairs], machines: Sequence[Machine]
) -> tuple[str, ...]:
    """A few sentences for each number of tasks, by number of robots, and for planning time.

    Args:
        results: what was measured.
        comparisons: of the reference with the other methods.
        pairs: any two methods, by number of tasks.
        machines: on which it was measured.
    """
    points = []
    for tasks in results.sizes:
        whole, *by_robots = results.groups(tasks)
        points.append(_ranking(results, whole))
        chosen = [each for each in comparisons if each.group == whole]
        if chosen:
            points.append(_against(results, tasks, chosen))
        points += _not_told_apart(tasks, pairs[tasks])
        points += _by_robots(results, tasks, [each for each in comparisons if each.group in by_robots], chosen)
    if comparisons:
        points.append(
            f"Significant means p < {SIGNIFICANT} in a paired t-test over the cases, after Holm’s adjustment for the "
            "number of comparisons. Each trained method is one set of weights: the tests speak of these weights, "
            "not of every training."
        )
    points.append(_times(results) + (" " + busy_note(machines)[0] if busy_note(machines) else ""))
    if results.small is not None and (results.small["method"] == EXACT).any():
        points.append("For small scenarios the distance to the proven optimum is in the section on the optimality gap.")
    return tuple(points)


def _ranking(results: Results, group: Group) -> str:
    assert group.tasks is not None
    means = {method: results.select(group, method)["percent"].mean() for method in results.methods}
    order = sorted(means, key=lambda method: -means[method])
    first = (
        f"{counted(group.tasks, 'task')} ({counted(results.cases(group), 'case')}): tasks completed in time, mean: "
        if len(order) > 1
        else f"{counted(group.tasks, 'task')} ({counted(results.cases(group), 'case')}): "
    )
    return first + ", ".join(f"{method} {wording.number(means[method])} %" for method in order) + "."


def _against(results: Results, tasks: int, chosen: Sequence[PairedTests]) -> str:
    def named(each: PairedTests) -> str:
        points = wording.number(abs(each.test.difference.mean))
        low, high = each.test.difference.low, each.test.difference.high
        if low is None or high is None:
            return f"{each.method} (by {points})"
        ends = sorted((abs(low), abs(high)))
        return f"{each.method} (by {points}, {wording.INTERVAL} {wording.number(ends[0])} to {wording.number(ends[1])})"

    chosen = sorted(chosen, key=lambda each: abs(each.test.difference.mean))
    better = [named(each) for each in chosen if each.significant and each.test.difference.mean > 0]
    worse = [named(each) for each in chosen if each.significant and each.test.difference.mean < 0]
    equal = [
        f"{each.method} ({wording.number(each.test.difference.mean, signed=True)}, "
        f"{each.test.note or 'p = ' + wording.p_value(each.t_p)})"
        for each in chosen
        if not each.significant
    ]
    parts = []
    if better:
        parts.append(f"it completes significantly more, in percentage points, than {wording.listed(better)}")
    if worse:
        parts.append(f"it completes significantly fewer than {wording.listed(worse)}")
    if equal:
        parts.append(f"there is no significant difference from {wording.listed(equal)}")
    text = f"{results.against} with {counted(tasks, 'task')}: {'; '.join(parts)}."
    disagree = [
        each.method
        for each in chosen
        if each.t_p is not None and each.wilcoxon_p is not None and each.significant != (each.wilcoxon_p < SIGNIFICANT)
    ]
    if disagree:
        text += f" The Wilcoxon test comes to the other conclusion for {wording.listed(disagree)}."
    return text


def _by_robots(results: Results, tasks: int, chosen: Sequence[PairedTests], whole: Sequence[PairedTests]) -> list[str]:
    """Where a number of robots tells another story than all cases together."""
    sign_of = {each.method: _sign(each) for each in whole}
    stories: dict[str, list[str]] = {}
    for each in chosen:
        if _sign(each) != sign_of.get(each.method):
            points = wording.number(abs(each.test.difference.mean))
            signed = wording.number(each.test.difference.mean, signed=True)
            told = {
                1: f"significantly more with {each.group.label} (by {points})",
                -1: f"significantly fewer with {each.group.label} (by {points})",
                0: f"no significant difference with {each.group.label} ({signed})",
            }
            stories.setdefault(each.method, []).append(told[_sign(each)])
    if not stories:
        return []
    parts = [f"against {method}, {wording.listed(found)}" for method, found in stories.items()]
    found_so = "; ".join(parts)
    return [
        f"{results.against} with {counted(tasks, 'task')}, where the number of robots changes the picture: {found_so}."
    ]


def _not_told_apart(tasks: int, pairs: Pairs) -> list[str]:
    """Which methods do not differ significantly, of any two."""
    if len(pairs) < 2:
        return []
    alike = [f"{first} and {second}" for first, second in not_told_apart(pairs)]
    if not alike:
        return [f"Any two of the methods differ significantly over the cases with {counted(tasks, 'task')}."]
    if len(alike) > MOST_NAMED:
        return [
            f"{len(alike)} of {len(pairs)} pairs of methods do not differ significantly over the cases with {tasks} "
            "tasks: see the table of all pairs."
        ]
    return [
        f"Of any two methods, no significant difference over the cases with {counted(tasks, 'task')} is between "
        f"{wording.listed(alike)}{'; all other differences are significant' if len(alike) < len(pairs) else ''}. "
        "This is adjusted for all pairs, and so a little stricter than the comparison above."
    ]


def _sign(each: PairedTests) -> int:
    if not each.significant:
        return 0
    return 1 if each.test.difference.mean > 0 else -1


def _times(results: Results) -> str:
    size = results.sizes[0]
    means = {method: results.select(Group(size), method)["seconds"].mean() for method in results.methods}
    order = sorted(means, key=lambda method: means[method])
    return (
        f"Time to plan a mission with {counted(size, 'task')}, mean: "
        + ", ".join(f"{method} {wording.seconds(means[method])}" for method in order)
        + "."
    )
