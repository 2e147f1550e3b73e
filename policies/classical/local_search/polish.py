"""Local search from the plan of any other method."""

from __future__ import annotations

from functools import partial

from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.local_search.eils import EilsSolver
from mrta_zoo.policies.interruption import run_in_parallel
from mrta_zoo.policies.protocol import Solver, SupportsTimeLimit, SupportsWarmUp
from mrta_zoo.policies.stop import Cancellation, FirstOf, TimeLimit
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify

METHOD_SHARE = 0.2
"""Share of the budget that a method with a time limit may take."""


class PolishedSolver:
    """Improves the plan of a method by EILS-style search. At least as many tasks are completed, and none is late.

    With a budget, the search has the time that the method leaves. A method that supports a time limit, as trained
    policies do, has at most `METHOD_SHARE` of the budget; if it needs more, or is known to, the search begins without
    its plan. With more than one thread, the others search from the beginning while the method plans in the first.

    Args:
        solver: the method.
        seed: of the search, >= 0.
        budget: seconds per scenario for the method and the search together, > 0. By default the search ends by itself
            (see `eils.EilsConfig`), and the plan depends neither on the machine nor on the threads.
        threads: number of parallel searches, if there is a budget.
    """

    def __init__(self, solver: Solver, seed: int = 0, budget: float | None = None, threads: int = 1) -> None:
        self._solver, self._budget = solver, budget
        self._search, self._others = EilsSolver(seed), None
        if budget is not None and threads > 1:
            self._search, self._others = EilsSolver(seed + 1), EilsSolver(seed, budget, threads=threads - 1)
        self._pace = 0.0  # seconds that the method needs for each task, as far as is known

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`; its method is the method's name and "+polish"."""
        if self._budget is None:
            plan = self._solver.solve(scenario)
            return self._search.improve(scenario, plan, _polished(plan))
        limit, cancellation = TimeLimit.of(self._budget), Cancellation()
        first = partial(self._plan_and_search, scenario, limit, cancellation)
        if self._others is None:
            return first()
        others = partial(self._others.solve, scenario, FirstOf((limit, cancellation)))
        plan, other = run_in_parallel([first, others], cancellation.cancel)
        mine, theirs = (verify(scenario, each) for each in (plan, other))
        if (theirs.completed, -theirs.cost) > (mine.completed, -mine.cost):
            return Plan(other.routes, scenario.name, plan.method)
        return plan

    def _plan_and_search(self, scenario: Scenario, limit: TimeLimit, cancellation: Cancellation) -> Plan:
        plan = self._plan(scenario, limit)
        return self._search.improve(scenario, plan, _polished(plan), FirstOf((limit.rest(), cancellation)))

    def _plan(self, scenario: Scenario, limit: TimeLimit) -> Plan:
        """The method's plan, or an empty one if there is no time for it."""
        if not isinstance(self._solver, SupportsTimeLimit):
            return self._solver.solve(scenario)
        plan, allowed = None, limit.first(METHOD_SHARE)
        if self._pace * scenario.num_tasks < allowed.end - allowed.begin:
            plan = self._time(self._solver, scenario, allowed)
        return Plan(((),) * scenario.num_robots, method=self._solver.name) if plan is None else plan

    def _time(self, solver: SupportsTimeLimit, scenario: Scenario, limit: TimeLimit) -> Plan | None:
        """The method's plan, if it is in time. Its pace is noted; where it is not finished, twice that, as a guess."""
        plan = solver.solve_within(scenario, limit)
        self._pace = (2 if plan is None else 1) * limit.spent() / scenario.num_tasks
        return plan

    def warm_up(self, scenario: Scenario) -> None:
        """Warm up the method, then see how long it takes."""
        if isinstance(self._solver, SupportsWarmUp):
            self._solver.warm_up(scenario)
        if isinstance(self._solver, SupportsTimeLimit) and self._budget is not None:
            self._time(self._solver, scenario, TimeLimit.of(self._budget))


def _polished(plan: Plan) -> str:
    return f"{plan.method}+polish"
