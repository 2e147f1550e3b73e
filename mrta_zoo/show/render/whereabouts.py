"""Whereabouts: where a robot is at this moment, even between tasks, and what it is doing."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mrta_zoo.mission import Mission
from mrta_zoo.rules import travel_time, visit


@dataclass(frozen=True, slots=True)
class Whereabouts:
    """Where a robot is and what it is doing."""

    x: float
    y: float
    doing: str
    """``"acting"``, ``"waiting"`` (free, but others act first), ``"travelling"``, ``"working"`` or ``"retired"``."""


def whereabouts(mission: Mission, robot: int) -> Whereabouts:
    """Where `robot` is at ``mission.time``. It leaves as soon as it has decided, in a straight line."""
    scenario, route = mission.scenario, mission.routes[robot]
    x, y = (float(value) for value in mission.position[robot])
    task = mission.heading[robot]
    if task < 0:
        free = "acting" if robot == mission.actor else "waiting"
        return Whereabouts(x, y, "retired" if mission.retired[robot] else free)
    first = len(route) == 1
    (from_x, from_y) = (scenario.robot_xy[robot] if first else scenario.task_xy[route[-2]]).tolist()
    ready = 0.0 if first else float(mission.finish[route[-2]])
    travel = travel_time(x - from_x, y - from_y, float(scenario.speed[robot]), math.sqrt)
    departs, arrives, *_ = visit(ready, travel, scenario.workload[task] / scenario.capacity[robot])
    if mission.time >= arrives:
        return Whereabouts(x, y, "working")
    share = (mission.time - departs) / (arrives - departs)
    return Whereabouts(from_x + share * (x - from_x), from_y + share * (y - from_y), "travelling")
