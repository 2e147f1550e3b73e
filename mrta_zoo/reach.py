"""Reach: the tasks that each robot could finish in time if it went straight there at the start."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from mrta_zoo.rules import travel_time, visit
from mrta_zoo.scenario import FloatArray, Scenario

BoolArray = npt.NDArray[np.bool_]


def first_finish(scenario: Scenario, robots: Sequence[int] | slice = slice(None)) -> FloatArray:
    """(M, N) when each robot, or each of some `robots`, would finish each task if it took it first."""
    dx, dy = (scenario.task_xy[:, axis] - scenario.robot_xy[robots, axis, None] for axis in (0, 1))
    travel = travel_time(dx, dy, scenario.speed[robots, None], np.sqrt)
    finish: FloatArray = visit(0.0, travel, scenario.workload / scenario.capacity[robots, None]).finishes
    return finish


def in_time(scenario: Scenario) -> BoolArray:
    """(M, N) bool, the tasks that each robot could finish by their deadlines if it took them first."""
    return first_finish(scenario) <= scenario.deadline
