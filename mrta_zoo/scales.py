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

from mrta_zoo.reach import BoolArray, in_time
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import FloatArray, Scenario

MOST_MARGIN = 0.25
"""The frame is the map where no margin around the places is wider than this share of their extent."""
ODD = 10.0
"""A capacity or speed is odd if it is more than this many times as large as the next smaller one, and `ENOUGH`."""
ENOUGH = 50.0
"""Crossings of the frame in the time T, and of the largest workload in the time of a crossing: what is faster or
stronger makes hardly a difference."""
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
    def of(cls, scenario: Scenario, mask_rule: MaskRule = "feasible") -> Scales:
        """The scales of a scenario; floats and (2,) float64 arrays.

        Args:
            scenario: the mission.
            mask_rule: by it, what robots may choose, which is what counts.
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

    It is the map where the places fill it more or less, otherwise the box around them: how large a map was declared,
    and where 0 and 0 lie, is a matter of taste. Tasks that no robot can do, and robots that can do none, do not count.

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
    """T: the latest deadline or, if earlier, the time by which all that can wait could be done: none binds later.

    Say that some tasks have a deadline by d, and k others later ones. By d, the former are done or missed, and every
    robot is free; from then on the better half of the robots, m of them, could do the others: ⌈k/m⌉ each, the heaviest
    shared out first, in turn, which gives nobody more than the m-th part of all work and (1 − 1/m) of the heaviest. On
    a square of side L there is a way through n places that is no longer than (√(2n) + 1.75) L (L. Few, "The shortest
    path and the shortest road through n points", Mathematika 2, 1955), nor of course than n times across. So none of
    the k needs a deadline later than d and the time which that takes. The earliest such time over all d is returned.

    Args:
        scenario: the mission.
        extent: (2,) width and height of its frame.
        useful: (M,) the robots that can do anything; at least one.
        work: (N,) workloads, of which those that are far too heavy may be taken for less.
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
    # Of the tasks that come later in this order: what they take together, and the most that one takes.
    total = np.cumsum(work[::-1])[::-1] - work
    heaviest = np.append(np.maximum.accumulate(work[:0:-1])[::-1], 0.0)
    needed = way / speed + (total / robots + (1 - 1 / robots) * heaviest) / capacity
    needed[-1] = 0.0  # exactly
    return float((scenario.deadline[order] + needed).min())


def usual(values: FloatArray, enough: float) -> float:
    """The largest of some positive numbers, less those that are odd: beyond `enough`, and `ODD` times the next smaller.

    Args:
        values: (K,) at least one number > 0.
        enough: > 0; what is more makes hardly a difference.
    """
    ordered = np.sort(values)
    odd = (ordered[1:] > ODD * ordered[:-1]) & (ordered[1:] > enough)
    return float(ordered[odd.argmax()] if odd.any() else ordered[-1])


def work_scale(scenario: Scenario, capacity: float) -> float:
    """W: the largest workload that a robot of some capacity could finish by the deadline, were it there at once.

    At most `HEAVY` times the median of these that are > 0; what is heavier is far too heavy, however heavy it is.
    """
    work = scenario.workload[scenario.workload > 0]
    possible = scenario.workload[(scenario.workload > 0) & (scenario.workload <= capacity * scenario.deadline)]
    counted = possible if len(possible) else work
    if not len(counted):
        return 1.0
    middle = np.sort(counted)[(len(counted) - 1) // 2]  # the lower one of two, so that one large value does not count
    return float(min(counted.max(), HEAVY * middle))
