"""Scenarios as JSON, read strictly. The schema is ``scenario.schema.json``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
from msgspec import Meta

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.parts import EntityRow, MapRow, Part, in_id_order, robot_rows, task_rows
from mrta_zoo.io.paths import suffix_of
from mrta_zoo.io.strict_json import read_document, write_document
from mrta_zoo.io.text_files import StrPath, read_text
from mrta_zoo.quantities import Who
from mrta_zoo.scenario import Scenario, quantities_of

Positive = Annotated[float, Meta(gt=0)]
NonNegative = Annotated[float, Meta(ge=0)]
Index = Annotated[int, Meta(ge=0)]
Name = Annotated[str, Meta(min_length=1)] | int


class MapJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Size of the map in distance units, and its lowest x and y.

    Without x and y it begins at (0, 0) or, if the places do not suit that, at their smallest whole x and y.
    """

    width: Positive
    height: Positive
    x: float | None = None
    y: float | None = None


def _row_json(title: str, description: str, who: Who) -> type[msgspec.Struct]:
    """The JSON form of a task or robot: a place, the quantities of the field table, a name and an id."""
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

    If the ids are 0..N-1, each once, they number the tasks; otherwise they name the tasks that have no name.
    """,
        "task",
    )
    RobotJson = _row_json(
        "RobotJson",
        "One robot: its start, its work and its distance per time unit, its name, and its id, as for tasks.",
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


def read_json_part(path: StrPath) -> Part:
    """What a JSON scenario file says; a scenario without a name is named after the file.

    Raises:
        ScenarioError: if it is missing or malformed.
    """
    data = read_document(path, ScenarioJson, ScenarioError)
    return json_part(path, data.map, data.tasks, data.robots, data.name or Path(path).stem)


def json_part(
    path: StrPath, size: MapJson | None, tasks: Sequence[RowJson], robots: Sequence[RowJson], name: str
) -> Part:
    """What a JSON file that holds a scenario, alone or with other things, says of it."""
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


def _rows(where: str, rows: Sequence[RowJson], who: Who) -> list[tuple[str, EntityRow]]:
    """Rows with their ids."""
    found = []
    for index, row in enumerate(rows):
        values = {each.name: getattr(row, each.name) for each in quantities_of(who)}
        found.append((_text(row.id), EntityRow(f"{where}[{index}]", row.x, row.y, values, _text(row.name))))
    return found


def _text(name: Name | None) -> str:
    return "" if name is None else str(name)


def is_other_json(path: Path) -> bool:
    """Whether a JSON file says that it is one of this package's other than a scenario, such as a plan."""
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
    """Write a scenario, exactly, with one line per task and robot.

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
