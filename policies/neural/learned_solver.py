"""Trained policies as methods, by name or path. Importing this does not import torch."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mrta_zoo.extras import require
from mrta_zoo.plan import Plan
from mrta_zoo.policies.options import SolverOptions
from mrta_zoo.policies.stop import TimeLimit
from mrta_zoo.scenario import Scenario

if TYPE_CHECKING:
    from mrta_zoo.policies.neural.policy import NeuralPolicy


class LearnedSolver:
    """Plans with a trained policy.

    Args:
        policy: the policy.
        options: how it plans.
    """

    def __init__(self, policy: NeuralPolicy, options: SolverOptions) -> None:
        self.policy, self.options = policy, options

    @property
    def name(self) -> str:
        """Method name stored in plans."""
        return self.policy.name

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        return self.policy.solve_with(scenario, self.options)

    def solve_within(self, scenario: Scenario, limit: TimeLimit) -> Plan | None:
        """The best plan found within `limit`, or None if not even the greedy mission is finished by then."""
        return self.policy.solve_within(scenario, limit, self.options)

    def warm_up(self, scenario: Scenario) -> None:
        """Plan once without a search: the first pass of a network is slower than those that follow."""
        self.policy.solve(scenario, mask_rule=self.options.mask_rule)


def load_learned(name: str) -> NeuralPolicy:
    """A trained policy, by name or path.

    Raises:
        ConfigError: if there is no such policy, or its files are damaged.
        MissingExtraError: if torch is not installed.
    """
    require("torch", f"method {name!r}")
    from mrta_zoo.policies.neural.policy import load_policy

    return load_policy(name)
