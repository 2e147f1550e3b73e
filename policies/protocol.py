"""Interfaces of policies, which decide for one robot at a time, and solvers, which plan whole missions."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from mrta_zoo.env.observation import Observation
from mrta_zoo.plan import Plan
from mrta_zoo.policies.stop import TimeLimit
from mrta_zoo.scenario import Scenario


@runtime_checkable
class Policy(Protocol):
    """Decides for one robot at a time, from what that robot observes, as in the AEC loop."""

    def act(self, observation: Observation, agent: str) -> int:
        """The task that `agent` takes, given its observation (`mrta_zoo.env.observation`). It must be legal."""
        ...


@runtime_checkable
class Solver(Protocol):
    """Plans a whole mission at once."""

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        ...


@runtime_checkable
class SupportsWarmUp(Protocol):
    """A solver whose first plan takes longer than the others, as something is compiled or loaded for it."""

    def warm_up(self, scenario: Scenario) -> None:
        """Do the work that is needed once, so that it does not count as planning time."""
        ...


@runtime_checkable
class SupportsTimeLimit(Protocol):
    """A solver that gives up when the time is up, even without a plan."""

    @property
    def name(self) -> str:
        """Method name stored in its plans."""
        ...

    def solve_within(self, scenario: Scenario, limit: TimeLimit) -> Plan | None:
        """A plan for `scenario`, or None if the time is up before there is one."""
        ...
