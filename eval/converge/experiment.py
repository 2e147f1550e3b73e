"""Every method on every case with every budget."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.cells import case_cells
from mrta_zoo.eval.converge.curves import BUDGET_KEY, BudgetRow, curves_of, curves_report
from mrta_zoo.eval.experiment import Experiment
from mrta_zoo.eval.manifest import make_manifest
from mrta_zoo.eval.report.parts import Report
from mrta_zoo.eval.runner import NamedSolver, Solved, row_of, those_there
from mrta_zoo.io import Case
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.policies.registry import POLISH, make_solver
from mrta_zoo.wording import composed

USUAL = ("ils", "eils", "pyvrp", "capam-plus", f"capam-plus{POLISH}")
USUAL_POINTS = ("nearest", "capam")


def converge(
    out: Path,
    cases: Sequence[Case],
    shown_cases: str,
    budgets: Sequence[float],
    *,
    methods: Sequence[str] | None = None,
    points: Sequence[str] | None = None,
    every: int = 1,
    seed: int = 0,
    threads: int = 1,
) -> Report:
    """Measure what the folder lacks, and report on all of it. See the flags of `mrta-zoo converge`.

    Args:
        out: folder of the rows; new, empty, or of the same command.
        cases: what to plan.
        shown_cases: what the manifest calls them.
        budgets: seconds per case, in rising order.
        methods: that search; None for the usual ones that can be made.
        points: methods without a budget; likewise.
        every: only every so many-th case of each number of tasks and robots.
        seed: of everything drawn at random.
        threads: CPU threads.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    methods = those_there(USUAL) if methods is None else methods
    points = those_there(USUAL_POINTS) if points is None else points
    cases = every_of_each_size(cases, every)
    options: dict[str, Any] = {"seed": seed, "threads": threads}
    asked: list[tuple[str, float | None, Solver]] = [(name, None, make_solver(name, seed=seed)) for name in points]
    asked += [(name, budget, make_solver(name, budget=budget, **options)) for budget in budgets for name in methods]
    cells = []
    for name, budget, solver in asked:

        def record(case: Case, method: str, solved: Solved, budget: float | None = budget) -> BudgetRow:
            return BudgetRow(**asdict(row_of(case, method, solved)), budget=budget)

        what = "" if budget is None else f"{budget:g} s: "
        cells += case_cells(cases, NamedSolver(composed(name), solver), record, budget, what=what)
    settings = {"cases": shown_cases, "methods": methods, "points": points, "budgets": budgets, "every": every,
                "seed": seed, "threads": threads}  # fmt: skip
    manifest = make_manifest("converge", settings, cases, dict.fromkeys((*methods, *points)))
    with cpu_threads(threads):
        experiment = Experiment(out, manifest, threads)
        rows = experiment.measure("rows.csv", BudgetRow, BUDGET_KEY, cells)
    order: list[tuple[str, float | None]] = [(composed(name), None) for name in points]
    order += [(composed(name), seconds) for name in methods for seconds in budgets]
    return curves_report(curves_of(rows, order, seed), manifest, experiment.machines)


def every_of_each_size(cases: Sequence[Case], every: int) -> list[Case]:
    """The first, and then every `every`-th case of each number of tasks and robots, in the same order.

    Raises:
        ConfigError: if `every` is not positive.
    """
    if every < 1:
        raise ConfigError(f"every is {every}; expected a whole number >= 1")
    seen: dict[tuple[int, int], int] = {}
    chosen = []
    for case in cases:
        size = case.scenario.num_tasks, case.scenario.num_robots
        if seen.setdefault(size, 0) % every == 0:
            chosen.append(case)
        seen[size] += 1
    return chosen
