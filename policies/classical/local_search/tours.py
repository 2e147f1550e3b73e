"""The robots' tours during a search, with the times by which insertions are judged quickly."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from mrta_zoo import rules
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.local_search.compiled import compiled
from mrta_zoo.policies.classical.local_search.problem import Problem
from mrta_zoo.scenario import FloatArray, Scenario
from mrta_zoo.verify import verify

visit = compiled(rules.visit)


class Tours(NamedTuple):
    """M tours of N tasks; every visited task is finished by its deadline.

    Attributes:
        tasks: (M, N) the tasks of each tour in order. Entries beyond its size have no meaning, here and below.
        finish: (M, N) when each visit is finished.
        leg: (M, N) travel time to each visit.
        max_shift: (M, N) by how much each visit may be delayed before it, or one after it, is late.
        size: (M,) number of visits.
        robot: (N,) the robot whose tour each task is in, or -1.
    """

    tasks: npt.NDArray[np.int64]
    finish: FloatArray
    leg: FloatArray
    max_shift: FloatArray
    size: npt.NDArray[np.int64]
    robot: npt.NDArray[np.int64]


def empty_tours(problem: Problem) -> Tours:
    """Tours without visits."""
    m, n = problem.work.shape
    return Tours(
        tasks=np.zeros((m, n), dtype=np.int64),
        finish=np.zeros((m, n)),
        leg=np.zeros((m, n)),
        max_shift=np.zeros((m, n)),
        size=np.zeros(m, dtype=np.int64),
        robot=np.full(n, -1, dtype=np.int64),
    )


def tours_of(problem: Problem, scenario: Scenario, plan: Plan) -> Tours:
    """The tours of a plan without the visits that would be late.

    Raises:
        PlanError: if the plan does not fit the scenario.
    """
    verify(scenario, plan)
    tours = empty_tours(problem)
    for robot, route in enumerate(plan.routes):
        for task in route:
            insert(problem, tours, task, robot, int(tours.size[robot]))
    return tours


def plan_of(tours: Tours, scenario: Scenario, method: str) -> Plan:
    """The tours as a plan."""
    routes = [tasks[:size].tolist() for tasks, size in zip(tours.tasks, tours.size, strict=True)]
    return Plan.of(routes, scenario.name, method)


@compiled
def copy_tour(source: Tours, target: Tours, robot: int) -> None:
    """Copy one robot's tour. `target.robot` is left to the caller."""
    size = source.size[robot]
    target.size[robot] = size
    for position in range(size):
        target.tasks[robot, position] = source.tasks[robot, position]
        target.finish[robot, position] = source.finish[robot, position]
        target.leg[robot, position] = source.leg[robot, position]
        target.max_shift[robot, position] = source.max_shift[robot, position]


@compiled
def copy_tours(source: Tours, target: Tours) -> None:
    """Copy all tours."""
    for robot in range(len(source.size)):
        copy_tour(source, target, robot)
    target.robot[:] = source.robot


@compiled
def insert(problem: Problem, tours: Tours, task: int, robot: int, position: int) -> bool:
    """Insert `task` unless a visit would be late by the exact rules; returns whether it was inserted."""
    size = tours.size[robot]
    for index in range(size, position, -1):
        tours.tasks[robot, index] = tours.tasks[robot, index - 1]
    tours.tasks[robot, position] = task
    tours.size[robot] = size + 1
    tours.robot[task] = robot
    if _retime(problem, tours, robot, position) < 0:
        return True
    remove(problem, tours, robot, position, 1)
    return False


@compiled
def remove(problem: Problem, tours: Tours, robot: int, position: int, count: int) -> None:
    """Remove `count` consecutive visits from `position` on, and any that is late by rounding without the detour."""
    while count > 0:
        size = tours.size[robot]
        for index in range(position, position + count):
            tours.robot[tours.tasks[robot, index]] = -1
        for index in range(position, size - count):
            tours.tasks[robot, index] = tours.tasks[robot, index + count]
        tours.size[robot] = size - count
        late = _retime(problem, tours, robot, position)
        position, count = late, int(late >= 0)


@compiled
def _retime(problem: Problem, tours: Tours, robot: int, start: int) -> int:
    """Recompute the times of a tour from position `start` on; returns the first late visit, or -1."""
    size = tours.size[robot]
    speed = problem.speed[robot]
    place, ready = len(problem.deadline) + robot, 0.0
    if start > 0:
        place, ready = tours.tasks[robot, start - 1], tours.finish[robot, start - 1]
    for position in range(start, size):
        task = tours.tasks[robot, position]
        leg = problem.distance[place, task] / speed
        ready = visit(ready, leg, problem.work[robot, task]).finishes
        if ready > problem.deadline[task]:
            return position
        tours.leg[robot, position] = leg
        tours.finish[robot, position] = ready
        place = task
    slack = np.inf
    for position in range(size - 1, -1, -1):
        slack = min(slack, problem.deadline[tours.tasks[robot, position]] - tours.finish[robot, position])
        tours.max_shift[robot, position] = slack
    return -1


@compiled
def total_time(tours: Tours) -> float:
    """The time at which each robot finishes its tour, summed over the robots."""
    total = 0.0
    for robot in range(len(tours.size)):
        if tours.size[robot] > 0:
            total += tours.finish[robot, tours.size[robot] - 1]
    return total
