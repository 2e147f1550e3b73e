"""What a robot sees: the mission as bounded, scale-free float32 arrays.

Everything is divided by a scale of the scenario (`mrta_zoo.scales`: L, T, W, C, V), so that every number lies in
[0, 1]: places are measured from the lowest corner of the mission's frame in units of L, times in T, workloads in W,
capacities in C and speeds in V. Whatever is larger than its scale shows as 1.

The ``mission`` array relates these scales: L/V/T, the time the fastest robot takes to cross the map, and W/C/T, the
time the strongest takes for the largest workload. These ratios r >= 0 are shown as r/(1 + r).

====================  ===============  ======================================================================
``tasks``             (max_tasks, 8)   x, y, deadline, workload, and a one-hot status: active, assigned,
                                       completed, missed. Padding rows are all 0.
``robots``            (max_robots, 7)  x, y (where it is free next), capacity, speed, when it is free next,
                                       1 while not retired, 1 if it is the observer. Padding rows are all 0.
``ego``               (5,)             the observer's own x, y, capacity, speed, when it is free next
``mission``           (3,)             elapsed time, L/V/T and W/C/T squashed
====================  ===============  ======================================================================

The flat form concatenates these tables, row by row, in this order; `split` separates them again. The global state is
the same without the last column of ``robots`` and without ``ego``.

The five context features of the paper (§III-B) are all there: elapsed time (``mission``), the robot's capacity and
place (``ego``), the peers' destinations and capacities (``robots``).

To add a feature, widen a table here and fill its column in `Observer`; policies read columns by the names below.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from mrta_zoo.errors import ConfigError
from mrta_zoo.mission import Mission
from mrta_zoo.rules import MaskRule
from mrta_zoo.scales import Scales
from mrta_zoo.scenario import Scenario
from mrta_zoo.wording import counted

if TYPE_CHECKING:  # imported only where spaces are made: networks are also trained on machines without Gymnasium
    from gymnasium import spaces

TASK_FEATURES = ("x", "y", "deadline", "workload", "active", "assigned", "completed", "missed")
ROBOT_FEATURES = ("x", "y", "capacity", "speed", "ready", "working", "is_ego")
EGO_FEATURES = ROBOT_FEATURES[:5]
MISSION_FEATURES = ("elapsed", "crossing_ratio", "work_ratio")

Observation = dict[str, Any]
"""``{"observation": {"tasks", "robots", "ego", "mission"}, "action_mask"}``, see the module's docstring."""

FloatTable = npt.NDArray[np.float32]


def observation_space(max_tasks: int, max_robots: int, num_actions: int | None = None) -> spaces.Dict:
    """The space of `Observer.observe`, for any scenario that fits. `num_actions` defaults to `max_tasks`."""

    from gymnasium import spaces

    def box(*shape: int) -> spaces.Box:
        return spaces.Box(0.0, 1.0, shape, np.float32)

    tables: list[tuple[str, spaces.Space[Any]]] = [  # a list, as a dictionary would be sorted by name
        ("tasks", box(max_tasks, len(TASK_FEATURES))),
        ("robots", box(max_robots, len(ROBOT_FEATURES))),
        ("ego", box(len(EGO_FEATURES))),
        ("mission", box(len(MISSION_FEATURES))),
    ]
    mask = spaces.Box(0, 1, (max_tasks if num_actions is None else num_actions,), np.int8)
    return spaces.Dict([("observation", spaces.Dict(tables)), ("action_mask", mask)])


def flat_space(max_tasks: int, max_robots: int) -> spaces.Box:
    """The space of the flat form, which has no mask."""
    from gymnasium import spaces

    return spaces.Box(0.0, 1.0, (_layout(max_tasks, max_robots)[-1],), np.float32)


def state_space(max_tasks: int, max_robots: int) -> spaces.Box:
    """The space of `Observer.state`."""
    from gymnasium import spaces

    size = _layout(max_tasks, max_robots)[-1] - max_robots - len(EGO_FEATURES)
    return spaces.Box(0.0, 1.0, (size,), np.float32)


def split(flat: Any, max_tasks: int, max_robots: int) -> dict[str, Any]:
    """The tables within a flat observation, as views.

    Args:
        flat: (..., F) float32, one or more observations in the flat form, as NumPy array or torch tensor.
        max_tasks: the environment's number of task rows.
        max_robots: the environment's number of robot rows.

    Returns:
        ``tasks`` (..., max_tasks, 8), ``robots`` (..., max_robots, 7), ``ego`` (..., 5), ``mission`` (..., 3).
    """
    tasks, robots, ego, end = _layout(max_tasks, max_robots)
    if flat.shape[-1] != end:
        raise ConfigError(
            f"a flat observation of {counted(max_tasks, 'task')} and {counted(max_robots, 'robot')} has {end} numbers; "
            f"this one has {flat.shape[-1]}"
        )
    rows = flat.shape[:-1]
    return {
        "tasks": flat[..., :tasks].reshape(*rows, max_tasks, len(TASK_FEATURES)),
        "robots": flat[..., tasks:robots].reshape(*rows, max_robots, len(ROBOT_FEATURES)),
        "ego": flat[..., robots:ego],
        "mission": flat[..., ego:],
    }


class Observer:
    """Turns a mission into observations. Keeps the tables of its scenario, so that a look is cheap.

    Args:
        scenario: of the missions to observe.
        max_tasks: number of task rows.
        max_robots: number of robot rows.
        mask_rule: that of the missions.
    """

    def __init__(self, scenario: Scenario, max_tasks: int, max_robots: int, mask_rule: MaskRule = "feasible") -> None:
        self.scales = scales = Scales.of(scenario, mask_rule)
        self._n, self._m = n, m = scenario.num_tasks, scenario.num_robots
        self._max_tasks, self._max_robots = max_tasks, max_robots
        self._layout = _layout(max_tasks, max_robots)
        self._one_hot = np.eye(4, dtype=np.float32)
        # One buffer holds everything but the observer's own row, so that an observation is a single copy.
        self._seen = np.zeros(self._layout[-1], dtype=np.float32)
        self._looked_at: Mission | None = None
        self._bind()
        self._tasks[:n, 0:2] = np.clip((scenario.task_xy - scales.origin) / scales.length, 0.0, 1.0)
        self._starts = np.clip((scenario.robot_xy - scales.origin) / scales.length, 0.0, 1.0)
        self._tasks[:n, 2] = np.minimum(scenario.deadline / scales.time, 1.0)
        self._tasks[:n, 3] = np.minimum(scenario.workload / scales.work, 1.0)
        self._robots[:m, 2] = np.minimum(scenario.capacity / scales.capacity, 1.0)
        self._robots[:m, 3] = np.minimum(scenario.speed / scales.speed, 1.0)
        self._mission[1:] = scales.crossing_ratio, scales.work_ratio

    def observe(self, mission: Mission, robot: int) -> Observation:
        """What `robot` sees now, as fresh arrays. The mask is what it may choose when next free."""
        self.look(mission.known(robot))
        return {"observation": self.tables(robot), "action_mask": self.mask(mission, robot)}

    def look(self, mission: Mission) -> None:
        """Take in the mission as it stands. `flat`, `tables` and `state` show what was last looked at.

        Only what has changed since the last look is written, which keeps a look cheap in a large mission.
        """
        if mission is not self._looked_at:
            self._looked_at = mission
            self._last_status = np.full(self._n, -1, dtype=np.int8)
            self._last_retired: list[bool] = []
            self._last_taken = [-1] * self._m
        for task in (mission.status != self._last_status).nonzero()[0].tolist():
            self._tasks[task, 4:8] = self._one_hot[mission.status[task]]
        self._last_status = mission.status.copy()
        scales = self.scales
        for robot, route in enumerate(mission.routes):
            if len(route) != self._last_taken[robot]:
                self._last_taken[robot] = len(route)
                self._robots[robot, 0:2] = self._tasks[route[-1], 0:2] if route else self._starts[robot]
                self._robots[robot, 4] = min(mission.ready[robot] / scales.time, 1.0)
        if mission.retired != self._last_retired:
            self._last_retired = list(mission.retired)
            self._robots[: self._m, 5] = ~np.array(mission.retired)
        self._mission[0] = min(mission.time / scales.time, 1.0)

    def flat(self, robot: int) -> FloatTable:
        """(F,) what `robot` sees, in the flat form; a robot the scenario does not have sees an empty `ego`."""
        tasks, robots, ego, _ = self._layout
        flat = self._seen.copy()
        if robot < self._m:
            row = tasks + robot * len(ROBOT_FEATURES)
            flat[robots:ego] = flat[row : row + len(EGO_FEATURES)]
            flat[row + len(ROBOT_FEATURES) - 1] = 1.0
        return flat

    def tables(self, robot: int) -> dict[str, FloatTable]:
        """The same as tables."""
        flat = self.flat(robot)
        tasks, robots, ego, _ = self._layout
        return {
            "tasks": flat[:tasks].reshape(self._max_tasks, len(TASK_FEATURES)),
            "robots": flat[tasks:robots].reshape(self._max_robots, len(ROBOT_FEATURES)),
            "ego": flat[robots:ego],
            "mission": flat[ego:],
        }

    def state(self) -> FloatTable:
        """(S,) the global state: tasks, robots without the column `is_ego`, mission."""
        return np.concatenate((self._tasks.ravel(), self._robots[:, :-1].ravel(), self._mission))

    def mask(self, mission: Mission, robot: int) -> npt.NDArray[np.int8]:
        """(max_tasks,) int8, 1 where `robot` may choose."""
        mask = np.zeros(self._max_tasks, dtype=np.int8)
        mask[: self._n] = mission.mask(robot)
        return mask

    def _bind(self) -> None:
        """Name the parts of the buffer."""
        tables = split(self._seen, self._max_tasks, self._max_robots)
        self._tasks, self._robots, self._mission = tables["tasks"], tables["robots"], tables["mission"]

    def __getstate__(self) -> dict[str, Any]:
        """Without the views, which would be restored as separate arrays."""
        views = ("_tasks", "_robots", "_mission")
        return {name: value for name, value in vars(self).items() if name not in views}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._bind()


def _layout(max_tasks: int, max_robots: int) -> tuple[int, int, int, int]:
    """Where tasks, robots, ego and mission end in the flat form."""
    tasks = max_tasks * len(TASK_FEATURES)
    robots = tasks + max_robots * len(ROBOT_FEATURES)
    ego = robots + len(EGO_FEATURES)
    return tasks, robots, ego, ego + len(MISSION_FEATURES)
