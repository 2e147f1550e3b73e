"""An AEC wrapper that steps for terminated agents, so that loops need not."""

from __future__ import annotations

from typing import Any

from pettingzoo import AECEnv
from pettingzoo.utils.wrappers import BaseWrapper


class SkipDeadSteps(BaseWrapper[str, Any, Any]):
    """Takes the steps with None that PettingZoo requires of terminated agents, so that every turn is a decision.

    >>> from mrta_zoo import mrta_v0
    >>> from mrta_zoo.env.dead_steps import SkipDeadSteps
    >>> env = SkipDeadSteps(mrta_v0.env(reward="individual"))
    >>> env.reset(seed=1)
    >>> for agent in env.agent_iter():
    ...     observation, reward, *_ = env.last()  # the reward of this agent's previous decision
    ...     env.step(env.action_space(agent).sample(observation["action_mask"]))
    >>> env.final_rewards  # and of everyone's last

    Attributes:
        final_rewards: for each agent that has terminated in this episode, its reward since its last decision, which
            `last` would have shown in its dead step.
    """

    def __init__(self, env: AECEnv[str, Any, Any]) -> None:
        super().__init__(env)
        self.final_rewards: dict[str, float] = {}

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> None:
        """Start an episode."""
        super().reset(seed, options)
        self.final_rewards = {}
        self._skip()

    def step(self, action: Any) -> None:
        """Step for the selected agent, which has not terminated, then for those that have."""
        super().step(action)
        self._skip()

    def _skip(self) -> None:
        while self.env.agents:
            agent = self.env.agent_selection
            if not (self.env.terminations[agent] or self.env.truncations[agent]):
                return
            self.final_rewards[agent] = float(self.env.last(observe=False)[1])
            self.env.step(None)
