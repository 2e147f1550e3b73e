"""PettingZoo's three standard wrappers, with a short cut to the books and a clearer error.

A wrapper of PettingZoo asks the one below it for `agent_selection`, `rewards` and so on, which asks the next: some
fifty calls a turn. These read them from the environment itself. What they do is otherwise PettingZoo's.
"""

from __future__ import annotations

from operator import attrgetter
from typing import Any

from pettingzoo import AECEnv
from pettingzoo.utils.wrappers import (
    AssertOutOfBoundsWrapper,
    BaseWrapper,
    OrderEnforcingWrapper,
    TerminateIllegalWrapper,
)

from mrta_zoo.errors import ActionError


class OutOfBoundsError(ActionError, AssertionError):
    """An action outside the action space; also what PettingZoo's wrapper raises for it."""


def _book(name: str) -> Any:
    return property(attrgetter(f"_innermost.{name}"), doc=f"The environment's `{name}`.")


class _DirectBooks(BaseWrapper[str, Any, Any]):
    """Reads the environment's books without asking the wrappers in between."""

    agent_selection = _book("agent_selection")
    agents = _book("agents")
    terminations = _book("terminations")
    truncations = _book("truncations")
    rewards = _book("rewards")
    infos = _book("infos")
    _cumulative_rewards = _book("_cumulative_rewards")

    def __init__(self, env: AECEnv[str, Any, Any], **options: Any) -> None:
        self._innermost = env.unwrapped
        super().__init__(env, **options)

    def _repr_html_(self) -> str:
        html: str = self._innermost._repr_html_()  # PettingZoo's wrapper passes on no name with an underscore
        return html


class IllegalActionWrapper(_DirectBooks, TerminateIllegalWrapper[str, Any, Any]):
    """PettingZoo's `TerminateIllegalWrapper`: an illegal action ends the episode for everyone."""


class ActionSpaceWrapper(_DirectBooks, AssertOutOfBoundsWrapper[str, Any, Any]):
    """PettingZoo's `AssertOutOfBoundsWrapper` with an error that names the agent, the action and what is valid."""

    def step(self, action: Any) -> None:
        """Step, if the action lies in the action space, or is None for an agent that has terminated.

        Raises:
            OutOfBoundsError: if not.
        """
        agent = self.agent_selection
        if self.terminations[agent] or self.truncations[agent]:
            if action is not None:
                raise OutOfBoundsError(f"{agent} has terminated and sent action {action!r}; expected None")
        else:
            space = self._innermost.action_spaces[agent]
            # The first two terms spare the usual action a longer look.
            inside = type(action) is int and 0 <= action < space.n
            # True is an int to Python, and so to the space.
            if not inside and (isinstance(action, bool) or not space.contains(action)):
                raise OutOfBoundsError(
                    f"{agent} sent action {action!r}; expected a whole number from 0 to {space.n - 1}"
                )
        self.env.step(action)


class OrderWrapper(_DirectBooks, OrderEnforcingWrapper[str, Any, Any]):
    """PettingZoo's `OrderEnforcingWrapper`: an error for what cannot be asked before the first reset."""

    def __str__(self) -> str:
        """The environment's name, as PettingZoo's wrapper (but not a class derived from it) gives."""
        return str(self.env)
