"""Multi-robot task allocation: robots with places, speeds and work capacities share tasks with deadlines.

=======================  ==============================================================================
Import                   ``from mrta_zoo import mrta_v0``
Creation                 ``mrta_v0.env()``, ``mrta_v0.raw_env()``, ``mrta_v0.parallel_env()``, or with
                         PettingZoo >= 1.27 ``pettingzoo.make("aec", "mrta_zoo/mrta-v0")`` (or "parallel")
Agents                   ``robot_0`` … ``robot_{max_robots-1}``; 7 possible agents by default
Actions                  ``Discrete(max_tasks)``; parallel form ``Discrete(max_tasks + 1)``
Observations             ``Dict`` of tables or a vector, and ``action_mask``, or a flat ``Box``; float32 in [0, 1]
State                    ``Box``, float32 in [0, 1]
Turns                    event-driven: the robot that becomes free first acts next
Manual control           no
=======================  ==============================================================================

>>> from mrta_zoo import mrta_v0
>>> env = mrta_v0.env()
>>> env.reset(seed=1)
>>> for agent in env.agent_iter():
...     observation, reward, termination, truncation, info = env.last()
...     done = termination or truncation
...     env.step(None if done else env.action_space(agent).sample(observation["action_mask"]))

A robot that takes task j at time t finishes it at t + distance/speed + workload/capacity. The task is *completed* if
that is no later than its deadline, else *missed*. A task is taken by one robot, once, at the moment it is chosen.

Turns
-----
The next robot to act is the one that becomes free first; ties go to the lowest index. So robots do not act in
cycles: `agent_selection` may be the same robot twice in a row. A robot that is free and has nothing left to choose is
retired and never selected again. The mission ends when all are retired.

A scenario may have fewer robots and tasks than there is room for: it then has fewer `agents` (never fewer
`possible_agents`), and padding actions are masked. With ``absent="noop"`` all possible agents are there, for libraries
that want the same ones in every episode: those without a robot get no turn, have nothing to choose and reward 0, and
terminate when the mission ends.

Actions
-------
The index of the task to take. Tasks at or above the scenario's number of tasks are padding.

Mask
----
``action_mask`` is (max_tasks,) int8, 1 where the agent may choose; never all 0 for the agent that is to act. For the
others it tells what they may choose when they are next free, as far as is known now: nothing, all 0, if they are
retired. (In the parallel form and in the Gymnasium environment no mask is ever all 0.) ``mask_rule`` says which of the
tasks not yet taken may be chosen:

- ``"feasible"`` (default): those that this robot can finish by their deadline;
- ``"active"``: those whose deadline has not passed;
- ``"unvisited"``: all, even if late (the paper's rule).

An illegal action ends the episode for everyone in `env()` (PettingZoo's `TerminateIllegalWrapper`): the agent's
reward is `illegal_reward`, the others' is 0. One outside the action space raises `errors.OutOfBoundsError`. In
`raw_env()` either raises `ActionError`, which names the agent, the action and what is valid, and changes nothing.

Observations
------------
``{"observation": {"tasks", "robots", "ego", "mission"}, "action_mask"}``; `mrta_zoo.observation` lists the columns.
With ``observation="masked"`` it is ``{"observation", "action_mask"}`` with one vector, the same tables one after
another (`observation.split` takes it apart again); with ``observation="flat"`` the vector alone, and the mask is in
``infos[agent]["action_mask"]``. `observe` answers for every possible agent at any time; one
that the scenario does not have sees an ``ego`` of zeros and an empty mask. `state()` is the vector of tasks, robots and
mission without what belongs to one observer; its size is ``8 max_tasks + 6 max_robots + 3``.

What is handed out
------------------
Observations, masks, states and infos are the caller's: strike out entries, pop keys, write over them. Whether an action
is legal is judged by the environment's own state, never by these. As everywhere in PettingZoo, ``env.infos``,
``env.rewards`` and the like are the environment's books, to which `last` points: what is written into them shows there
until the next step. ``env.unwrapped.mission`` is the mission itself, live: read it, but do not write to it.

Rewards
-------
- ``"terminal"`` (default): −cost/N to every agent when the mission ends, with the cost of Eq. 1 of the paper;
- ``"completion"``: 1/N to every agent as each task is completed; sums up to the completion rate;
- ``"individual"``: 1/N to the robot that completed the task; sums up, over all agents, to the completion rate;
- a function ``(mission, finished) -> [a number for each robot]``, see `mrta_zoo.rewards`.

A task counts when the clock passes its finish, not when it is chosen.

Termination
-----------
All agents terminate together when the mission ends. With ``staggered=True`` each terminates as soon as it retires;
team rewards then reach only those still there, so that ``"individual"`` is the reward to go with it. Where no robot
can do anything at the start, all terminate right at the reset, with the reward of a mission that has ended. Nothing
is ever truncated, except by the wrapper after an illegal action.

Infos
-----
All numeric, the same keys for every agent at reset and after every step:

- ``time``: the clock, in time units;
- ``elapsed``: time since this agent's last decision (since the start, if it made none): the duration of a semi-MDP;
- ``completed``: number of tasks completed so far by all robots;
- ``action_mask``: (max_tasks,) int8, as above, for every agent;
- ``mask_reason``: (max_tasks,) int8, why a task is masked, a `mrta_zoo.rules.MaskReason`: 0 choosable, 1 taken,
  2 deadline passed, 3 too late for this robot, 4 padding (all tasks, if there is no robot). Judged at the time the
  robot is next free.

Arguments
---------
``help(mrta_v0.env)`` lists them, `mrta_zoo.settings.Settings` says what they mean.

`reset(seed=…, options={"scenario": scenario})` plays the given scenario; without it the environment's own, or one drawn
from its generator. The same seed gives the same episode; without a seed the random generator goes on where it was.

Parallel form
-------------
`parallel_env(…)` takes the same arguments and ``on_illegal="terminate"``, ``"raise"`` or ``"replace"``; see
`mrta_zoo.parallel`. It is an implementation of its own because PettingZoo's conversion asks for agents that take cyclic
turns.

Other forms
-----------
`mrta_zoo.gym_view.ActingRobotEnv` is a Gymnasium environment, in which one agent acts for each robot in its turn, also
by ``gymnasium.make("mrta_zoo/mrta-v0")``; `mrta_zoo.dead_steps.SkipDeadSteps` a wrapper that steps for agents that have
terminated.

Rendering
---------
``"ansi"``: text. ``"rgb_array"``: a (720, 1040, 3) uint8 picture: the map with tasks by status and time left, the
robots where they are at this moment with their trails, dashed lines to where they are heading, and what each does.
``"human"``: the same in a window, after the reset and each step; `close` closes it, and if its user does, the episode
goes on without. Both need ``mrta_zoo[render]`` (pygame), the window a display, too. PettingZoo's ``RecordVideo`` makes
videos of ``"rgb_array"`` (with ``mrta_zoo[video]``).

Version history
---------------
* v0: first release (0.1.0). Before it, ``"human"`` printed text instead of opening a window.
"""

from __future__ import annotations

from typing import Any, ClassVar, Unpack

import numpy as np
import numpy.typing as npt
from pettingzoo import AECEnv

from mrta_zoo.bounds import as_finite
from mrta_zoo.env_base import EnvBase
from mrta_zoo.errors import ActionError
from mrta_zoo.parallel import ParallelMrtaEnv
from mrta_zoo.render import RENDER_FPS, RENDER_MODES
from mrta_zoo.settings import Settings, TeamOptions, with_options
from mrta_zoo.wrappers import ActionSpaceWrapper, IllegalActionWrapper, OrderWrapper

__all__ = ["env", "parallel_env", "raw_env"]


@with_options
def env(*, illegal_reward: float = -1.0, **options: Unpack[TeamOptions]) -> AECEnv[str, Any, Any]:
    """The environment in PettingZoo's standard wrappers: the one to use.

    Args:
        illegal_reward: reward of an agent whose illegal action ends the episode.
        **options: see `mrta_zoo.settings.Settings`.

    Raises:
        ConfigError: if an option cannot be used.
    """
    reward = as_finite("illegal_reward", illegal_reward)
    wrapped = IllegalActionWrapper(raw_env(**options), illegal_reward=reward)
    return OrderWrapper(ActionSpaceWrapper(wrapped))


parallel_env = ParallelMrtaEnv
"""The parallel form: all robots that are free act at once, see `mrta_zoo.parallel`."""


class raw_env(EnvBase, AECEnv[str, Any, Any]):  # noqa: N801  (PettingZoo's name for it)
    """The environment without wrappers.

    Can be pickled and deep-copied at any moment; the copy goes on as the original would.

    Args:
        **options: see `mrta_zoo.settings.Settings`.

    Raises:
        ConfigError: if an option cannot be used.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "name": "mrta_v0",
        "render_modes": list(RENDER_MODES),
        "render_fps": RENDER_FPS,
        "is_parallelizable": False,  # PettingZoo's conversion asks for cyclic turns
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
        task = world.as_action(agent, action)
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
        return self._world.seen_by(self._world.robot(agent), self.mask(agent))

    def mask(self, agent: str) -> npt.NDArray[np.int8]:
        """(max_tasks,) int8, 1 where the agent may choose when it is next free; by this its actions are judged."""
        return self._world.mask(self._world.robot(agent))

    def end_by(self, agent: str, reward: float) -> None:
        """End the episode for everyone because `agent` did what it may not: it gets `reward`, the others 0."""
        self.terminations = dict.fromkeys(self.agents, True)
        self.truncations = dict.fromkeys(self.agents, True)
        self.rewards = dict.fromkeys(self.agents, 0.0) | {agent: reward}
        self._cumulative_rewards[agent] = 0.0
        self._accumulate_rewards()
        self._deads_step_first()

    def _settle(self, rewards: list[float]) -> None:
        """Enter the books after the clock has moved: rewards, terminations, infos, who is next."""
        mission, agents = self._world.mission, self.agents
        infos, given = self._world.infos(), dict(zip(self._world.agents, rewards, strict=True))
        gone = len(agents) < len(rewards)  # some are, if staggered
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
