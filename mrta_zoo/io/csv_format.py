"""Scenarios as one CSV table: a header row, then one row for each task and robot, and maybe one for the map.

Columns, in any order: ``kind`` (task, robot or map), ``x``, ``y``, ``deadline`` and ``workload`` of tasks,
``capacity`` and ``speed`` (1 if empty) of robots, and optionally ``id`` (each of 0..N-1 once among the tasks,
and likewise among the robots; without it rows count in order). A map row gives the width as x and the height
as y; without one the map is the smallest square from the origin that holds everything and has a whole side.
"""

from __future__ import annotations

import csv
import io
from pathlib import Path

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.parts import MapRow, Part, RobotRow, TaskRow, in_id_order
from mrta_zoo.io.source import StrPath, count, number, shown, write_text
from mrta_zoo.io.table import read_table
from mrta_zoo.scenario import Scenario

COLUMNS = ("kind", "x", "y", "deadline", "workload", "capacity", "speed")
_OF_KIND = {"task": ("deadline", "workload"), "robot": ("capacity", "speed"), "map": ()}


def read_csv_part(path: StrPath) -> Part:
    """What a CSV file says: tasks, robots or both.

    Raises:
        ScenarioError: if it is missing or malformed.
    """
    table = read_table(path, ScenarioError)
    header_where, header = table[0]
    _check_header(header_where, header)
    tasks: list[tuple[int, TaskRow]] = []
    robots: list[tuple[int, RobotRow]] = []
    map_row: MapRow | None = None
    for where, cells in table[1:]:
        row = dict(zip(header, cells, strict=True))
        kind = row["kind"]
        if kind not in _OF_KIND:
            raise ScenarioError(f"{where}: kind is {shown(kind)}; expected task, robot or map")
        _check_empty(where, kind, row)
        if kind == "task":
            index = count(row["id"], where, "task id", ScenarioError) if "id" in row else len(tasks)
            x, y, workload = (_cell(row, where, what) for what in ("x", "y", "workload"))
            tasks.append((index, TaskRow(where, x, y, _cell(row, where, "deadline", strict=True), workload)))
        elif kind == "robot":
            index = count(row["id"], where, "robot id", ScenarioError) if "id" in row else len(robots)
            x, y = _cell(row, where, "x"), _cell(row, where, "y")
            capacity = _cell(row, where, "capacity", strict=True)
            speed = _cell(row, where, "speed", strict=True) if row.get("speed") else 1.0
            robots.append((index, RobotRow(where, x, y, capacity, speed)))
        elif map_row is not None:
            raise ScenarioError(
                f"{where}: a second map row, after {map_row.where.rpartition(', ')[2]}; expected at most one"
            )
        else:
            map_row = MapRow(where, *(_cell(row, where, what, strict=True) for what in ("x", "y")))
    return Part(
        path=str(path),
        tasks=in_id_order(tasks, "task"),
        robots=in_id_order(robots, "robot"),
        map=map_row,
        name=Path(path).stem,
    )


def write_csv(scenario: Scenario, path: StrPath) -> None:
    """Write a scenario, exactly; its name is then the file's.

    Raises:
        ScenarioError: if the file cannot be written.
    """
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerow(["map", *scenario.map_size, "", "", "", ""])
    for (x, y), deadline, workload in zip(
        scenario.task_xy.tolist(), scenario.deadline.tolist(), scenario.workload.tolist(), strict=True
    ):
        writer.writerow(["task", x, y, deadline, workload, "", ""])
    for (x, y), capacity, speed in zip(
        scenario.robot_xy.tolist(), scenario.capacity.tolist(), scenario.speed.tolist(), strict=True
    ):
        writer.writerow(["robot", x, y, "", "", capacity, speed])
    write_text(stream.getvalue(), path, ScenarioError)


def _check_header(where: str, header: list[str]) -> None:
    allowed = (*COLUMNS, "id")
    for column in header:
        if column not in allowed:
            raise ScenarioError(
                f"{where}: there is no column {shown(column)}; "
                f"expected {', '.join(COLUMNS)} and maybe id, separated by commas"
            )
        if header.count(column) > 1:
            raise ScenarioError(f"{where}: column {shown(column)} appears twice; expected each column once")
    for column in ("kind", "x", "y"):
        if column not in header:
            raise ScenarioError(f"{where}: column {shown(column)} is missing; expected {', '.join(COLUMNS)}")


def _check_empty(where: str, kind: str, row: dict[str, str]) -> None:
    """A value that its kind cannot have is a slip of columns more often than not."""
    own = ("kind", "x", "y", *_OF_KIND[kind], *(("id",) if kind != "map" else ()))
    for column, cell in row.items():
        if cell and column not in own:
            raise ScenarioError(f"{where}: {column} of a {kind} is {shown(cell)}; expected an empty cell")


def _cell(row: dict[str, str], where: str, what: str, strict: bool = False) -> float:
    if not row.get(what):
        raise ScenarioError(f"{where}: {row['kind']} has no {what}; expected a number in column {what}")
    return number(row[what], where, what, 0, ScenarioError, strict=strict)
