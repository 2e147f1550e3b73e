"""Rewards: functions of the mission and what was just finished. ``mrta_v0.env(reward=function)`` takes your own."""

from __future__ import annotations

import math
import reprlib
from collections.abc import Callable, Sequence
from typing import Literal, get_args

from mrta_zoo.errors import ConfigError
from mrta_zoo.mission import Finished, Mission
from mrta_zoo.wording import counted

RewardName = Literal["terminal", "completion", "individual"]

Reward = Callable[[Mission, Sequence[Finished]], Sequence[float]]
"""``reward(mission, finished) -> [a number for each robot]``.

Called once at reset, with nothing finished, and once after every step, with what was finished in it, in order of
time; the numbers must be finite. Within an episode every finish is reported exactly once, and ``mission.done`` is
seen exactly once. The function may keep or change the list of what was finished. The mission is the environment's own,
as a copy would cost more than the step: the function must not change it, as that would change the episode. It has to be
a module-level function (or a picklable object) if the environment is to be pickled.
"""


def terminal(mission: Mission, finished: Sequence[Finished]) -> list[float]:
    """−cost/N to every robot when the mission ends (Eq. 1 of the paper), 0 before."""
    m = mission.scenario.num_robots
    if not mission.done:
        return [0.0] * m
    return [-mission.cost() / mission.scenario.num_tasks] * m


def completion(mission: Mission, finished: Sequence[Finished]) -> list[float]:
    """1/N to every robot as each task is completed; the sum over an episode is the completion rate."""
    completed = sum(event.completed for event in finished)
    return [completed / mission.scenario.num_tasks] * mission.scenario.num_robots


def individual(mission: Mission, finished: Sequence[Finished]) -> list[float]:
    """1/N to the robot that completed the task; the sum over episode and robots is the completion rate."""
    rewards = [0.0] * mission.scenario.num_robots
    for event in finished:
        if event.completed:
            rewards[event.robot] += 1.0 / mission.scenario.num_tasks
    return rewards


REWARDS: dict[str, Reward] = {"terminal": terminal, "completion": completion, "individual": individual}


def make_reward(reward: RewardName | Reward) -> Reward:
    """The named reward, or the function itself.

    Raises:
        ConfigError: if there is no reward of that name.
    """
    if callable(reward):
        return reward
    if not isinstance(reward, str) or reward not in REWARDS:
        raise ConfigError(
            f"reward is {reward!r}; expected one of {', '.join(get_args(RewardName))}, or a function of "
            "a mission and the tasks just finished"
        )
    return REWARDS[reward]


def as_rewards(given: object, robots: int) -> list[float]:
    """What a reward function returned, as a float for each robot.

    Raises:
        ConfigError: if it is anything but a finite number for each robot.
    """
    try:
        if isinstance(given, (str, dict)):  # their letters and keys are no rewards
            raise TypeError
        rewards = list(map(float, given))  # type: ignore[call-overload]
    except (TypeError, ValueError, OverflowError):
        raise ConfigError(
            f"the reward function gave {reprlib.repr(given)}; expected a list of {robots} numbers, one for each robot"
        ) from None
    if len(rewards) != robots:
        raise ConfigError(
            f"the reward function gave {counted(len(rewards), 'number')}; expected {robots}, one for each robot"
        )
    if not all(map(math.isfinite, rewards)):
        robot = list(map(math.isfinite, rewards)).index(False)
        raise ConfigError(f"the reward function gave {rewards[robot]} to robot {robot}; expected a finite number")
    return rewards
