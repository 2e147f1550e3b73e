"""Routes without late visits."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from mrta_zoo.rules import travel_time, visit
from mrta_zoo.scenario import Scenario

Routes = tuple[tuple[int, ...], ...]
"""The tasks of each robot, in order."""


def drop_late(scenario: Scenario, routes: Sequence[Iterable[int]]) -> Routes:
    """The routes without the visits that would be late, and without tasks that an earlier robot has.

    A robot does not travel to what is dropped, so that it is earlier at what follows.

    Args:
        scenario: the scenario.
        routes: the tasks of each robot, in order.
    """
    taken: set[int] = set()
    kept: list[list[int]] = []
    for robot, route in enumerate(routes):
        speed, capacity = float(scenario.speed[robot]), float(scenario.capacity[robot])
        (x, y), ready = scenario.robot_xy[robot].tolist(), 0.0
        kept.append([])
        for task in route:
            to_x, to_y = scenario.task_xy[task].tolist()
            travel = travel_time(to_x - x, to_y - y, speed, math.sqrt)
            finish = visit(ready, travel, float(scenario.workload[task]) / capacity).finishes
            if task not in taken and finish <= scenario.deadline[task]:
                taken.add(task)
                kept[-1].append(int(task))
                x, y, ready = to_x, to_y, finish
    return tuple(tuple(route) for route in kept)
