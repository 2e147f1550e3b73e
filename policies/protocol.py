"""What everything that chooses tasks has in common."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from mrta_zoo.env.observation import Observation
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario


@runtime_checkable
class Policy(Protocol):
    """Chooses for one robot at a time, from what that robot sees. Sits in the AEC loop."""

    def act(self, observation: Observation, agent: str) -> int:
        """The task that `agent` takes, given its observation (`mrta_zoo.env.observation`). Must be legal."""
        ...


@runtime_checkable
class Solver(Protocol):
    """Plans a whole mission at once."""

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        ...


@runtime_checkable
class NeedsWarmUp(Protocol):
    """A solver whose first plan takes longer than the others, as something is compiled or loaded for it."""

    def warm_up(self, scenario: Scenario) -> None:
        """Do whatever happens only once."""
        ...


@runtime_checkable
class Hurried(Protocol):
    """A solver that can give up."""

    @property
    def name(self) -> str:
        """Method name stored in its plans."""

    def solve_within(self, scenario: Scenario, seconds: float) -> Plan | None:
        """A plan for `scenario`, None if there is none after so many seconds."""
