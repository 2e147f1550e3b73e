"""The independent verifier: the scores of a plan, computed from the problem statement alone.

It shares no code with the rules, the dynamics or the environment, on purpose: plain Python floats, one robot
after the other. Every published number goes through it. The arithmetic is in float64 and in the order that `rules`
documents, so that a task finished exactly at its deadline counts the same everywhere.
"""

from __future__ import annotations

import math
import operator
from dataclasses import dataclass

from mrta_zoo.errors import PlanError
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario
from mrta_zoo.wording import counted

COST = "Eq. 1: the sum of finish / deadline over the tasks missed"
"""The definition of the cost in short, for display; `Score` gives it in full."""


@dataclass(frozen=True, slots=True)
class Visit:
    """One task on a robot's route.

    Attributes:
        task: the task, counted from 0.
        arrival: when the robot gets there, in time units, >= 0.
        finish: when its work there is done, in time units, >= arrival.
        deadline: the task's deadline, in time units.
        completed: whether it was finished by its deadline.
    """

    task: int
    arrival: float
    finish: float
    deadline: float
    completed: bool


@dataclass(frozen=True, slots=True)
class Score:
    """Every score of a valid plan.

    Attributes:
        tasks: N, the number of tasks of the scenario.
        completed: how many of them were finished by their deadline, 0 to N.
        completion: the share completed / tasks, 0 to 1 (the completion rate of the paper's tables).
        cost: the objective, Eq. 1 of the paper, >= 0: the sum of finish / deadline over what was missed.
            A task nobody took counts as finished at the end of the mission or at its deadline, whichever is
            later.
        distance: travelled by all robots together, in distance units.
        makespan: the latest finish, in time units; 0 if nothing is done.
        schedule: for each robot its visits, in order.
        task_names: names of the tasks, as in `Scenario`; empty if they are known by their numbers only.
        robot_names: likewise for the robots.
    """

    tasks: int
    completed: int
    completion: float
    cost: float
    distance: float
    makespan: float
    schedule: tuple[tuple[Visit, ...], ...]
    task_names: tuple[str, ...] = ()
    robot_names: tuple[str, ...] = ()


def verify(scenario: Scenario, plan: Plan) -> Score:
    """Check that `plan` fits `scenario`, and compute its scores.

    A late task is no error: it is part of the plan and of its cost.

    Raises:
        PlanError: if the number of routes is not the number of robots, or a task is unknown, not an integer, or
            taken twice.
    """
    routes = _routes(scenario, plan)
    schedule = tuple(_visits(scenario, robot, route) for robot, route in enumerate(routes))
    visits = [visit for route in schedule for visit in route]
    makespan = max((visit.finish for visit in visits), default=0.0)
    finished = {visit.task: visit for visit in visits}
    terms = []
    for task, deadline in enumerate(scenario.deadline.tolist()):
        if task not in finished:
            terms.append(max(makespan, deadline) / deadline)
        elif not finished[task].completed:
            terms.append(finished[task].finish / deadline)
    completed = sum(visit.completed for visit in visits)
    return Score(
        tasks=scenario.num_tasks,
        completed=completed,
        completion=completed / scenario.num_tasks,
        cost=math.fsum(terms),
        distance=math.fsum(leg for robot, route in enumerate(routes) for leg in _legs(scenario, robot, route)),
        makespan=makespan,
        schedule=schedule,
        task_names=scenario.task_names,
        robot_names=scenario.robot_names,
    )


def _visits(scenario: Scenario, robot: int, route: list[int]) -> tuple[Visit, ...]:
    speed, capacity = float(scenario.speed[robot]), float(scenario.capacity[robot])
    visits = []
    ready = 0.0
    for task, leg in zip(route, _legs(scenario, robot, route), strict=True):
        deadline = float(scenario.deadline[task])
        arrival = ready + leg / speed
        ready = arrival + float(scenario.workload[task]) / capacity
        visits.append(Visit(task, arrival, ready, deadline, ready <= deadline))
    return tuple(visits)


def _legs(scenario: Scenario, robot: int, route: list[int]) -> list[float]:
    """The lengths of the straight lines from the robot's start through the tasks of its route."""
    legs = []
    x, y = scenario.robot_xy[robot].tolist()
    for task in route:
        to_x, to_y = scenario.task_xy[task].tolist()
        dx, dy = to_x - x, to_y - y
        # Not math.hypot, whose rounding differs: a tie with a deadline must be settled the same way everywhere.
        legs.append(math.sqrt(dx * dx + dy * dy))
        x, y = to_x, to_y
    return legs


def _routes(scenario: Scenario, plan: Plan) -> list[list[int]]:
    """The plan's routes as checked integers."""
    if len(plan.routes) != scenario.num_robots:
        raise PlanError(
            f"the plan has {counted(len(plan.routes), 'route')}, but scenario {scenario.name!r} has "
            f"{counted(scenario.num_robots, 'robot')}; every robot needs one, empty if it stays where it is"
        )
    routes: list[list[int]] = []
    taken: dict[int, str] = {}
    for robot, route in enumerate(plan.routes):
        routes.append([])
        for position, entry in enumerate(route):
            place = f"position {position} of robot {scenario.robot_label(robot)}'s route"
            task = _integer(entry, place)
            if not 0 <= task < scenario.num_tasks:
                raise PlanError(
                    f"{place} names task {task}; the tasks of scenario {scenario.name!r} are numbered "
                    f"0 to {scenario.num_tasks - 1}"
                )
            if task in taken:
                raise PlanError(f"task {scenario.task_label(task)} is taken twice, at {taken[task]} and at {place}")
            taken[task] = place
            routes[-1].append(task)
    return routes


def _integer(entry: object, place: str) -> int:
    if not isinstance(entry, bool):
        try:
            return operator.index(entry)  # type: ignore[arg-type]
        except TypeError:
            pass
    raise PlanError(f"{place} is {entry!r}; expected the number of a task, an integer")
