"""Local search from the plan of any other method."""

from __future__ import annotations

import time

from mrta_zoo.plan import Plan
from mrta_zoo.policies.local_search.eils import EilsSolver
from mrta_zoo.policies.protocol import NeedsWarmUp, Solver
from mrta_zoo.scenario import Scenario

LEAST_BUDGET = 1e-3
"""Seconds that are left for the search where the method has taken them all."""


class PolishedSolver:
    """Improves what a method has planned, by EILS-style search: as many tasks or more, and none late.

    Args:
        solver: the method.
        seed: of the search, >= 0.
        budget: seconds a scenario for the method and the search together, > 0: the search has what the method leaves.
            By default it ends by itself, see `eils.EilsConfig`.
    """

    def __init__(self, solver: Solver, seed: int = 0, budget: float | None = None) -> None:
        self._solver, self._seed, self._budget = solver, seed, budget
        EilsSolver()  # compiles the search, so that no plan has to wait for it

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`, signed with the method's name and "+polish"."""
        begun = time.perf_counter()
        plan = self._solver.solve(scenario)
        left = None if self._budget is None else max(LEAST_BUDGET, self._budget - (time.perf_counter() - begun))
        return EilsSolver(self._seed, left).improve(scenario, plan, f"{plan.method}+polish")

    def warm_up(self, scenario: Scenario) -> None:
        """Let the method do whatever happens only once."""
        if isinstance(self._solver, NeedsWarmUp):
            self._solver.warm_up(scenario)
