"""Plans as JSON, read strictly. The schema is ``plan.schema.json``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from mrta_zoo.errors import PlanError
from mrta_zoo.io.json_format import Index, NonNegative, Positive
from mrta_zoo.io.strict_json import read_document, write_document
from mrta_zoo.io.text_files import StrPath
from mrta_zoo.left_out import LeftOut, Reason
from mrta_zoo.plan import Plan
from mrta_zoo.verify import Score
from mrta_zoo.wording import composed


class VisitJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One stop of a robot: when it arrives, when it finishes, and whether that met the deadline.

    The names of the task and the robot are given if they have one.
    """

    task: Index
    arrival: NonNegative
    finish: NonNegative
    deadline: Positive
    completed: bool
    name: str | None = None
    robot_name: str | None = None


class LeftOutJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A task that nobody takes, its name if it has one, and why.

    It is out of reach if no robot could finish it by its deadline, even if it went straight there at the start.
    """

    task: Index
    reason: Reason
    name: str | None = None


class ScoreJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the plan achieves: tasks completed, of how many, their share, cost (Eq. 1), distance and makespan."""

    completed: Index
    tasks: Index
    completion: Annotated[float, Meta(ge=0, le=1)]
    cost: NonNegative
    distance: NonNegative
    makespan: NonNegative


class PlanJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A plan file: each robot's tasks in order, a bound that no plan exceeds, and for people the schedule and score.

    The tasks left out and all names are for people, too: tasks and robots are identified by their numbers, from 0.
    """

    format: Literal["mrta_zoo.plan"]
    version: Literal[1]
    routes: tuple[tuple[Index, ...], ...]
    scenario: str = ""
    method: str = ""
    schedule: tuple[tuple[VisitJson, ...], ...] | None = None
    score: ScoreJson | None = None
    left_out: tuple[LeftOutJson, ...] | None = None
    bound: Index | None = None  # completed tasks


def read_plan(path: StrPath) -> Plan:
    """The plan in a JSON plan file. The parts for people are only checked for their form, then ignored.

    Raises:
        PlanError: if the file is missing or malformed.
    """
    data = read_document(path, PlanJson, PlanError)
    return Plan(routes=data.routes, scenario=composed(data.scenario), method=data.method, bound=data.bound)


def write_plan(
    plan: Plan, path: StrPath, score: Score | None = None, left_out: Sequence[LeftOut] | None = None
) -> None:
    """Write a plan, one line per route, and for people its score, its schedule and the tasks it leaves out.

    Args:
        plan: the plan.
        path: the file.
        score: the plan's score, with its schedule and the names of tasks and robots.
        left_out: the tasks that the plan leaves out.

    Raises:
        PlanError: if the file cannot be written.
    """
    document: dict[str, Any] = {
        "format": "mrta_zoo.plan",
        "version": 1,
        "scenario": plan.scenario,
        "method": plan.method,
        "routes": [list(route) for route in plan.routes],
    }
    if plan.bound is not None:
        document["bound"] = plan.bound
    tasks, robots = (score.task_names, score.robot_names) if score is not None else ((), ())
    if score is not None:
        document["score"] = {field: getattr(score, field) for field in ScoreJson.__struct_fields__}
    if left_out is not None:
        document["left_out"] = [{**asdict(each), **_named("name", tasks, each.task)} for each in left_out]
    if score is not None:
        document["schedule"] = [
            [
                {**asdict(visit), **_named("name", tasks, visit.task), **_named("robot_name", robots, robot)}
                for visit in visits
            ]
            for robot, visits in enumerate(score.schedule)
        ]
    write_document(document, path, PlanError)


def _named(field: str, names: Sequence[str], index: int) -> dict[str, str]:
    return {field: names[index]} if names else {}
