"""The report on the paper's experiments: all sections, the summary before them, and how it was made after them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple

from mrta_zoo import __version__
from mrta_zoo.eval.machine import Machine
from mrta_zoo.eval.manifest import Manifest
from mrta_zoo.eval.report.parts import Report
from mrta_zoo.eval.reproduce.all_pairs import compare_all
from mrta_zoo.eval.reproduce.completion import completion_section
from mrta_zoo.eval.reproduce.methods import PYVRP_SECONDS
from mrta_zoo.eval.reproduce.moments import moments_section
from mrta_zoo.eval.reproduce.optimality import optimality_section
from mrta_zoo.eval.reproduce.paired_tests import compare, comparison_section
from mrta_zoo.eval.reproduce.results import Results
from mrta_zoo.eval.reproduce.share import share_section
from mrta_zoo.eval.reproduce.summary import summary
from mrta_zoo.eval.reproduce.timing import timing_section
from mrta_zoo.eval.significance import LEVEL, RESAMPLES
from mrta_zoo.policies.registry import METHODS


def reproduction_report(results: Results, manifest: Manifest, machines: Sequence[Machine]) -> Report:
    """All of it.

    Args:
        results: what was measured.
        manifest: what it depends on.
        machines: on which it was measured.
    """
    comparisons = compare(results)
    pairs = {tasks: compare_all(results, tasks) for tasks in results.sizes}
    return Report(
        title=f"Comparison of {len(results.methods)} methods of multi-robot task allocation"
        if len(results.methods) > 1
        else f"Results of {results.methods[0]} in multi-robot task allocation",
        summary=summary(results, comparisons, pairs, machines),
        sections=(
            completion_section(results),
            comparison_section(results, comparisons, pairs),
            timing_section(results, machines),
            moments_section(results),
            share_section(results),
            optimality_section(results),
        ),
        made=_made(results, manifest, machines),
    )


def _made(results: Results, manifest: Manifest, machines: Sequence[Machine]) -> tuple[tuple[str, str], ...]:
    settings = manifest.settings
    flags = [
        f"--cases {settings['cases']}", f"--methods {','.join(settings['methods'])}", f"--against {results.against}",
        *([f"--budget {settings['budget']:g}"] if settings["budget"] is not None else []),
        f"--seed {settings['seed']}", f"--threads {settings['threads']}",
    ]  # fmt: skip
    made = [
        ("Command", f"mrta-zoo reproduce {' '.join(flags)}"),
        ("Version", f"mrta_zoo {__version__}"),
        ("Cases", f"{results.frame['case'].nunique()}, SHA-256 {manifest.cases}"),
        *((f"Weights of {method}", f"SHA-256 {digest}") for method, digest in manifest.weights.items()),
        (
            "Scores",
            "Every plan was scored by the package’s verifier, which shares no code with the methods or the "
            "environment. A task counts as completed if its work is finished by its deadline.",
        ),
        ("Trained methods", "one greedy pass, no search"),
        *((name, METHODS[name].summary) for name in settings["methods"] if name in METHODS),
        (
            "Effort",
            "methods that search stop by themselves, pyvrp after the seconds named below"
            if settings["budget"] is None
            else f"methods that search (ils, eils, pyvrp, exact) had {settings['budget']:g} s a case",
        ),
        (
            "Statistics",
            f"SciPy and statsmodels: BCa bootstrap with {RESAMPLES} resamples (percentile bootstrap where BCa has no "
            f"answer), {100 * LEVEL:.0f} % intervals; paired t-test, Wilcoxon signed-rank test, Holm’s adjustment.",
        ),
    ]
    if "pyvrp" in settings["methods"]:
        made.append(("PyVRP", f"{settings['budget'] or PYVRP_SECONDS:g} s a case"))
    made += [("Not run", f"{method}: {reason}") for method, reason in results.absent.items()]
    for machine in machines:
        threads = f"{machine.threads} torch thread{'s' * (machine.threads != 1)}"
        made.append((f"Measured {machine.started}", machine.described(threads)))
    if len({astuple(machine)[1:5] for machine in machines}) > 1:
        made.append(("Beware", "the sessions above ran on different machines, so planning times are a mixture"))
    return tuple(made)
