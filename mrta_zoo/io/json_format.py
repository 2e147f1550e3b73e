"""Scenarios and plans as JSON, read strictly. The schemas lie beside this module as ``*.schema.json``."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

import msgspec
from msgspec import Meta

from mrta_zoo.errors import MrtaError, PlanError, ScenarioError
from mrta_zoo.io.parts import MapRow, Part, RobotRow, TaskRow
from mrta_zoo.io.source import StrPath, read_text, shown, write_text
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario

Positive = Annotated[float, Meta(gt=0)]
NonNegative = Annotated[float, Meta(ge=0)]
Index = Annotated[int, Meta(ge=0)]


class MapJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Size of the map in distance units; its corner is the origin."""

    width: Positive
    height: Positive


class TaskJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One task: its place, the latest finish that counts, and the work to be done."""

    x: NonNegative
    y: NonNegative
    deadline: Positive
    workload: NonNegative


class RobotJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One robot: its start, the work it does and the distance it travels per time unit."""

    x: NonNegative
    y: NonNegative
    capacity: Positive
    speed: Positive = 1.0


class ScenarioJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A scenario file. Robots may be left out if they come from an agent file."""

    format: Literal["mrta_zoo.scenario"]
    version: Literal[1]
    map: MapJson
    tasks: Annotated[tuple[TaskJson, ...], Meta(min_length=1)]
    robots: tuple[RobotJson, ...] = ()
    name: str = ""


class ScheduledTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One stop of a robot: when it arrives, when it finishes, and whether that met the deadline."""

    task: Index
    arrival: NonNegative
    finish: NonNegative
    deadline: Positive
    completed: bool


class PlanScore(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the plan achieves: completed of all tasks, their share, cost (Eq. 1), distance and makespan."""

    completed: Index
    tasks: Index
    completion: Annotated[float, Meta(ge=0, le=1)]
    cost: NonNegative
    distance: NonNegative
    makespan: NonNegative


class PlanJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A plan file: for each robot its tasks in order, and for people its schedule and score."""

    format: Literal["mrta_zoo.plan"]
    version: Literal[1]
    routes: tuple[tuple[Index, ...], ...]
    scenario: str = ""
    method: str = ""
    schedule: tuple[tuple[ScheduledTask, ...], ...] | None = None
    score: PlanScore | None = None


FileJson = TypeVar("FileJson", ScenarioJson, PlanJson)


def read_json_part(path: StrPath) -> Part:
    """What a JSON scenario file says; without a name the scenario is called like the file.

    Raises:
        ScenarioError: if it is missing or malformed.
    """
    data = _read(path, ScenarioJson, ScenarioError)
    return Part(
        path=str(path),
        tasks=tuple(
            TaskRow(f"{path}: tasks[{index}]", task.x, task.y, task.deadline, task.workload)
            for index, task in enumerate(data.tasks)
        ),
        robots=tuple(
            RobotRow(f"{path}: robots[{index}]", robot.x, robot.y, robot.capacity, robot.speed)
            for index, robot in enumerate(data.robots)
        ),
        map=MapRow(f"{path}: map", data.map.width, data.map.height),
        name=data.name or Path(path).stem,
    )


def is_other_json(path: Path) -> bool:
    """Whether a JSON file is one of this package's that says itself to be no scenario, such as a plan."""
    if path.suffix != ".json":
        return False
    try:
        head = msgspec.json.decode(path.read_bytes(), type=_Head)
    except (OSError, msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        return False  # the reader will say what is wrong with it
    return head.format.startswith("mrta_zoo.") and head.format != "mrta_zoo.scenario"


class _Head(msgspec.Struct):
    format: str = ""


def write_json(scenario: Scenario, path: StrPath) -> None:
    """Write a scenario, exactly, one task or robot a line.

    Raises:
        ScenarioError: if the file cannot be written.
    """
    tasks = zip(scenario.task_xy.tolist(), scenario.deadline.tolist(), scenario.workload.tolist(), strict=True)
    robots = zip(scenario.robot_xy.tolist(), scenario.capacity.tolist(), scenario.speed.tolist(), strict=True)
    document = {
        "format": "mrta_zoo.scenario",
        "version": 1,
        "name": scenario.name,
        "map": {"width": scenario.map_size[0], "height": scenario.map_size[1]},
        "tasks": [{"x": x, "y": y, "deadline": due, "workload": work} for (x, y), due, work in tasks],
        "robots": [{"x": x, "y": y, "capacity": rate, "speed": speed} for (x, y), rate, speed in robots],
    }
    _write(document, path, ScenarioError)


def read_plan(path: StrPath) -> Plan:
    """The plan of a JSON plan file. Its schedule and score are checked for form and left out.

    Raises:
        PlanError: if the file is missing or malformed.
    """
    data = _read(path, PlanJson, PlanError)
    return Plan(routes=data.routes, scenario=data.scenario, method=data.method)


def write_plan(
    plan: Plan,
    path: StrPath,
    *,
    schedule: Sequence[Sequence[ScheduledTask]] | None = None,
    score: PlanScore | None = None,
) -> None:
    """Write a plan, one route a line, and for people the schedule (a sequence for each robot) and score.

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
    if score is not None:
        document["score"] = msgspec.to_builtins(score)
    if schedule is not None:
        document["schedule"] = [[msgspec.to_builtins(stop) for stop in stops] for stops in schedule]
    _write(document, path, PlanError)


def schema_text(document: type[ScenarioJson] | type[PlanJson]) -> str:
    """The JSON Schema of a kind of file, as it lies beside this module."""
    schema = {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(document)}
    return json.dumps(schema, indent=2) + "\n"


class _TokenError(Exception):
    """Something in the text that JSON or Python's reader of it would let pass."""

    def __init__(self, token: str, complaint: str) -> None:
        self.token, self.complaint = token, complaint


_NAMES: dict[type, str] = {ScenarioJson: "mrta_zoo.scenario", PlanJson: "mrta_zoo.plan"}


def _read(path: StrPath, kind: type[FileJson], error: type[MrtaError]) -> FileJson:
    text = read_text(path, error)
    try:
        document = json.loads(
            text, parse_float=_float, parse_int=_int, parse_constant=_constant, object_pairs_hook=_object
        )
    except json.JSONDecodeError as problem:
        rest = text[problem.pos :].split("\n")[0]
        raise error(
            f"{path}, line {problem.lineno}, column {problem.colno}: {problem.msg.lower()} "
            f"at {shown(rest) if rest else 'the end of the line'}; expected JSON"
        ) from None
    except _TokenError as problem:
        raise error(f"{path}, line {_line_of(problem.token, text)}: {problem.complaint}") from None
    except RecursionError:
        raise error(f"{path} is nested too deeply; expected a {_NAMES[kind]} file") from None
    if not isinstance(document, dict):
        raise error(f"{path} holds {shown(document)}; expected an object with {_fields(kind)}")
    # Before all else, so that the wrong kind of file is called that.
    for field, expected in (("format", _NAMES[kind]), ("version", 1)):
        if field not in document:
            raise error(f"{path} has no field {field!r}; expected {field} {shown(expected)}")
        if type(document[field]) is not type(expected) or document[field] != expected:
            raise error(f"{path}: {field} is {shown(document[field])}; expected {shown(expected)}")
    for field in ("name", "scenario", "method"):
        value = document.get(field)
        if isinstance(value, str) and not value.isascii() and re.search("[\ud800-\udfff]", value):
            raise error(f"{path}: {field} is {shown(value)}; expected text without lone surrogates")
    try:
        return msgspec.convert(document, type=kind)
    except msgspec.ValidationError as problem:
        raise error(_sentence(path, str(problem), document, kind)) from None


def _int(token: str) -> int | float:
    # No index or id is longer, and Python refuses to read very long ones.
    return int(token) if len(token) <= 18 else _float(token)


def _float(token: str) -> float:
    value = float(token)
    if not math.isfinite(value):
        raise _TokenError(token, f"{shown(token)} is too large; expected a finite number")
    return value


def _constant(token: str) -> float:
    raise _TokenError(token, f"{token} is no JSON number; expected a finite number")


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise _TokenError(twice, f"field {shown(twice)} appears twice in an object; expected it once")
    return members


def _line_of(token: str, text: str) -> int:
    """Line where a number, literal or field name first occurs as a whole token."""
    for match in re.finditer(r'"((?:[^"\\]|\\.)*)"|[^\s,:\[\]{}"]+', text):
        if token in (match[0], match[1]):
            return text.count("\n", 0, match.start()) + 1
    return 1


_PLACE = re.compile(r" - at `\$\.?([^`]*)`$")
_EXPECTED = re.compile(r"Expected `([^`]*)`((?: of length)? [<>]=? [0-9.]+)?")
_PLAIN = {
    "float": "a number",
    "int": "a whole number",
    "str": "text",
    "bool": "true or false",
    "array": "a list",
    "object": "an object",
}
_PARTS: dict[str, type[msgspec.Struct]] = {
    "map": MapJson,
    "tasks": TaskJson,
    "robots": RobotJson,
    "schedule": ScheduledTask,
    "score": PlanScore,
}


def _sentence(path: StrPath, message: str, document: Any, kind: type[msgspec.Struct]) -> str:
    """msgspec's complaint about a document as a sentence that also shows the value."""
    found = _PLACE.search(message)
    complaint, place = (message[: found.start()], found[1]) if found else (message, "")
    value = document
    for name, index in re.findall(r"(\w+)(?!\w*\])|\[(\d+)\]", place):
        value = value[int(index)] if index else value[name]
    where = f"{path}: {place}" if place else str(path)
    if field := re.search(r"(unknown|required) field `(.*)`", complaint, re.DOTALL):
        fields = _fields(_PARTS[re.split(r"\W", place)[0]] if place else kind)
        if field[1] == "required":
            return f"{where} has no field {shown(field[2])}; expected {fields}"
        return f"{where} has an unknown field {shown(field[2])}; expected only {fields}"
    expected = _EXPECTED.match(complaint)
    if not expected:
        return f"{where} is {shown(value)}; {complaint}"
    names = " or ".join(_PLAIN.get(name, name) for name in expected[1].split(" | "))
    return f"{where} is {shown(value)}; expected {names}{(expected[2] or '').removesuffix('.0')}"


def _fields(kind: type[msgspec.Struct]) -> str:
    return ", ".join(kind.__struct_fields__)


def _write(document: dict[str, Any], path: StrPath, error: type[MrtaError]) -> None:
    """JSON with one element of each top-level list a line, to be read by people too."""
    lines = []
    try:
        for field, value in document.items():
            if isinstance(value, list) and value:
                rows = ",\n".join("    " + json.dumps(row, allow_nan=False) for row in value)
                lines.append(f"  {json.dumps(field)}: [\n{rows}\n  ]")
            else:
                lines.append(f"  {json.dumps(field)}: {json.dumps(value, allow_nan=False)}")
    except ValueError:
        raise error(f"{path} cannot be written: {field} holds a number that is not finite") from None
    write_text("{\n" + ",\n".join(lines) + "\n}\n", path, error)
