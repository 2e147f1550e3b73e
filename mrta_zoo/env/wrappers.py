"""PettingZoo's three standard wrappers, with direct access to the environment and clearer errors.

A PettingZoo wrapper asks the one below it for `agent_selection`, `rewards` and so on, which asks the next: some fifty
calls per turn. These read them from the environment itself. Where PettingZoo's check an action against what they have
handed out (the mask shown last, the action space), these ask the environment. Otherwise they do what PettingZoo's do.
"""

from __future__ import annotations

from operator import attrgetter
from typing import Any

from pettingzoo import AECEnv
from pettingzoo.utils.env_logger import EnvLogger
from pettingzoo.utils.wrappers import BaseWrapper, OrderEnforcingWrapper

from mrta_zoo.actions import as_action
from mrta_zoo.errors import ActionError, OutOfBoundsError


def _attribute(name: str) -> Any:
    return property(attrgetter(f"_innermost.{name}"), doc=f"The environment's `{name}`.")


class _DirectAccess(BaseWrapper[str, Any, Any]):
    """Reads the environment's attributes without asking the wrappers in between."""

    agent_selection = _attribute("agent_selection")
    terminations = _attribute("terminations")
    truncations = _attribute("truncations")
    rewards = _attribute("rewards")
    infos = _attribute("infos")
    _cumulative_rewards = _attribute("_cumulative_rewards")

    def __init__(self, env: AECEnv[str, Any, Any]) -> None:
        self._innermost: Any = env.unwrapped
        super().__init__(env)

    @property
    def agents(self) -> list[str]:
        """The agents that are there now, as a new list."""
        return list(self._innermost.agents)

    def _over(self) -> bool:
        """Whether the selected agent has terminated."""
        env = self._innermost
        agent = env.agent_selection
        return bool(env.terminations[agent] or env.truncations[agent])

    def __str__(self) -> str:
        """The environment's name, as PettingZoo's wrappers give it."""
        return str(self.env)

    def _repr_html_(self) -> str:
        html: str = self._innermost._repr_html_()  # PettingZoo's wrappers hide names with an underscore
        return html


class IllegalActionWrapper(_DirectAccess):
    """PettingZoo's `TerminateIllegalWrapper`: an illegal action ends the episode for everyone.

    Args:
        env: the environment.
        illegal_reward: reward of the agent that sent it; the others' is 0.
    """

    def __init__(self, env: AECEnv[str, Any, Any], illegal_reward: float) -> None:
        super().__init__(env)
        self._illegal_reward = illegal_reward

    def step(self, action: Any) -> None:
        """Step or, where the environment refuses the action, end the episode."""
        env = self._innermost
        try:
            self.env.step(action)
        except OutOfBoundsError:
            raise
        except ActionError:  # and nothing has changed
            EnvLogger.warn_on_illegal_move()
            env.end_by(env.agent_selection, self._illegal_reward)


class ActionSpaceWrapper(_DirectAccess):
    """PettingZoo's `AssertOutOfBoundsWrapper` with an error that names the agent, the action and what is valid."""

    def step(self, action: Any) -> None:
        """Step, if the action lies in the action space, or is None for an agent that has terminated.

        Raises:
            OutOfBoundsError: if not.
        """
        env = self._innermost
        if not self._over():
            as_action(env.agent_selection, action, env.num_actions)
        elif action is not None:
            raise OutOfBoundsError(f"{env.agent_selection} has terminated and sent action {action!r}; expected None")
        self.env.step(action)


class OrderWrapper(_DirectAccess, OrderEnforcingWrapper[str, Any, Any]):
    """PettingZoo's `OrderEnforcingWrapper`: an error for what cannot be asked before the first reset."""
