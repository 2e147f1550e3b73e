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
others it tells what they may choose when they are next free, as far as is known now; it is all 0 if they are
retired. (In the parallel form and in the Gymnasium environment no mask is ever all 0.) ``mask_rule`` says which of the
tasks not yet taken may be chosen:

- ``"feasible"`` (default): those that this robot can finish by their deadline;
- ``"active"``: those whose deadline has not passed;
- ``"unvisited"``: all of them, even if late (the paper's rule, §II-B).

An illegal action ends the episode for everyone in `env()` (PettingZoo's `TerminateIllegalWrapper`): the agent's
reward is `illegal_reward`, the others' is 0. One outside the action space raises `errors.OutOfBoundsError`. In
`raw_env()` either raises `ActionError`, which names the agent, the action and what is valid, and changes nothing.

Observations
------------
``{"observation": {"tasks", "robots", "ego", "mission"}, "action_mask"}``; `mrta_zoo.env.observation` lists the columns.
With ``observation="masked"`` it is ``{"observation", "action_mask"}`` with one vector, the same tables concatenated
(`observation.split` separates them again); with ``observation="flat"`` it is the vector alone, and the mask is in
``infos[agent]["action_mask"]``. `observe` answers for every possible agent at any time; an agent without a robot in the
scenario sees an ``ego`` of zeros and an all-zero mask. `state()` is the vector of tasks, robots and mission without
what belongs to one observer; its size is ``8 max_tasks + 6 max_robots + 3``.

What is handed out
------------------
Observations, masks, states and infos are the caller's: strike out entries, pop keys, write over them. Whether an action
is legal is judged by the environment's own state, never by these. As everywhere in PettingZoo, ``env.infos``,
``env.rewards`` and the like are the environment's own, and `last` reads from them: what you write into them shows
there until the next step. ``env.unwrapped.mission`` is the mission itself, live: read it, but do not write to it.

Rewards
-------
- ``"terminal"`` (default): −cost/N to every agent when the mission ends, with the cost of Eq. 1 of the paper;
- ``"completion"``: 1/N to every agent as each task is completed; adds up to the completion rate;
- ``"individual"``: 1/N to the robot that completed the task; adds up, over all agents, to the completion rate;
- a function ``(mission, finished) -> [a number for each robot]``, see `mrta_zoo.env.rewards`.

A task counts when the clock passes its finish, not when it is chosen.

Termination
-----------
All agents terminate together when the mission ends. With ``staggered=True`` each terminates as soon as it retires;
team rewards then reach only those still there, so ``"individual"`` is the reward to use with it. If no robot can do
anything at the start, all terminate right at the reset, with the reward of a mission that has ended. Nothing
is ever truncated, except by the wrapper after an illegal action.

Infos
-----
All numeric, the same keys for every agent at reset and after every step:

- ``time``: the clock, in time units;
- ``elapsed``: time since this agent's last decision (since the start, if it made none): the duration of a semi-MDP;
- ``completed``: number of tasks completed so far by all robots;
- ``action_mask``: (max_tasks,) int8, as above, for every agent;
- ``mask_reason``: (max_tasks,) int8, why a task is masked, a `mrta_zoo.rules.MaskReason`: 0 choosable, 1 taken,
  2 deadline passed, 3 too late for this robot, 4 padding (all tasks, if there is no robot), 5 ruled out by a
  mask rule of your own. Judged at the time the robot is next free.

Arguments
---------
``help(mrta_v0.env)`` lists them, `mrta_zoo.env.settings.Settings` says what they mean.

`reset(seed=…, options={"scenario": scenario})` plays the given scenario; without it the environment's own, or one drawn
from its generator. The same seed gives the same episode; without a seed the random generator carries on from where it
was.

Parallel form
-------------
`parallel_env(…)` takes the same arguments and ``on_illegal="terminate"``, ``"raise"`` or ``"replace"``; see
`mrta_zoo.env.parallel`. It is a separate implementation because PettingZoo's conversion needs agents that take turns
in cycles.

Other forms
-----------
`mrta_zoo.env.gym_view.ActingRobotEnv` is a Gymnasium environment in which one agent acts for each robot in its turn;
``gymnasium.make("mrta_zoo/mrta-v0")`` makes it, too. `mrta_zoo.env.dead_steps.SkipDeadSteps` is a wrapper that steps
for agents that have terminated.

Rendering
---------
``"ansi"``: text. ``"rgb_array"``: a (720, 1040, 3) uint8 picture: the map with tasks by status and time left, the
robots where they are at this moment with their trails, dashed lines to where they are heading, and what each does.
``"human"``: the same in a window, after the reset and each step; `close` closes it, and if the user does, the episode
goes on without it. Both need ``mrta_zoo[render]`` (pygame), and the window needs a display. PettingZoo's
``RecordVideo`` makes videos of ``"rgb_array"`` (with ``mrta_zoo[video]``).

Version history
---------------
* v0: first release (0.1.0). Before it, ``"human"`` printed text instead of opening a window.
"""

from __future__ import annotations

from typing import Any, Unpack

from pettingzoo import AECEnv

from mrta_zoo.bounds import as_finite
from mrta_zoo.env.aec import AecMrtaEnv
from mrta_zoo.env.parallel import ParallelMrtaEnv
from mrta_zoo.env.settings import TeamOptions, with_options
from mrta_zoo.env.wrappers import ActionSpaceWrapper, IllegalActionWrapper, OrderWrapper

__all__ = ["env", "parallel_env", "raw_env"]


@with_options
def env(*, illegal_reward: float = -1.0, **options: Unpack[TeamOptions]) -> AECEnv[str, Any, Any]:
    """The environment in PettingZoo's standard wrappers: the one to use.

    Args:
        illegal_reward: reward of an agent whose illegal action ends the episode.
        **options: see `mrta_zoo.env.settings.Settings`.

    Raises:
        ConfigError: if an option cannot be used.
    """
    reward = as_finite("illegal_reward", illegal_reward)
    wrapped = IllegalActionWrapper(raw_env(**options), illegal_reward=reward)
    return OrderWrapper(ActionSpaceWrapper(wrapped))


raw_env = AecMrtaEnv
"""The environment without wrappers, see `mrta_zoo.env.aec`."""

parallel_env = ParallelMrtaEnv
"""The parallel form: all robots that are free act at once, see `mrta_zoo.env.parallel`."""
