"""By what the quantities of a mission are divided, so that neither units nor where it lies nor one odd value matter.

=========  ================================================================================================
places     from the frame's lowest corner, divided by L, the longer side of the frame, see `frame_of`
times      divided by T, the latest deadline that can bind, see `slack_time`
workloads  divided by W, the largest, see `work_scale`
capacity   divided by C, the largest capacity; speed by V, the largest speed, see `usual`
=========  ================================================================================================

What is larger than its scale counts as 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from mrta_zoo.rules import finish_time, may_choose, travel_time
from mrta_zoo.scenario import FloatArray, Scenario

BoolArray = npt.NDArray[np.bool_]

MOST_MARGIN = 0.25
"""The frame is the map where no margin around the places is wider than this share of their extent."""
ODD = 10.0
"""A capacity or speed is odd if it is more than this many times as large as those of half of the robots; places are, if
nobody can get to or from them in time, and the box around all is this many times as large as without them."""
HEAVY = 4.0
"""W is at most this many times as large as half of the workloads."""


@dataclass(frozen=True, slots=True)
class Scales:
    """The scales of one scenario. For a batch, fields are tensors with one row for each scenario.

    Attributes:
        origin: (2,) lowest x and y of the frame.
        extent: (2,) width and height of the frame.
        length: L, the longer of the two, > 0.
        time: T, > 0.
        work: W, > 0; 1 if there is no work.
        capacity: C, > 0.
        speed: V, > 0.
    """

    origin: Any
    extent: Any
    length: Any
    time: Any
    work: Any
    capacity: Any
    speed: Any

    @classmethod
    def of(cls, scenario: Scenario) -> Scales:
        """The scales of a scenario; floats and (2,) float64 arrays."""
        possible = in_time(scenario)
        origin, extent = frame_of(scenario, possible)
        useful = possible.any(axis=1) if possible.any() else slice(None)
        capacity, speed = usual(scenario.capacity[useful]), usual(scenario.speed[useful])
        return cls(
            origin=origin,
            extent=extent,
            length=float(extent.max()),
            time=slack_time(scenario, float(np.hypot(*extent))),
            work=work_scale(scenario, capacity),
            capacity=capacity,
            speed=speed,
        )

    def each(self, change: Callable[[Any], Any]) -> Scales:
        """The same, every field changed."""
        return Scales(*(change(getattr(self, field.name)) for field in fields(self)))

    @property
    def crossing_ratio(self) -> Any:
        """L/V/T squashed to [0, 1)."""
        ratio = self.length / self.speed / self.time
        return ratio / (1 + ratio)

    @property
    def work_ratio(self) -> Any:
        """W/C/T squashed to [0, 1)."""
        ratio = self.work / self.capacity / self.time
        return ratio / (1 + ratio)


def frame_of(scenario: Scenario, possible: BoolArray | None = None) -> tuple[FloatArray, FloatArray]:
    """The part of the plane that the mission takes place in: lowest x and y, and width and height, both (2,).

    It is the map where the places fill it more or less, otherwise the box around all tasks and robots, less odd places
    (see `ODD`): how large a map was declared, and where 0 and 0 lie, is a matter of taste.

    Args:
        scenario: the mission.
        possible: its `in_time`, if known.
    """
    least, most = _box(scenario.task_xy, scenario.robot_xy)
    possible = in_time(scenario) if possible is None else possible
    if possible.any():
        low, high = _box(scenario.task_xy[possible.any(axis=0)], scenario.robot_xy[possible.any(axis=1)])
        if 0 < ODD * (high - low).max() < (most - least).max():
            return low, high - low
    origin, end = np.array(scenario.map_origin), np.array(scenario.map_end)
    size = float((most - least).max())
    margin = float(max((least - origin).max(), (end - most).max()))
    if 0 < size * MOST_MARGIN < margin:
        return least, most - least
    return origin, np.array(scenario.map_size)


def in_time(scenario: Scenario) -> BoolArray:
    """(M, N) what each robot could finish by its deadline if it went straight there at the start."""
    dx, dy = (scenario.task_xy[:, axis] - scenario.robot_xy[:, axis, None] for axis in (0, 1))
    travel = travel_time(dx, dy, scenario.speed[:, None], np.sqrt)
    finish = finish_time(0.0, travel, scenario.workload / scenario.capacity[:, None])
    return np.asarray(may_choose("feasible", finish, 0.0, scenario.deadline))


def slack_time(scenario: Scenario, crossing: float) -> float:
    """T: the latest deadline or, if earlier, the time by which all that can wait could be done: none binds later.

    Say that k tasks have a deadline by d, and the others later ones. By d, the k tasks are done or missed, and
    every robot is free; from then on one robot could do all others by itself, crossing the frame to each of them. So
    none of them needs a deadline later than d and the time which that takes. The earliest such time over all d is
    returned, for the robot that is the median in how long it would take for all tasks; of two, the slower one.

    Args:
        scenario: the mission.
        crossing: the way across the frame.
    """
    alone = crossing * scenario.num_tasks / scenario.speed + scenario.workload.sum() / scenario.capacity
    robot = int(np.argsort(alone, kind="stable")[scenario.num_robots // 2])
    order = np.argsort(scenario.deadline, kind="stable")
    each = crossing / scenario.speed[robot] + scenario.workload[order] / scenario.capacity[robot]
    later = np.cumsum(each[::-1])[::-1] - each
    return float((scenario.deadline[order] + later).min())


def usual(values: FloatArray) -> float:
    """The largest of some positive numbers, less those that are more than `ODD` times as large as half of them.

    Args:
        values: (K,) at least one number > 0.
    """
    return float(values[values <= ODD * _median(values)].max())


def work_scale(scenario: Scenario, capacity: float) -> float:
    """W: the largest workload that a robot of some capacity could finish by the deadline, were it there at once.

    At most `HEAVY` times the median of these that are > 0; what is heavier is far too heavy, however heavy it is.
    """
    work = scenario.workload[scenario.workload > 0]
    possible = scenario.workload[(scenario.workload > 0) & (scenario.workload <= capacity * scenario.deadline)]
    counted = possible if len(possible) else work
    return min(float(counted.max()), HEAVY * _median(counted)) if len(counted) else 1.0


def _box(tasks: FloatArray, robots: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The lowest and the highest x and y of (…, 2) places."""
    return np.minimum(tasks.min(axis=0), robots.min(axis=0)), np.maximum(tasks.max(axis=0), robots.max(axis=0))


def _median(values: FloatArray) -> float:
    """The lower one, where there are two, so that one large value does not count."""
    return float(np.sort(values)[(len(values) - 1) // 2])
