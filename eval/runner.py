"""Running methods on cases."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from mrta_zoo.errors import MrtaError
from mrta_zoo.eval.rows import Row
from mrta_zoo.io import Case
from mrta_zoo.plan import Plan
from mrta_zoo.policies.protocol import NeedsWarmUp, Solver
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import Score, verify


@dataclass(frozen=True, slots=True)
class Solved:
    """A mission with its plan, the plan's score and the wall-clock seconds it took."""

    scenario: Scenario
    plan: Plan
    score: Score
    seconds: float


def solve_and_score(solver: Solver, scenario: Scenario) -> Solved:
    """Plan a mission, timed, and let the verifier score the plan.

    Raises:
        MrtaError: if the solver fails, or its plan does not fit the scenario.
    """
    begun = time.perf_counter()
    plan = solver.solve(scenario)
    seconds = time.perf_counter() - begun
    return Solved(scenario, plan, verify(scenario, plan), seconds)


def evaluate(cases: Sequence[Case], solvers: Mapping[str, Solver]) -> Iterator[Row]:
    """Every method on every case, one method after the other; each row as soon as it is known.

    Args:
        cases: what to plan.
        solvers: the methods by the name that their rows get.

    Raises:
        MrtaError: if a method fails on a case; the message names both.
    """
    for method, solver in solvers.items():
        for case, solved in solve_cases(cases, method, solver):
            yield row_of(case, method, solved)


def solve_cases(cases: Sequence[Case], method: str, solver: Solver) -> Iterator[tuple[Case, Solved]]:
    """One method on every case, warmed up before the first; each result as soon as it is known.

    Raises:
        MrtaError: if the method fails on a case; the message names both.
    """
    if isinstance(solver, NeedsWarmUp) and cases:
        solver.warm_up(cases[0].scenario)
    for case in cases:
        try:
            yield case, solve_and_score(solver, case.scenario)
        except MrtaError as error:
            raise type(error)(f"method {method} on case {case.name}: {error}") from error


def row_of(case: Case, method: str, solved: Solved) -> Row:
    """A solved case as a row."""
    score = solved.score
    return Row(
        case=case.name,
        method=method,
        tasks=case.scenario.num_tasks,
        robots=case.scenario.num_robots,
        completed=score.completed,
        completion=score.completion,
        cost=score.cost,
        distance=score.distance,
        makespan=score.makespan,
        seconds=round(solved.seconds, 6),
    )
