"""Scenarios as one CSV table: a header row, then one row for each task and robot, and maybe one for the map.

Columns, in any order, in small or capital letters: ``kind`` (task, robot, map or origin), ``x``, ``y``, ``deadline``
and ``workload`` of tasks, ``capacity`` and ``speed`` (1 if empty) of robots, and optionally ``name`` (any text) and
``id``. Where the ids of the tasks are each of 0..N-1 once, they are their numbers; otherwise rows count in order and
the ids are names. The same holds for the robots. A map row gives the width as x and the height as y, an origin row the
map's lowest x and y; what the map is without them, `mrta_zoo.io.parts.assemble` says.
"""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.parts import MapRow, Part, RobotRow, TaskRow, in_id_order, place_in_file
from mrta_zoo.io.paths import suffix_of
from mrta_zoo.io.source import StrPath, number, shown, write_text
from mrta_zoo.io.table import read_table
from mrta_zoo.scenario import Scenario

COLUMNS = ("kind", "x", "y", "deadline", "workload", "capacity", "speed")
NAMING = ("name", "id")
_OF_KIND = {
    "task": (*NAMING, "deadline", "workload"),
    "robot": (*NAMING, "capacity", "speed"),
    "map": (),
    "origin": (),
}

OTHERS = (("robot", "robot_name", "task"), ("case", "method", "completed"), ("update", "episodes", "completion"))
"""Columns by which schedules, rows of measurements and histories of training are known."""


def read_csv_part(path: StrPath) -> Part:
    """What a CSV file says: tasks, robots or both.

    Raises:
        ScenarioError: if it is missing or malformed.
    """
    table = read_table(path, ScenarioError)
    header_where, header = table[0][0], [column.lower() for column in table[0][1]]
    _check_header(header_where, header)
    tasks: list[tuple[str, TaskRow]] = []
    robots: list[tuple[str, RobotRow]] = []
    once: dict[str, tuple[str, float, float]] = {}
    for where, cells in table[1:]:
        row = dict(zip(header, cells, strict=True))
        kind = row["kind"]
        if kind not in _OF_KIND:
            raise ScenarioError(f"{where}: kind is {shown(kind)}; expected task, robot, map or origin")
        _check_empty(where, kind, row)
        x, y = (_cell(row, where, what, 0 if kind == "map" else -math.inf, strict=kind == "map") for what in "xy")
        number, name = row.get("id", ""), row.get("name", "")
        if kind == "task":
            deadline, workload = _cell(row, where, "deadline", strict=True), _cell(row, where, "workload")
            tasks.append((number, TaskRow(where, x, y, deadline, workload, name)))
        elif kind == "robot":
            capacity = _cell(row, where, "capacity", strict=True)
            speed = _cell(row, where, "speed", strict=True) if row.get("speed") else 1.0
            robots.append((number, RobotRow(where, x, y, capacity, speed, name)))
        elif kind in once:
            raise ScenarioError(
                f"{where}: a second {kind} row, after {place_in_file(once[kind][0])}; expected at most one"
            )
        else:
            once[kind] = where, x, y
    return Part(
        path=str(path),
        tasks=in_id_order(tasks, "task"),
        robots=in_id_order(robots, "robot"),
        map=_map(once),
        name=Path(path).stem,
    )


def is_other_csv(path: Path) -> bool:
    """Whether a CSV file is one of this package's that is no scenario, by the columns that it has."""
    if suffix_of(path) != ".csv":
        return False
    try:
        header = {cell.lower() for cell in read_table(path, ScenarioError)[0][1]}
    except ScenarioError:
        return False  # the reader will say what is wrong with it
    return "kind" not in header and any(header.issuperset(columns) for columns in OTHERS)


def _map(once: dict[str, tuple[str, float, float]]) -> MapRow | None:
    if "map" in once:
        return MapRow(*once["map"], *once.get("origin", ())[1:])
    if "origin" in once:
        raise ScenarioError(f"{once['origin'][0]}: an origin row without a map row; expected both, or only a map row")
    return None


def write_csv(scenario: Scenario, path: StrPath) -> None:
    """Write a scenario, exactly; its name is then the file's.

    Raises:
        ScenarioError: if the file cannot be written.
    """
    named = scenario.task_names or scenario.robot_names
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")

    def write(kind: str, x: float, y: float, numbers: tuple[object, ...] = ("",) * 4, name: str = "") -> None:
        writer.writerow((kind, x, y, *numbers, *([name] if named else ())))

    writer.writerow((*COLUMNS, "name") if named else COLUMNS)
    write("map", *scenario.map_size)
    if scenario.map_origin != (0.0, 0.0):
        write("origin", *scenario.map_origin)
    for task, ((x, y), deadline, workload) in enumerate(
        zip(scenario.task_xy.tolist(), scenario.deadline.tolist(), scenario.workload.tolist(), strict=True)
    ):
        write("task", x, y, (deadline, workload, "", ""), scenario.task_name(task) if scenario.task_names else "")
    for robot, ((x, y), capacity, speed) in enumerate(
        zip(scenario.robot_xy.tolist(), scenario.capacity.tolist(), scenario.speed.tolist(), strict=True)
    ):
        write("robot", x, y, ("", "", capacity, speed), scenario.robot_name(robot) if scenario.robot_names else "")
    write_text(stream.getvalue(), path, ScenarioError)


def _check_header(where: str, header: list[str]) -> None:
    allowed = (*COLUMNS, *NAMING)
    for column in header:
        if column not in allowed:
            raise ScenarioError(
                f"{where}: there is no column {shown(column)}; "
                f"expected {', '.join(COLUMNS)} and maybe name or id, separated by commas"
            )
        if header.count(column) > 1:
            raise ScenarioError(f"{where}: column {shown(column)} appears twice; expected each column once")
    for column in ("kind", "x", "y"):
        if column not in header:
            raise ScenarioError(f"{where}: column {shown(column)} is missing; expected {', '.join(COLUMNS)}")


def _check_empty(where: str, kind: str, row: dict[str, str]) -> None:
    """A value that its kind cannot have is a slip of columns more often than not."""
    own = ("kind", "x", "y", *_OF_KIND[kind])
    for column, cell in row.items():
        if cell and column not in own:
            article = "an" if kind == "origin" else "a"
            raise ScenarioError(f"{where}: {column} of {article} {kind} is {shown(cell)}; expected an empty cell")


def _cell(row: dict[str, str], where: str, what: str, least: float = 0, strict: bool = False) -> float:
    if not row.get(what):
        raise ScenarioError(f"{where}: {row['kind']} has no {what}; expected a number in column {what}")
    return number(row[what], where, what, least, ScenarioError, strict=strict)
