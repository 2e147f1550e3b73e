"""The paper's experiments: every method on every case, and on scenarios so small that the optimum can be proved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from mrta_zoo.errors import MissingExtraError
from mrta_zoo.eval.cells import case_cells
from mrta_zoo.eval.experiment import Experiment
from mrta_zoo.eval.manifest import make_manifest
from mrta_zoo.eval.report.parts import Report
from mrta_zoo.eval.reproduce.methods import reference_of, solver_of, usual_methods
from mrta_zoo.eval.reproduce.optimality import EXACT
from mrta_zoo.eval.reproduce.report import reproduction_report
from mrta_zoo.eval.reproduce.results import OptimalityRow, Results, frame_of
from mrta_zoo.eval.rows import KEY, Row
from mrta_zoo.eval.runner import NamedSolver, Solved, row_of
from mrta_zoo.io import Case
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.show.terminal.console import preparing
from mrta_zoo.suite import small_suite
from mrta_zoo.wording import composed


def reproduce(
    out: Path,
    cases: Sequence[Case],
    shown_cases: str,
    *,
    methods: Sequence[str] | None = None,
    against: str | None = None,
    budget: float | None = None,
    seed: int = 0,
    threads: int = 1,
) -> Report:
    """Measure what the folder lacks, and report on all of it. See the flags of `mrta-zoo reproduce`.

    Args:
        out: folder of the rows; new, empty, or of the same command.
        cases: what to plan.
        shown_cases: what the manifest calls them.
        methods: to compare; None for every usual one that can be made.
        against: the method that the others are tested against.
        budget: seconds per case for methods that search.
        seed: of everything drawn at random.
        threads: CPU threads.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    absent: dict[str, str] = {}
    asked = usual_methods(absent) if methods is None else methods
    names = [composed(method) for method in asked]  # as rows call them
    reference = reference_of(names, against and composed(against))
    with preparing():
        solvers = {composed(method): solver_of(method, budget, seed, threads) for method in asked}
    settings = {"cases": shown_cases, "methods": names, "budget": budget, "seed": seed, "threads": threads}
    manifest = make_manifest("reproduce", settings, cases, asked)
    with cpu_threads(threads):
        experiment = Experiment(out, manifest, threads)
        cells = [cell for name in names for cell in case_cells(cases, NamedSolver(name, solvers[name]), row_of)]
        rows = experiment.measure("rows.csv", Row, KEY, cells)
        small = {**_exact_solver(seed, absent), **{name: each for name, each in solvers.items() if name != EXACT}}
        small_cases = [Case(scenario.name, scenario) for scenario in small_suite()] if EXACT not in absent else []
        small_cells = [
            cell
            for name, solver in small.items()
            for cell in case_cells(small_cases, NamedSolver(name, solver), _optimality_row, what="small scenarios: ")
        ]
        small_rows = experiment.measure("small_rows.csv", OptimalityRow, KEY, small_cells)
    results = Results(
        frame=frame_of(rows, [case.name for case in cases], names),
        methods=tuple(names),
        against=reference,
        seed=seed,
        best_known={case.name: case.best_known for case in cases if case.best_known is not None},
        small=frame_of(small_rows, [case.name for case in small_cases], list(small)) if small_rows else None,
        absent=absent,
    )
    return reproduction_report(results, manifest, experiment.machines)


def _exact_solver(seed: int, absent: dict[str, str]) -> dict[str, Solver]:
    """The exact solver, none if there is none; then `absent` says why."""
    try:
        return {EXACT: make_solver(EXACT, seed=seed)}
    except MissingExtraError as error:
        absent[EXACT] = str(error)
        return {}


def _optimality_row(case: Case, method: str, solved: Solved) -> OptimalityRow:
    return OptimalityRow(**asdict(row_of(case, method, solved)), bound=solved.plan.bound)
