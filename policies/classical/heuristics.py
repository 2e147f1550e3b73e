"""Dispatching rules that need no training: random, nearest, earliest deadline.

They see only the observation, like any policy. Under the mask rule "feasible" (the default) they choose among the
tasks that the robot can finish by their deadlines.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from mrta_zoo.actions import must_wait, noop
from mrta_zoo.env.observation import EGO_FEATURES, TASK_FEATURES, Observation
from mrta_zoo.errors import ActionError

TIE = 2e-7
"""Distances that differ by no more than this share of the frame's longer side (`mrta_zoo.scales`) count as equal:
observations are rounded to float32."""

_X, _Y, _DEADLINE = (TASK_FEATURES.index(name) for name in ("x", "y", "deadline"))
_EGO_X, _EGO_Y = (EGO_FEATURES.index(name) for name in ("x", "y"))

Indices = npt.NDArray[np.intp]


class RandomPolicy:
    """Any legal task, each with the same probability.

    Args:
        seed: of the draws, >= 0.
    """

    def __init__(self, seed: int = 0) -> None:
        self._rng = np.random.default_rng(seed)

    def act(self, observation: Observation, agent: str = "") -> int:
        """The task to take.

        Raises:
            ActionError: if there is nothing to choose.
        """
        return int(self._rng.choice(_choices(observation, agent)))


class NearestPolicy:
    """The nearest legal task; of equally near ones the one with the lowest index."""

    memoryless = True

    def act(self, observation: Observation, agent: str = "") -> int:
        """The task to take.

        Raises:
            ActionError: if there is nothing to choose.
        """
        return int(_nearest(observation, _choices(observation, agent))[0])


class EarliestDeadlinePolicy:
    """The legal task with the earliest deadline; of equal ones the nearest, then the one with the lowest index.

    Deadlines too late to bind (`mrta_zoo.scales.slack_time`) look equal in observations, so they count as equal.
    """

    memoryless = True

    def act(self, observation: Observation, agent: str = "") -> int:
        """The task to take.

        Raises:
            ActionError: if there is nothing to choose.
        """
        choices, tasks = _choices(observation, agent), observation["observation"]["tasks"]
        if must_wait(observation["action_mask"], len(tasks)):
            return noop(len(tasks))
        return int(_nearest(observation, _least(choices, tasks[choices, _DEADLINE], tie=0.0))[0])


def _choices(observation: Observation, agent: str) -> Indices:
    """The legal tasks, in order of index."""
    choices = np.flatnonzero(observation["action_mask"])
    if len(choices) == 0:
        raise ActionError(f"{agent or 'the robot'} has nothing to choose; it is not its turn, or it is retired")
    return choices


def _nearest(observation: Observation, tasks: Indices) -> Indices:
    """The tasks of `tasks` nearest to the robot, in order of index."""
    seen = observation["observation"]
    if must_wait(observation["action_mask"], len(seen["tasks"])):
        return tasks
    places = seen["tasks"][tasks].astype(np.float64)
    ego = seen["ego"].astype(np.float64)
    return _least(tasks, np.hypot(places[:, _X] - ego[_EGO_X], places[:, _Y] - ego[_EGO_Y]))


def _least(tasks: Indices, values: npt.NDArray[np.floating], tie: float = TIE) -> Indices:
    """The tasks of `tasks` with the least value, up to `tie`."""
    least: Indices = tasks[values <= values.min() + tie]
    return least
