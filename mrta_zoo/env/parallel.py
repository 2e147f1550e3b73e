"""The parallel form of `mrta_v0`: in each step all robots that are free choose at once.

In each step the agents that must choose are the robots that are free now and have something to choose. Their masks show
those tasks. All others, under way or retired, have only the no-op, action ``max_tasks``; leaving them out of `step`'s
actions means the same. Then the clock moves to the next moment at which a robot is free.

**Conflicts.** When several free robots choose the same task in one step, the one with the lowest index gets it. The
others choose again in the next step: the clock does not move, and their ``infos[agent]["conflict"]`` is 1.

**Illegal actions** are those the mask forbids, including the no-op (or no action) of a robot that must choose. With
``on_illegal="terminate"`` they end the episode for everyone: each agent that sent one is rewarded with
`illegal_reward`, the others with 0, and no task is taken. With ``on_illegal="raise"`` they raise `ActionError` and
change nothing. With ``on_illegal="replace"`` each is replaced by the next legal action, upwards from it and then from
0, for learners without masking. An action outside the action space, or for an agent that is not there, always raises.

Observations, rewards, infos and termination are those of the AEC form, except that ``action_mask`` is
(max_tasks + 1,) and applies to the current step; ``mask_reason`` stays (max_tasks,) and tells why a task is masked
when the robot is next free. No mask is all 0: that of an agent that has terminated shows the no-op. If no robot can do
anything at the start, every agent has only the no-op, and the first step ends the episode, with the reward of a mission
that has ended.

**Teams of varying size.** A scenario may have fewer robots than there are possible agents. With ``absent="omit"`` (the
default) the episode has fewer agents, as PettingZoo allows. With ``absent="noop"`` all possible agents are there to the
end, those without a robot with only the no-op and reward 0: for libraries that want the same agents in every episode
(SuperSuit's vector environments, TorchRL).

Every plan made here can also be made in the AEC form: finish times depend only on who does what in which order. Where
no two robots are free at the same time, the two forms agree decision by decision.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar, Unpack, get_args

import numpy as np
import numpy.typing as npt
from pettingzoo import ParallelEnv
from pettingzoo.utils.env_logger import EnvLogger

from mrta_zoo.actions import as_action, next_legal, noop
from mrta_zoo.bounds import as_finite
from mrta_zoo.digits import full
from mrta_zoo.env.base import EnvBase
from mrta_zoo.env.settings import Illegal, Settings, TeamOptions, one_of, with_options
from mrta_zoo.env.world import Info
from mrta_zoo.errors import ActionError
from mrta_zoo.show.render import RENDER_FPS, RENDER_MODES

StepResult = tuple[dict[str, Any], dict[str, float], dict[str, bool], dict[str, bool], dict[str, Info]]


class ParallelMrtaEnv(EnvBase, ParallelEnv[str, Any, Any]):
    """The parallel environment. Can be pickled and deep-copied at any moment.

    Args:
        on_illegal: what an illegal action does: ``"terminate"``, ``"raise"`` or ``"replace"``.
        illegal_reward: reward of an agent whose illegal action ends the episode.
        **options: see `mrta_zoo.env.settings.Settings`.

    Raises:
        ConfigError: if an option cannot be used.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "mrta_v0",
        "render_modes": list(RENDER_MODES),
        "render_fps": RENDER_FPS,
    }

    @with_options
    def __init__(
        self, *, on_illegal: Illegal = "terminate", illegal_reward: float = -1.0, **options: Unpack[TeamOptions]
    ) -> None:
        one_of("on_illegal", on_illegal, get_args(Illegal))
        settings = Settings.of(options)
        assert settings.max_tasks is not None
        self.noop = noop(settings.max_tasks)
        super().__init__(settings, num_actions=self.noop + 1)
        self.on_illegal = on_illegal
        self.illegal_reward = as_finite("illegal_reward", illegal_reward)
        self._present: list[str] = []
        self._choosing: set[int] = set()
        self._owed: list[float] = []  # reset returns no rewards, so the first step pays those of the start

    @property
    def agents(self) -> list[str]:
        """The agents that are there now, in order; empty when the episode is over."""
        return list(self._present)

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Info]]:
        """Start an episode; arguments and errors as in the AEC form."""
        self._owed = self._world.reset(seed, options)
        self._present = list(self._world.agents)
        self._choosing = set(self.mission.free())
        if self.render_mode == "human":
            self.render()
        return {agent: self.observe(agent) for agent in self._present}, self._infos(set())

    def step(self, actions: dict[str, Any]) -> StepResult:
        """Let every robot that must choose take a task.

        Args:
            actions: a task for each agent that must choose; the no-op, or nothing, for the others.

        Returns:
            Observations, rewards, terminations, truncations and infos of the agents that were there before the step.

        Raises:
            ActionError: see the module's docstring.
        """
        world, mission = self._world, self.mission
        if not self._present:
            EnvLogger.warn_step_after_terminated_truncated()
            return {}, {}, {}, {}, {}
        choices = self._choices(actions)
        illegal = [agent for agent, action in choices.items() if not self.mask(agent)[action]]
        if illegal and self.on_illegal == "replace":
            choices |= {agent: next_legal(self.mask(agent), choices[agent]) for agent in illegal}
        elif illegal:
            if self.on_illegal == "raise":
                raise self._illegal(illegal[0], choices[illegal[0]])
            EnvLogger.warn_on_illegal_move()
            rewards = [self.illegal_reward if agent in illegal else 0.0 for agent in world.agents]
            return self._result(rewards, set(), dict.fromkeys(self._present, True))
        if mission.done:  # nothing could be done from the start
            return self._result(self._owed, set(), dict.fromkeys(self._present, True))
        taken: set[int] = set()
        losers: set[int] = set()
        for agent in self._present:  # in order of robot index
            task = choices[agent]
            if task in taken:
                losers.add(world.index[agent])
            elif task != self.noop:
                world.take(world.index[agent], task)
                taken.add(task)
        rewards = [owed + new for owed, new in zip(self._owed, world.advance(), strict=True)]
        self._owed = [0.0] * len(rewards)
        self._choosing = set(mission.free())
        staggered = self.settings.staggered
        over = {agent: mission.done or (staggered and world.retired(agent)) for agent in self._present}
        return self._result(rewards, losers, over)

    def observe(self, agent: str) -> Any:
        """What an agent sees now; any possible agent, at any time after the first reset."""
        return self._world.seen_by(self._world.robot(agent), self.mask(agent))

    def mask(self, agent: str) -> npt.NDArray[np.int8]:
        """(max_tasks + 1,) int8, 1 where the agent may choose in this step."""
        robot = self._world.robot(agent)
        mask = np.zeros(self.noop + 1, dtype=np.int8)
        if robot in self._choosing:
            mask[: self.noop] = self._world.mask(robot)
        else:
            mask[self.noop] = 1
        return mask

    def _choices(self, actions: dict[str, Any]) -> dict[str, int]:
        """An action within the action space for every agent."""
        if not isinstance(actions, Mapping):
            raise ActionError(f"actions is {actions!r}; expected a dictionary with an action for each agent")
        for agent in actions:
            if agent not in self._present:
                there = ", ".join(self._present[:10]) + (", …" if len(self._present) > 10 else "")
                raise ActionError(f"there is an action for {agent!r}; the agents now are {there}")
        return {
            agent: as_action(agent, actions[agent], self.num_actions) if agent in actions else self.noop
            for agent in self._present
        }

    def _illegal(self, agent: str, action: int) -> ActionError:
        valid = np.flatnonzero(self.mask(agent)).tolist()
        shown = ", ".join(map(str, valid[:10])) + (", …" if len(valid) > 10 else "")
        what = f"action {action}" + (" (the no-op)" if action == self.noop else "")
        robot, why = self._world.index[agent], ""
        if robot not in self._choosing:
            there = robot < self.mission.scenario.num_robots
            why = " (the no-op): it is not free" if there else " (the no-op): the scenario has no such robot"
        return ActionError(f"{agent} sent {what} at time {full(self.mission.time)}; its valid actions are {shown}{why}")

    def _infos(self, losers: set[int]) -> dict[str, Info]:
        infos = self._world.infos()
        for agent in self._present:
            infos[agent]["action_mask"] = self.mask(agent)
            infos[agent]["conflict"] = int(self._world.index[agent] in losers)
        return {agent: infos[agent] for agent in self._present}

    def _result(self, rewards: list[float], losers: set[int], over: dict[str, bool]) -> StepResult:
        if all(over.values()):
            self._choosing = set()
        given = dict(zip(self._world.agents, rewards, strict=True))
        result = (
            {agent: self.observe(agent) for agent in self._present},
            {agent: given[agent] for agent in self._present},
            over,
            dict.fromkeys(self._present, False),
            self._infos(losers),
        )
        self._present = [agent for agent in self._present if not over[agent]]
        if self.render_mode == "human":
            self.render()
        return result
