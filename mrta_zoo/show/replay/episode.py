"""The data of a replay page: episodes, as written into it. The page knows no rules: all times come from here.

Visits and candidates are JSON arrays, in the order of their fields, as there are many.
"""

from __future__ import annotations

import msgspec
import numpy as np
import numpy.typing as npt

from mrta_zoo.debug.outlook import outlook
from mrta_zoo.debug.percent import percent
from mrta_zoo.mission import Mission
from mrta_zoo.rules import MaskReason, Status
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.lanes import deadline_lanes
from mrta_zoo.show.view import Digits, shown_box, shown_time
from mrta_zoo.trace import Choice, Trace

MOST_CANDIDATES, MOST_MASKED = 10, 4
"""How many tasks are listed at each decision: the best of those that may be chosen, and the nearest of the others."""


class VisitJson(msgspec.Struct, frozen=True, array_like=True):
    """A task on a robot's route.

    Attributes:
        task: the task.
        decision: the decision that takes it.
        leave: when the robot leaves for it.
        arrive: when the robot gets there.
        finish: when the task is finished.
        completed: whether that is by the deadline.
        lane: the chart's lane for the line to its deadline, see `lanes.deadline_lanes`.
    """

    task: int
    decision: int
    leave: float
    arrive: float
    finish: float
    completed: bool
    lane: int


class CandidateJson(msgspec.Struct, frozen=True, array_like=True):
    """A task at a decision, as the acting robot sees it; see `debug.outlook.Prospect`.

    Attributes:
        task: the task.
        distance: from the robot.
        finish: when it would be finished.
        reason: a `rules.MaskReason`.
        note: who took it or who else could do it, or why it may not be chosen.
        probability: the policy's; None if it has none.
        percent: the same as text.
    """

    task: int
    distance: float
    finish: float
    reason: int
    note: str
    probability: float | None
    percent: str


class DecisionJson(msgspec.Struct, frozen=True):
    """A decision: who chose what, when, and among which tasks.

    Attributes:
        time: when it is made.
        robot: who makes it.
        task: the task taken; None if the robot stays for good.
        advice: the task that the policy would have taken, where somebody else decided.
        reasons: number of tasks by `rules.MaskReason`.
        candidates: the tasks that may be chosen, by probability or else by finish, then the nearest of those that may
            not.
    """

    time: float
    robot: int
    task: int | None
    advice: int | None
    reasons: list[int]
    candidates: list[CandidateJson]


class EpisodeJson(msgspec.Struct, frozen=True):
    """One side of the page.

    Attributes:
        method: who decided.
        mask_rule: what robots could choose.
        completed: tasks finished by their deadlines.
        cost: Eq. 1 of the paper, by the verifier.
        makespan: the latest finish.
        routes: each robot's visits, in order.
        decisions: in order.
        bookmark: the decision to begin with, or None.
    """

    method: str
    mask_rule: str
    completed: int
    cost: float
    makespan: float
    routes: list[list[VisitJson]]
    decisions: list[DecisionJson]
    bookmark: int | None


class PlaceJson(msgspec.Struct, frozen=True):
    """The scenario, as far as the page shows it, and the part of plane and time shown, see `mrta_zoo.show.view`."""

    name: str
    low: tuple[float, float]
    """Lowest x and y."""
    size: tuple[float, float]
    """Width and height."""
    horizon: float
    """The latest deadline that can matter."""
    end: float
    """The end of the time shown."""
    tasks: list[tuple[float, float, float, float]]
    """x, y, deadline and workload of each."""
    robots: list[tuple[float, float, float, float]]
    """x, y, capacity and speed of each."""
    task_names: list[str]
    """The name of each, or else its number."""
    robot_names: list[str]
    """The name of each, or else "robot" and its number."""
    named: bool
    """Whether robots have names, so that the page explains their numbers on the map."""
    digits: tuple[int, int]
    """Digits after the point, of times and of distances."""


def place_of(scenario: Scenario, makespan: float) -> PlaceJson:
    """The scenario for the page.

    Args:
        scenario: the scenario.
        makespan: that of the longest episode.
    """
    low, size = shown_box(scenario)
    tasks = np.column_stack((scenario.task_xy, scenario.deadline, scenario.workload))
    digits = Digits.of(scenario)
    robots = np.column_stack((scenario.robot_xy, scenario.capacity, scenario.speed))
    return PlaceJson(
        name=scenario.name,
        low=tuple(low.tolist()),
        size=tuple(size.tolist()),
        horizon=shown_time(scenario, 0.0),
        end=shown_time(scenario, makespan),
        tasks=tasks.tolist(),
        robots=robots.tolist(),
        task_names=[scenario.task_name(task) for task in range(scenario.num_tasks)],
        robot_names=[scenario.robot_name(robot) for robot in range(scenario.num_robots)],
        named=bool(scenario.robot_names),
        digits=(digits.of_times, digits.of_distances),
    )


def episode_of(trace: Trace) -> EpisodeJson:
    """The episode for the page; the times of its visits are the verifier's."""
    score = trace.score
    lanes = [deadline_lanes(visits) for visits in score.schedule]
    routes: list[list[VisitJson]] = [[] for _ in range(trace.scenario.num_robots)]
    decisions = []
    for mission, decision in trace.steps():
        route = routes[decision.robot]
        if decision.choice.task is not None:
            visit, lane = score.schedule[decision.robot][len(route)], lanes[decision.robot][len(route)]
            leave, arrive, finish = map(_short, (decision.time, visit.arrival, visit.finish))
            route.append(VisitJson(visit.task, decision.index, leave, arrive, finish, visit.completed, lane))
        decisions.append(_decision(mission, decision.choice))
    return EpisodeJson(
        method=trace.method or "unnamed",
        mask_rule=trace.mask_rule,
        completed=score.completed,
        cost=score.cost,
        makespan=score.makespan,
        routes=routes,
        decisions=decisions,
        bookmark=trace.bookmark,
    )


def _decision(mission: Mission, choice: Choice) -> DecisionJson:
    reasons = mission.known(mission.actor).reasons[mission.actor]
    open_to_it = int((reasons == MaskReason.CHOOSABLE).sum())
    return DecisionJson(
        time=_short(mission.time),
        robot=mission.actor,
        task=choice.task,
        advice=choice.advice,
        reasons=np.bincount(reasons, minlength=4).tolist(),
        candidates=[
            CandidateJson(
                each.task,
                _short(each.distance),
                _short(each.finish),
                int(each.reason),
                str(each),
                None if each.probability is None else round(each.probability, 4),
                "" if each.probability is None else percent(each.probability, only=open_to_it == 1),
            )
            for each in outlook(mission, mission.actor, choice.probabilities, _listed(mission, choice, reasons))
        ],
    )


def _listed(mission: Mission, choice: Choice, reasons: npt.NDArray[np.int8]) -> list[int]:
    """The tasks to list, in order."""
    finish = mission.finish_if[mission.actor]
    probability = np.zeros(len(finish))
    for task, value in (choice.probabilities or {}).items():
        probability[task] = value
    open_to_it = np.flatnonzero(reasons == MaskReason.CHOOSABLE)
    order = np.lexsort((finish[open_to_it], -probability[open_to_it]))
    listed: list[int] = open_to_it[order][:MOST_CANDIDATES].tolist()
    listed += {task for task in (choice.task, choice.advice) if task is not None and task not in listed}
    barred = np.flatnonzero((reasons != MaskReason.CHOOSABLE) & (mission.status < Status.COMPLETED))
    distance = np.hypot(*(mission.scenario.task_xy[barred] - mission.position[mission.actor]).T)
    listed += barred[np.argsort(distance, kind="stable")][:MOST_MASKED].tolist()
    return listed


def _short(value: float) -> float:
    """Seven digits: more than a screen shows, and half the size."""
    return float(f"{value:.7g}")
