"""The report in a few sentences: which method completes how much, how that differs from the reference, and how fast."""

from __future__ import annotations

from collections.abc import Sequence

from mrta_zoo.eval.machine import Machine
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.made import busy_note
from mrta_zoo.eval.reproduce.paired_tests import PairedTests
from mrta_zoo.eval.reproduce.results import Group, Results
from mrta_zoo.eval.significance import SIGNIFICANT
from mrta_zoo.wording import counted


def summary(results: Results, comparisons: Sequence[PairedTests], machines: Sequence[Machine]) -> tuple[str, ...]:
    """A few sentences for each number of tasks, and for planning time.

    Args:
        results: what was measured.
        comparisons: of the reference with the other methods.
        machines: on which it was measured.
    """
    points = []
    for tasks in results.sizes:
        size, whole = counted(tasks, "task"), results.groups(tasks)[0]
        means = {method: results.select(whole, method)["percent"].mean() for method in results.methods}
        order = ", ".join(f"{method} {means[method]:.1f} %" for method in sorted(means, key=lambda each: -means[each]))
        points.append(f"{size} ({counted(results.cases(whole), 'case')}), tasks completed in time, mean: {order}.")
        chosen = [each for each in comparisons if each.group == whole]
        chosen.sort(key=lambda each: each.test.difference.mean)
        against = "; ".join(wording.contrast(each.second, each.test.difference, each.significant) for each in chosen)
        if chosen:
            points.append(
                f"{size}, {results.against} minus each other method, percentage points with their {wording.INTERVAL}: "
                f"{against}."
            )
    if comparisons:
        points.append(
            f"Significant means p < {SIGNIFICANT} in a paired t-test over the cases, after Holm’s adjustment for the "
            "number of comparisons. Each trained method is one set of weights: the tests speak of these weights, "
            "not of every training."
        )
    smallest = results.sizes[0]
    times = {method: results.select(Group(smallest), method)["seconds"].mean() for method in results.methods}
    order = ", ".join(f"{method} {wording.seconds(times[method])}" for method in sorted(times, key=times.__getitem__))
    points.append(
        " ".join((f"Time to plan a mission with {counted(smallest, 'task')}, mean: {order}.", *busy_note(machines)))
    )
    return tuple(points)
