"""BiG-MRTA: at each decision a maximum-weight matching of robots and tasks; the deciding robot takes its own match.

Ghassemi and Chowdhury, "Multi-robot task allocation in disaster response: addressing dynamic tasks with deadlines
and robots with range and payload constraints", Robotics and Autonomous Systems 147 (2022).
"""

from __future__ import annotations

import numpy as np

from mrta_zoo.mission import Mission
from mrta_zoo.plan import Plan
from mrta_zoo.scales import Scales
from mrta_zoo.scenario import FloatArray, Scenario

RANGE = 1e4
"""Range of robots, in sides of the map: 1e6 on a map of side 100, the authors' value for TAPTC."""
TIME_SCALE = 1.1
"""T of the weights, in latest deadlines."""
MOST_TIMES = 100.0
"""Largest f / T, so that no weight vanishes."""
MATCHED = 10.0
"""Added to the weights of a robot that must be matched. It outweighs what that costs the others: at most one match, of
weight 1."""


class BigMrtaSolver:
    """Event-driven, like the environment. Every planned task is finished by its deadline.

    An edge joins a robot and an untaken task if the robot, from where and when it is next free, can finish the task at
    a time f by its deadline. Its weight is (range - distance) · exp(-f / T). With the authors' range for TAPTC, 1e6 on
    a map of side 100, the first factor varies by 1.4e-4, so that in effect the task finished soonest weighs most. We
    keep it, with both constants in proportion to the scenario, so that units do not matter: the range is `RANGE` times
    the longer side of its frame (`mrta_zoo.scales`), and T is `TIME_SCALE` times the latest deadline that can bind
    (the authors take the latest, cut to a whole number of time units). Weights are divided by the range, which changes
    no matching. If all deadlines can bind, f <= T / 1.1, and weights lie between 0.4 and 1.

    The published code differs in two ways. It turns missing edges into edges of weight 0, may match a robot to a task
    that it can only finish late, and counts the task as done; here such matches are dropped. And here a robot that has
    tasks to choose from but no match takes its match in the heaviest matching that includes it: robots cannot wait
    (`rules`), so that one that does nothing now would never do anything.
    """

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        mission = Mission(scenario)
        scales = Scales.of(scenario)
        length = RANGE * scales.length
        time = TIME_SCALE * float(scenario.deadline[scenario.deadline <= scales.time].max())
        weights = np.empty((scenario.num_robots, scenario.num_tasks))
        for robot in range(scenario.num_robots):
            weights[robot] = _weights(mission, robot, length, time)
        while not mission.done:
            robot = mission.actor
            task = _match(weights, robot)
            mission.assign(task)
            weights[:, task] = 0.0
            weights[robot] = _weights(mission, robot, length, time)
        return Plan.of(mission.routes, scenario.name, "big-mrta")


def _weights(mission: Mission, robot: int, length: float, time: float) -> FloatArray:
    """(N,) weight of each task for a robot, > 0 and at most 1; 0 if it is taken or cannot be finished in time."""
    scenario = mission.scenario
    distance = np.hypot(*(scenario.task_xy - mission.position[robot]).T)
    near = 1.0 - distance / length
    soon = np.exp(-np.minimum(mission.finish_if[robot] / time, MOST_TIMES))
    weights: FloatArray = np.where(mission.mask(robot), near * soon, 0.0)
    return weights


def _match(weights: FloatArray, robot: int) -> int:
    """The task of `robot` in the heaviest matching or, if it has none there, in the heaviest that includes it."""
    from scipy.optimize import linear_sum_assignment

    tasks = np.flatnonzero(weights.any(axis=0))
    robots = np.flatnonzero(weights.any(axis=1))
    edges = weights[np.ix_(robots, tasks)]
    own = int(np.searchsorted(robots, robot))
    for must_match in (False, True):
        if must_match:
            edges[own] += np.where(edges[own] > 0, MATCHED, 0.0)
        rows, columns = linear_sum_assignment(edges, maximize=True)
        matched = columns[rows == own]
        if len(matched) and edges[own, matched[0]] > 0:
            break
    return int(tasks[matched[0]])
