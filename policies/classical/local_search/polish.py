"""Local search from the plan of any other method."""

from __future__ import annotations

import time
from functools import partial
from threading import Event

from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.local_search.eils import EilsSolver
from mrta_zoo.policies.interruption import side_by_side
from mrta_zoo.policies.protocol import Hurried, NeedsWarmUp, Solver
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify

LEAST_BUDGET = 1e-3
"""Seconds that are left for the search where the method has taken them all."""
METHOD_SHARE = 0.2
"""Of the budget, what the method may take if it can be hurried."""


class PolishedSolver:
    """Improves what a method has planned, by EILS-style search: as many tasks or more, and none late.

    With a budget, the search has what the method leaves. A method that can be hurried, as trained policies can, has at
    most `METHOD_SHARE` of it; if it is known to need more, or turns out to, the search begins without its plan. With
    more than one thread the others search from the beginning, while the method plans in the first.

    Args:
        solver: the method.
        seed: of the search, >= 0.
        budget: seconds a scenario for the method and the search together, > 0. By default the search ends by itself,
            see `eils.EilsConfig`, and the plan depends neither on the machine nor on the threads.
        threads: how many searches go on at a time, if there is a budget.
    """

    def __init__(self, solver: Solver, seed: int = 0, budget: float | None = None, threads: int = 1) -> None:
        self._solver, self._seed, self._budget, self._threads = solver, seed, budget, threads
        self._pace = 0.0  # seconds that the method has needed for a task, as far as is known
        EilsSolver()  # compiles the search, so that no plan has to wait for it

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`, signed with the method's name and "+polish"."""
        if self._budget is None:
            plan = self._solver.solve(scenario)
            return EilsSolver(self._seed).improve(scenario, plan, _signed(plan))
        if self._threads == 1:
            return self._plan_and_search(scenario, self._budget, self._seed)
        others = EilsSolver(self._seed, self._budget, threads=self._threads - 1)
        stop = Event()
        plan, other = side_by_side(
            [
                partial(self._plan_and_search, scenario, self._budget, self._seed + 1, stop),
                partial(others.solve, scenario, stop),
            ],
            stop.set,
        )
        mine, theirs = (verify(scenario, each) for each in (plan, other))
        if (theirs.completed, -theirs.cost) > (mine.completed, -mine.cost):
            return Plan(other.routes, scenario.name, plan.method)
        return plan

    def _plan_and_search(self, scenario: Scenario, budget: float, seed: int, stop: Event | None = None) -> Plan:
        begun = time.perf_counter()
        plan: Plan | None
        if not isinstance(self._solver, Hurried):
            plan = self._solver.solve(scenario)
        else:
            allowed = METHOD_SHARE * budget
            plan = None
            if self._pace * scenario.num_tasks < allowed:
                plan = self._solver.solve_within(scenario, allowed)
                self._learn(scenario, time.perf_counter() - begun, plan)
            if plan is None:
                plan = Plan(((),) * scenario.num_robots, method=self._solver.name)
        left = max(LEAST_BUDGET, budget - (time.perf_counter() - begun))
        return EilsSolver(seed, left).improve(scenario, plan, _signed(plan), stop)

    def _learn(self, scenario: Scenario, seconds: float, plan: Plan | None) -> None:
        """Remember how long the method takes; twice as long as this, as a guess, where it did not finish."""
        self._pace = (1 if plan else 2) * seconds / scenario.num_tasks

    def warm_up(self, scenario: Scenario) -> None:
        """Let the method do whatever happens only once, and see how long it takes then."""
        if isinstance(self._solver, NeedsWarmUp):
            self._solver.warm_up(scenario)
        if isinstance(self._solver, Hurried) and self._budget is not None:
            begun = time.perf_counter()
            plan = self._solver.solve_within(scenario, self._budget)
            self._learn(scenario, time.perf_counter() - begun, plan)


def _signed(plan: Plan) -> str:
    return f"{plan.method}+polish"
