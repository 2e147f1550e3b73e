"""The report on the paper's experiments: all sections, the summary before them, and how it was made after them."""

from __future__ import annotations

from collections.abc import Sequence

from mrta_zoo.eval.machine import Machine
from mrta_zoo.eval.manifest import Manifest
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.made import how_made
from mrta_zoo.eval.report.parts import Report
from mrta_zoo.eval.reproduce.completion import completion_section
from mrta_zoo.eval.reproduce.methods import PYVRP_SECONDS
from mrta_zoo.eval.reproduce.optimality import optimality_section
from mrta_zoo.eval.reproduce.paired_tests import compare, comparison_section
from mrta_zoo.eval.reproduce.paper import paper_section
from mrta_zoo.eval.reproduce.results import Results
from mrta_zoo.eval.reproduce.share import share_section
from mrta_zoo.eval.reproduce.summary import summary
from mrta_zoo.eval.reproduce.timing import timing_section
from mrta_zoo.eval.significance import RESAMPLES
from mrta_zoo.policies.registry import METHODS


def reproduction_report(results: Results, manifest: Manifest, machines: Sequence[Machine]) -> Report:
    """All of it.

    Args:
        results: what was measured.
        manifest: what it depends on.
        machines: on which it was measured.
    """
    comparisons = compare(results)
    return Report(
        title=f"Comparison of {len(results.methods)} methods of multi-robot task allocation"
        if len(results.methods) > 1
        else f"Results of {results.methods[0]} in multi-robot task allocation",
        summary=summary(results, comparisons, machines),
        sections=(
            completion_section(results),
            comparison_section(results, comparisons),
            timing_section(results, machines),
            share_section(results),
            optimality_section(results),
            paper_section(),
        ),
        made=how_made(manifest, {**manifest.settings, "against": results.against}, machines, _more(results, manifest)),
    )


def _more(results: Results, manifest: Manifest) -> list[tuple[str, str]]:
    """What the methods are and had, how statistics were made, and what was not run."""
    budget = manifest.settings["budget"]
    return [
        ("Trained methods", "one greedy pass, no search"),
        *((name, METHODS[name].summary) for name in results.methods if name in METHODS),
        (
            "Effort",
            f"methods that search stop by themselves, pyvrp after {PYVRP_SECONDS:g} s per case"
            if budget is None
            else f"methods that search (ils, eils, pyvrp, exact) had {budget:g} s per case",
        ),
        (
            "Statistics",
            f"SciPy and statsmodels: BCa bootstrap with {RESAMPLES} resamples (percentile bootstrap where BCa has no "
            f"answer), {wording.INTERVAL}s; paired t-test, Wilcoxon signed-rank test, Holm’s adjustment.",
        ),
        *(("Not run", f"{method}: {reason}") for method, reason in results.absent.items()),
    ]
