"""The AEC form of `mrta_v0`, without wrappers: robots take turns, the one that is free first acts next."""

from __future__ import annotations

from typing import Any, ClassVar, Unpack

import numpy as np
import numpy.typing as npt
from pettingzoo import AECEnv

from mrta_zoo.actions import as_action
from mrta_zoo.env.base import EnvBase
from mrta_zoo.env.settings import Settings, TeamOptions, with_options
from mrta_zoo.errors import ActionError
from mrta_zoo.show.render import RENDER_FPS, RENDER_MODES


class AecMrtaEnv(EnvBase, AECEnv[str, Any, Any]):
    """The AEC environment without wrappers.

    Can be pickled and deep-copied at any moment; the copy goes on as the original would.

    Args:
        **options: see `mrta_zoo.env.settings.Settings`.

    Raises:
        ConfigError: if an option cannot be used.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "mrta_v0",
        "render_modes": list(RENDER_MODES),
        "render_fps": RENDER_FPS,
        "is_parallelizable": False,  # PettingZoo's conversion needs cyclic turns
    }

    @with_options
    def __init__(self, **options: Unpack[TeamOptions]) -> None:
        settings = Settings.of(options)
        assert settings.max_tasks is not None
        super().__init__(settings, num_actions=settings.max_tasks)

    def reset(self, seed: int | None = None, options: dict[str, Any] | None = None) -> None:
        """Start an episode.

        Args:
            seed: seeds the random generator, if given.
            options: ``{"scenario": scenario}`` to play that one.

        Raises:
            ConfigError: if an option is unknown or the scenario does not fit.
        """
        rewards = self._world.reset(seed, options)
        self.agents = list(self._world.agents)
        self.terminations = dict.fromkeys(self.agents, False)
        self.truncations = dict.fromkeys(self.agents, False)
        self.rewards = dict.fromkeys(self.agents, 0.0)
        self._cumulative_rewards = dict.fromkeys(self.agents, 0.0)
        self._skip_agent_selection = None
        self._settle(rewards)
        if self.render_mode == "human":
            self.render()

    def step(self, action: Any) -> None:
        """Let the selected robot take a task, or None if it has terminated.

        Raises:
            ActionError: if it may not; nothing is changed then.
        """
        if not getattr(self, "agents", None):
            raise ActionError(f"there is no agent to take action {action!r}; call reset() first")
        agent = self.agent_selection
        if self.terminations[agent] or self.truncations[agent]:
            self._was_dead_step(action)
            return
        world = self._world
        task = as_action(agent, action, self.num_actions)
        try:
            world.take(world.index[agent], task)
        except ActionError as error:
            raise ActionError(f"{agent} sent action {task}: {error}") from None
        self._cumulative_rewards[agent] = 0.0
        self._settle(world.advance())
        if self.render_mode == "human":
            self.render()

    def observe(self, agent: str) -> Any:
        """What an agent sees now; any possible agent, at any time after the first reset."""
        robot = self._world.robot(agent)
        return self._world.seen_by(robot, self._world.mask(robot))

    def mask(self, agent: str) -> npt.NDArray[np.int8]:
        """(max_tasks,) int8, 1 where the agent may choose when next free; its actions are checked against this."""
        return self._world.mask(self._world.robot(agent))

    def end_by(self, agent: str, reward: float) -> None:
        """End the episode for everyone after an illegal action of `agent`, which gets `reward`; the others get 0."""
        self.terminations = dict.fromkeys(self.agents, True)
        self.truncations = dict.fromkeys(self.agents, True)
        self.rewards = dict.fromkeys(self.agents, 0.0) | {agent: reward}
        self._cumulative_rewards[agent] = 0.0
        self._accumulate_rewards()
        self._deads_step_first()

    def _settle(self, rewards: list[float]) -> None:
        """Update rewards, infos, terminations and the agent to act after the clock has moved."""
        mission, agents = self._world.mission, self.agents
        infos, given = self._world.infos(), dict(zip(self._world.agents, rewards, strict=True))
        gone = len(agents) < len(rewards)  # some agents have left, if staggered
        self.rewards = {agent: given[agent] for agent in agents} if gone else given
        self.infos = {agent: infos[agent] for agent in agents} if gone else infos
        for agent, reward in self.rewards.items():
            self._cumulative_rewards[agent] += reward
        if mission.done:
            self.terminations = dict.fromkeys(agents, True)
            self.agent_selection = agents[0]
            return
        self.agent_selection = self._world.names[mission.actor]
        if self.settings.staggered and any(mission.retired):
            self.terminations = {agent: self._world.retired(agent) for agent in agents}
            self._deads_step_first()
