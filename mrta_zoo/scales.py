"""Scales: what places, times, workloads, capacities and speeds are divided by before a network sees them.

So neither the units, nor where the mission lies, nor a single outlier matters.

=========  ================================================================================================
places     measured from the frame's lowest corner, divided by L, the longer side of the frame, see `frame_of`
times      divided by T, the latest deadline that can bind, see `slack_time`
workloads  divided by W, the largest, see `work_scale`
capacity   divided by C, the largest capacity; speed by V, the largest speed, see `usual`
=========  ================================================================================================

Whatever is larger than its scale counts as 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from mrta_zoo.reach import BoolArray, in_time
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import FloatArray, Scenario

MOST_MARGIN = 0.25
"""The frame is the map where no margin around the places is wider than this share of their extent."""
OUTLIER = 10.0
"""A capacity or speed is an outlier if it is more than this many times the next smaller one, and beyond `ENOUGH`."""
ENOUGH = 50.0
"""Crossings of the frame in the time T, and largest workloads done in the time of a crossing: being faster or stronger
than that hardly makes a difference."""
HEAVY = 4.0
"""W is at most this many times the median workload."""


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
    def of(cls, scenario: Scenario, mask_rule: MaskRule = "feasible") -> Scales:
        """The scales of a scenario; floats and (2,) float64 arrays.

        Args:
            scenario: the mission.
            mask_rule: under ``"feasible"``, only tasks and robots that can be of use count.
        """
        possible = in_time(scenario) if mask_rule == "feasible" else np.ones((scenario.num_robots, 1), dtype=np.bool_)
        origin, extent = frame_of(scenario, possible)
        useful = useful_robots(possible)
        capacities, speeds, length = scenario.capacity[useful], scenario.speed[useful], float(extent.max())
        work = work_scale(scenario, float(capacities.max()))
        time = slack_time(scenario, extent, useful, np.minimum(scenario.workload, work))
        speed = usual(speeds, ENOUGH * length / time)
        return cls(
            origin=origin,
            extent=extent,
            length=length,
            time=time,
            work=work,
            capacity=usual(capacities, ENOUGH * work * speed / length),
            speed=speed,
        )

    def each(self, change: Callable[[Any], Any]) -> Scales:
        """These scales with `change` applied to every field."""
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
    """The frame, the part of the plane that the mission takes place in: lowest x and y, width and height, both (2,).

    It is the map if the places more or less fill it, otherwise their bounding box: how large a map is declared, and
    where its origin lies, is arbitrary. Tasks that no robot can do, and robots that can do none, do not count.

    Args:
        scenario: the mission.
        possible: (M, N) or (M, 1) what robots could do; by default, `in_time`.
    """
    possible = in_time(scenario) if possible is None else possible
    tasks, robots = scenario.task_xy, scenario.robot_xy
    if possible.any() and not possible.all():
        tasks, robots = tasks[possible.any(axis=0)], robots[possible.any(axis=1)]
    least = np.minimum(tasks.min(axis=0), robots.min(axis=0))
    most = np.maximum(tasks.max(axis=0), robots.max(axis=0))
    origin, end = np.array(scenario.map_origin), np.array(scenario.map_end)
    size = float((most - least).max())
    margin = float(max((least - origin).max(), (end - most).max()))
    if 0 < size * MOST_MARGIN < margin:
        return least, most - least
    return origin, np.array(scenario.map_size)


def useful_robots(possible: BoolArray) -> BoolArray:
    """(M,) those that can do anything, by (M, …) what each can do; all of them, if none can."""
    useful = possible.any(axis=1)
    return np.asarray(useful | ~useful.any())


def slack_time(scenario: Scenario, extent: FloatArray, useful: BoolArray, work: FloatArray) -> float:
    """T: the latest deadline or, if earlier, the time after which no deadline can bind.

    Suppose that k tasks have a deadline later than d. By d all others are done or missed, and every robot is free.
    From then on the better half of the robots, m of them, could do the k tasks: ⌈k/m⌉ each, dealt out in turn, the
    heaviest first, so that nobody gets more than 1/m of all work plus (1 − 1/m) of the heaviest. In a square of side L
    there is a path through n points no longer than (√(2n) + 1.75) L (L. Few, "The shortest path and the shortest road
    through n points", Mathematika 2, 1955), nor of course than n times across. So none of the k tasks needs a deadline
    later than d plus the time which that takes. The earliest such time over all d is returned.

    Args:
        scenario: the mission.
        extent: (2,) width and height of its frame.
        useful: (M,) the robots that can do anything; at least one.
        work: (N,) workloads; those that are far too heavy may be capped.
    """
    across, side = float(np.hypot(*extent)), float(extent.max())
    speed, capacity = scenario.speed[useful], scenario.capacity[useful]
    alone = across * scenario.num_tasks / speed + work.sum() / capacity
    better = np.argsort(alone, kind="stable")[: len(alone) // 2 + 1]
    speed, capacity, robots = speed[better].min(), capacity[better].min(), len(better)
    order = np.argsort(scenario.deadline, kind="stable")
    later = scenario.num_tasks - 1 - np.arange(scenario.num_tasks)
    each = -(-later // robots)
    way = np.minimum(each * across, (np.sqrt(2.0 * each) + 1.75) * side + across) * (each > 0)
    work = work[order]
    # For the tasks that come later in this order: what they take together, and the most that one takes.
    total = np.cumsum(work[::-1])[::-1] - work
    heaviest = np.append(np.maximum.accumulate(work[:0:-1])[::-1], 0.0)
    needed = way / speed + (total / robots + (1 - 1 / robots) * heaviest) / capacity
    needed[-1] = 0.0  # exactly
    return float((scenario.deadline[order] + needed).min())


def usual(values: FloatArray, enough: float) -> float:
    """The largest of some positive numbers, short of the first outlier.

    A number is an outlier if it is more than `OUTLIER` times the next smaller one, and more than `enough`.

    Args:
        values: (K,) at least one number > 0.
        enough: > 0; more than that hardly makes a difference.
    """
    ordered = np.sort(values)
    outliers = (ordered[1:] > OUTLIER * ordered[:-1]) & (ordered[1:] > enough)
    return float(ordered[outliers.argmax()] if outliers.any() else ordered[-1])


def work_scale(scenario: Scenario, capacity: float) -> float:
    """W: the largest workload that a robot of this capacity could finish by the deadline if it started at the task.

    It is at most `HEAVY` times the median of those > 0; anything heavier is far too heavy, no matter by how much.
    """
    work = scenario.workload[scenario.workload > 0]
    possible = scenario.workload[(scenario.workload > 0) & (scenario.workload <= capacity * scenario.deadline)]
    counted = possible if len(possible) else work
    if not len(counted):
        return 1.0
    middle = np.sort(counted)[(len(counted) - 1) // 2]  # the lower of two, so that a single large value does not count
    return float(min(counted.max(), HEAVY * middle))
