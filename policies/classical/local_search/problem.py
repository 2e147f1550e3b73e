"""A scenario as arrays for compiled searches."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from mrta_zoo.rules import travel_time
from mrta_zoo.scenario import FloatArray, Scenario

TOLERANCE = 1e-9
"""Relative error of a time when an insertion is judged by its Shift. Insertions themselves are checked exactly."""


class Problem(NamedTuple):
    """N tasks and M robots. Places are the tasks, then the robots' starts: robot k starts at place N + k.

    Attributes:
        distance: (N + M, N) from each place to each task, in distance units.
        work: (M, N) time that each robot works at each task.
        deadline: (N,) of each task.
        latest: (M, N) latest arrival of each robot at each task, with the tolerance.
        speed: (M,) of each robot.
        neighbours: (N, N') for each task the nearest others in order, at most `MOST_NEIGHBOURS`.
        by_deadline: (N,) the tasks in order of deadline.
    """

    distance: FloatArray
    work: FloatArray
    deadline: FloatArray
    latest: FloatArray
    speed: FloatArray
    neighbours: npt.NDArray[np.int64]
    by_deadline: npt.NDArray[np.int64]


MOST_NEIGHBOURS = 100


def make_problem(scenario: Scenario) -> Problem:
    """The arrays of `scenario`: O((N + M) N) memory."""
    places = np.concatenate([scenario.task_xy, scenario.robot_xy])
    dx, dy = (places[:, None, axis] - scenario.task_xy[None, :, axis] for axis in (0, 1))
    distance = travel_time(dx, dy, 1.0, np.sqrt)
    n = scenario.num_tasks
    count = min(MOST_NEIGHBOURS, n - 1)
    between = distance[:n].copy()
    np.fill_diagonal(between, -1.0)
    work = scenario.workload[None, :] / scenario.capacity[:, None]
    return Problem(
        distance=distance,
        work=work,
        deadline=scenario.deadline.copy(),
        latest=scenario.deadline * (1.0 + TOLERANCE) - work,
        speed=scenario.speed.copy(),
        neighbours=np.argsort(between, axis=1, kind="stable")[:, 1 : count + 1].copy(),
        by_deadline=np.argsort(scenario.deadline, kind="stable"),
    )


def smallest_scenario() -> Scenario:
    """One task and one robot: enough to compile a search."""
    one = np.ones(1)
    return Scenario(task_xy=np.zeros((1, 2)), deadline=one, workload=one, robot_xy=np.zeros((1, 2)), capacity=one)
