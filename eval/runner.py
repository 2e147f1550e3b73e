"""Running methods on cases."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from mrta_zoo.errors import MissingExtraError, MrtaError
from mrta_zoo.eval.rows import Row
from mrta_zoo.io import Case
from mrta_zoo.plan import Plan
from mrta_zoo.policies.protocol import Solver, SupportsWarmUp
from mrta_zoo.policies.registry import POLISH, make_solver, method_names
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
    for name, solver in solvers.items():
        method = NamedSolver(name, solver)
        for case in cases:
            yield row_of(case, name, method.solve(case))


class NamedSolver:
    """A solver under the name that its rows get; it is warmed up before its first case.

    Args:
        name: the method, as it was asked for.
        solver: the method itself.
    """

    def __init__(self, name: str, solver: Solver) -> None:
        self.name, self._solver, self._warm = name, solver, False

    def solve(self, case: Case) -> Solved:
        """Plan a case, timed, and let the verifier score the plan.

        Raises:
            MrtaError: if the solver fails, or its plan does not fit the scenario; the message names method and case.
        """
        if not self._warm and isinstance(self._solver, SupportsWarmUp):
            self._solver.warm_up(case.scenario)
        self._warm = True
        try:
            return solve_and_score(self._solver, case.scenario)
        except MrtaError as error:
            raise type(error)(f"method {self.name} on case {case.name}: {error}") from error


def those_there(names: Iterable[str], absent: dict[str, str] | None = None) -> list[str]:
    """Those of some methods that this version has and this installation can run.

    Args:
        names: of the methods.
        absent: takes those that lack an optional dependency, with the reason.
    """
    there, found = method_names(), []
    for name in names:
        if name.removesuffix(POLISH) in there:
            try:
                make_solver(name)
                found.append(name)
            except MissingExtraError as error:
                (absent if absent is not None else {})[name] = str(error)
    return found


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
