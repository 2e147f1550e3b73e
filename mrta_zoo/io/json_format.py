"""Scenarios and plans as JSON, read strictly. The schemas lie beside this module as ``*.schema.json``."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from msgspec import Meta

from mrta_zoo.errors import PlanError, ScenarioError
from mrta_zoo.io.parts import MapRow, Part, Row, in_id_order, robot_rows, task_rows
from mrta_zoo.io.paths import suffix_of
from mrta_zoo.io.source import StrPath, read_text
from mrta_zoo.io.strict_json import read_document, write_document
from mrta_zoo.left_out import LeftOut, Reason
from mrta_zoo.plan import Plan
from mrta_zoo.quantities import Who
from mrta_zoo.scenario import Scenario, quantities_of
from mrta_zoo.verify import Score
from mrta_zoo.wording import composed

Positive = Annotated[float, Meta(gt=0)]
NonNegative = Annotated[float, Meta(ge=0)]
Index = Annotated[int, Meta(ge=0)]


Name = Annotated[str, Meta(min_length=1)] | int


class MapJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Size of the map in distance units, and its lowest x and y.

    Without these it begins at 0 and 0 or, if it would not hold every place then, at their least whole x and y.
    """

    width: Positive
    height: Positive
    x: float | None = None
    y: float | None = None


def _row_json(title: str, description: str, who: Who) -> type[msgspec.Struct]:
    """The form of a task or robot: a place, the quantities of the field table, a name and an id."""
    quantities = [
        (each.name, Positive if each.positive else NonNegative, *(() if each.default is None else (each.default,)))
        for each in quantities_of(who)
    ]
    return msgspec.defstruct(
        title,
        [("x", float), ("y", float), *quantities, ("name", Name | None, None), ("id", Name | None, None)],
        namespace={"__doc__": description},
        module=__name__,
        frozen=True,
        forbid_unknown_fields=True,
    )


if TYPE_CHECKING:

    class RowJson(msgspec.Struct):
        x: float
        y: float
        name: Name | None
        id: Name | None

    TaskJson = RowJson
    RobotJson = RowJson
else:
    TaskJson = _row_json(
        "TaskJson",
        """One task: its place, the latest finish that counts, the work to be done, its name, and its id.

    Where the ids are each of 0..N-1 once they number the tasks; otherwise they are names of those that have no name.
    """,
        "task",
    )
    RobotJson = _row_json(
        "RobotJson",
        "One robot: its start, its work and its way per time unit, its name, and its id, as those of tasks.",
        "robot",
    )


class ScenarioJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A scenario file. Robots may be left out if they come from an agent file, and so may the map."""

    format: Literal["mrta_zoo.scenario"]
    version: Literal[1]
    tasks: Annotated[tuple[TaskJson, ...], Meta(min_length=1)]
    robots: tuple[RobotJson, ...] = ()
    name: str = ""
    map: MapJson | None = None


class VisitJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One stop of a robot: when it arrives, when it finishes, and whether that met the deadline.

    The names of the task and the robot are there if they have one.
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
    """What the plan achieves: completed of all tasks, their share, cost (Eq. 1), distance and makespan."""

    completed: Index
    tasks: Index
    completion: Annotated[float, Meta(ge=0, le=1)]
    cost: NonNegative
    distance: NonNegative
    makespan: NonNegative


class PlanJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A plan file: for each robot its tasks in order, for people its schedule and score, and what no plan exceeds.

    What is left out is for people, too, as are names: tasks and robots are known by their numbers, from 0.
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


def read_json_part(path: StrPath) -> Part:
    """What a JSON scenario file says; without a name the scenario is called like the file.

    Raises:
        ScenarioError: if it is missing or malformed.
    """
    data = read_document(path, ScenarioJson, ScenarioError)
    return json_part(path, data.map, data.tasks, data.robots, data.name or Path(path).stem)


def json_part(
    path: StrPath, size: MapJson | None, tasks: Sequence[RowJson], robots: Sequence[RowJson], name: str
) -> Part:
    """What any JSON file that holds a scenario says of it."""
    return Part(
        path=str(path),
        tasks=in_id_order(_rows(f"{path}: tasks", tasks, "task"), "task"),
        robots=in_id_order(_rows(f"{path}: robots", robots, "robot"), "robot"),
        map=None if size is None else _map(path, size),
        name=name,
    )


def _map(path: StrPath, size: MapJson) -> MapRow:
    x, y = (math.nan if corner is None else corner for corner in (size.x, size.y))
    if math.isnan(x) != math.isnan(y):
        raise ScenarioError(f"{path}: map has only one of x and y; expected both, or neither")
    return MapRow(f"{path}: map", size.width, size.height, x, y)


def _rows(where: str, rows: Sequence[RowJson], who: Who) -> list[tuple[str, Row]]:
    """Rows with their ids."""
    names = [each.name for each in quantities_of(who)]
    return [
        (
            _text(row.id),
            Row(f"{where}[{index}]", row.x, row.y, {name: getattr(row, name) for name in names}, _text(row.name)),
        )
        for index, row in enumerate(rows)
    ]


def _text(name: Name | None) -> str:
    return "" if name is None else str(name)


def is_other_json(path: Path) -> bool:
    """Whether a JSON file is one of this package's that says itself to be no scenario, such as a plan."""
    kind = json_kind(path)
    return kind.startswith("mrta_zoo.") and kind != "mrta_zoo.scenario"


def json_kind(path: Path) -> str:
    """The format that a ``.json`` file says it has, such as "mrta_zoo.plan"; empty if it does not say."""
    if suffix_of(path) != ".json":
        return ""
    try:
        return msgspec.json.decode(read_text(path, ScenarioError), type=_Head).format
    except (ScenarioError, msgspec.MsgspecError, RecursionError):
        return ""  # the reader will say what is wrong with it


class _Head(msgspec.Struct):
    format: str = ""


def write_json(scenario: Scenario, path: StrPath) -> None:
    """Write a scenario, exactly, one task or robot a line.

    Raises:
        ScenarioError: if the file cannot be written.
    """
    document = {"format": "mrta_zoo.scenario", "version": 1, **scenario_fields(scenario)}
    write_document(document, path, ScenarioError)


def scenario_fields(scenario: Scenario) -> dict[str, Any]:
    """The fields that hold a scenario in any JSON file."""
    corner = {} if scenario.map_origin == (0.0, 0.0) else dict(zip("xy", scenario.map_origin, strict=True))
    return {
        "name": scenario.name,
        "map": {"width": scenario.map_size[0], "height": scenario.map_size[1], **corner},
        "tasks": task_rows(scenario),
        "robots": robot_rows(scenario),
    }


def read_plan(path: StrPath) -> Plan:
    """The plan of a JSON plan file. What is there for people is checked for form only, and dropped.

    Raises:
        PlanError: if the file is missing or malformed.
    """
    data = read_document(path, PlanJson, PlanError)
    return Plan(routes=data.routes, scenario=composed(data.scenario), method=data.method, bound=data.bound)


def write_plan(
    plan: Plan, path: StrPath, score: Score | None = None, left_out: Sequence[LeftOut] | None = None
) -> None:
    """Write a plan, one route a line, and for people its score with the schedule, and what it leaves out.

    Args:
        plan: the plan.
        path: the file.
        score: of the plan.
        left_out: by the plan; names of tasks are taken from the score.

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


def schema_text(document: type[msgspec.Struct]) -> str:
    """The JSON Schema of a kind of file, as it lies beside this module."""
    schema = {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(document)}
    return json.dumps(schema, indent=2) + "\n"
