"""Where a robot is at this moment, between the places where it decides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mrta_zoo.mission import Mission


@dataclass(frozen=True, slots=True)
class Whereabouts:
    """Where a robot is and what it does."""

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
    if len(route) > 1:
        origin, left = scenario.task_xy[route[-2]], float(mission.finish[route[-2]])
    else:
        origin, left = scenario.robot_xy[robot], 0.0
    way = np.array((x, y)) - origin
    needs = float(np.hypot(*way)) / float(scenario.speed[robot])
    share = 1.0 if needs == 0 else min((mission.time - left) / needs, 1.0)
    here = origin + share * way
    return Whereabouts(float(here[0]), float(here[1]), "working" if share == 1.0 else "travelling")
