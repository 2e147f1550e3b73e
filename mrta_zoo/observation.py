"""What a robot sees: the mission as bounded, scale-free float32 arrays.

Everything is divided by a scale of the scenario, so that every number lies in [0, 1]:

=========  ==========================================================================================
places     divided by L, the longer side of the map
times      divided by T, the latest deadline; later times show as 1 (nothing can be completed after T)
workloads  divided by W, the largest workload
capacity   divided by C, the largest capacity; speed by V, the largest speed
=========  ==========================================================================================

The ``mission`` array carries what relates these scales: L/V/T, the time the fastest robot takes to cross the map,
and W/C/T, the time the strongest takes for the largest workload. These ratios r >= 0 are shown as r/(1 + r).

====================  ===============  ======================================================================
``tasks``             (max_tasks, 8)   x, y, deadline, workload, and a one-hot status: active, assigned,
                                       completed, missed. Padding rows are all 0.
``robots``            (max_robots, 7)  x, y (where it is free next), capacity, speed, when it is free next,
                                       1 while not retired, 1 if it is the observer. Padding rows are all 0.
``ego``               (5,)             the observer's own x, y, capacity, speed, when it is free next
``mission``           (3,)             elapsed time, L/V/T and W/C/T squashed
====================  ===============  ======================================================================

The five context features of the paper (§III-B) are all there: elapsed time (``mission``), the robot's capacity and
place (``ego``), the peers' destinations and capacities (``robots``).

To add a feature, widen a table here and fill its column in `Observer`; policies read columns by the names below.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from mrta_zoo.mission import Mission
from mrta_zoo.scenario import Scenario

TASK_FEATURES = ("x", "y", "deadline", "workload", "active", "assigned", "completed", "missed")
ROBOT_FEATURES = ("x", "y", "capacity", "speed", "ready", "working", "is_ego")
EGO_FEATURES = ROBOT_FEATURES[:5]
MISSION_FEATURES = ("elapsed", "crossing_ratio", "work_ratio")

Observation = dict[str, Any]
"""``{"observation": {"tasks", "robots", "ego", "mission"}, "action_mask"}``, see the module's docstring."""


@dataclass(frozen=True, slots=True)
class Scales:
    """By what a scenario's quantities are divided. Fields are floats, or (B,) tensors for a batch."""

    length: Any
    time: Any
    work: Any
    capacity: Any
    speed: Any

    @classmethod
    def of(cls, scenario: Scenario) -> Scales:
        """The scales of one scenario."""
        return cls(
            length=max(scenario.map_size),
            time=float(scenario.deadline.max()),
            work=float(scenario.workload.max()) or 1.0,
            capacity=float(scenario.capacity.max()),
            speed=float(scenario.speed.max()),
        )

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


def observation_space(max_tasks: int, max_robots: int) -> spaces.Dict:
    """The space of `Observer.observe`, for any scenario that fits."""

    def box(*shape: int) -> spaces.Box:
        return spaces.Box(0.0, 1.0, shape, np.float32)

    observation = OrderedDict(
        tasks=box(max_tasks, len(TASK_FEATURES)),
        robots=box(max_robots, len(ROBOT_FEATURES)),
        ego=box(len(EGO_FEATURES)),
        mission=box(len(MISSION_FEATURES)),
    )
    mask = spaces.Box(0, 1, (max_tasks,), np.int8)
    return spaces.Dict({"observation": spaces.Dict(observation), "action_mask": mask})


class Observer:
    """Turns a mission into observations. Keeps the tables of its scenario, so that a look is cheap."""

    def __init__(self, scenario: Scenario, max_tasks: int, max_robots: int) -> None:
        self.scales = scales = Scales.of(scenario)
        n, m = scenario.num_tasks, scenario.num_robots
        self._n, self._m = n, m
        self._one_hot = np.eye(4, dtype=np.float32)
        self._tasks = np.zeros((max_tasks, len(TASK_FEATURES)), dtype=np.float32)
        self._tasks[:n, 0:2] = scenario.task_xy / scales.length
        self._tasks[:n, 2] = scenario.deadline / scales.time
        self._tasks[:n, 3] = scenario.workload / scales.work
        self._robots = np.zeros((max_robots, len(ROBOT_FEATURES)), dtype=np.float32)
        self._robots[:m, 2] = scenario.capacity / scales.capacity
        self._robots[:m, 3] = scenario.speed / scales.speed
        self._mission = np.array([0.0, scales.crossing_ratio, scales.work_ratio], dtype=np.float32)
        self._max_tasks = max_tasks

    def observe(self, mission: Mission, robot: int) -> Observation:
        """What `robot` sees now. Fresh arrays at each call. The mask is what it may choose when next free."""
        n, m = self._n, self._m
        tasks = self._tasks.copy()
        tasks[:n, 4:8] = self._one_hot[mission.status]
        robots = self._robots.copy()
        robots[:m, 0:2] = mission.position / self.scales.length
        ready = np.minimum(np.array(mission.ready) / self.scales.time, 1.0)
        robots[:m, 4] = ready
        robots[:m, 5] = ~np.array(mission.retired)
        robots[robot, 6] = 1.0
        seen = self._mission.copy()
        seen[0] = min(mission.time / self.scales.time, 1.0)
        return {
            "observation": {"tasks": tasks, "robots": robots, "ego": robots[robot, :5].copy(), "mission": seen},
            "action_mask": self.mask(mission, robot),
        }

    def mask(self, mission: Mission, robot: int) -> npt.NDArray[np.int8]:
        """(max_tasks,) int8, 1 where `robot` may choose."""
        mask = np.zeros(self._max_tasks, dtype=np.int8)
        mask[: self._n] = mission.mask(robot)
        return mask
