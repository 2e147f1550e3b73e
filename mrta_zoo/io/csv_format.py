"""Scenarios as one CSV table: a header row, then one row per task and robot, and optionally one for the map.

Columns, in any order, in lower or upper case: ``kind`` (task, robot, map or origin), ``x``, ``y``, ``deadline`` and
``workload`` of tasks, ``capacity`` and ``speed`` (1 if empty) of robots, and optionally ``name`` (any text) and ``id``.
If the ids of the tasks are 0..N-1, each once, they number the tasks; otherwise tasks are numbered in order of their
rows, and the ids are names. The same holds for the robots. A map row gives the width as x and the height as y, an
origin row the map's lowest x and y; `mrta_zoo.io.parts.assemble` says what the map is without them.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from pathlib import Path
from typing import get_args

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.parts import EntityRow, MapRow, Part, in_id_order, place_in_file, robot_rows, task_rows
from mrta_zoo.io.paths import suffix_of
from mrta_zoo.io.table import read_table
from mrta_zoo.io.text_files import StrPath, number, shown, write_text
from mrta_zoo.quantities import Quantity, Who
from mrta_zoo.scenario import QUANTITIES, Scenario, quantities_of

PLACE = ("kind", "x", "y")
NAMING = ("name", "id")
KINDS = ("task", "robot", "map", "origin")
COLUMNS = (*PLACE, *(each.name for who in get_args(Who) for each in quantities_of(who)))

OTHERS = (("robot", "robot_name", "task"), ("case", "method", "completed"), ("update", "episodes", "completion"))
"""Columns by which schedules, rows of measurements and training histories are recognised."""


def read_csv_part(path: StrPath) -> Part:
    """What a CSV file says: tasks, robots or both.

    Raises:
        ScenarioError: if it is missing or malformed.
    """
    table = read_table(path, ScenarioError)
    header_where, header = table[0][0], [column.lower() for column in table[0][1]]
    _check_header(header_where, header)
    rows: dict[str, list[tuple[str, EntityRow]]] = {"task": [], "robot": []}
    once: dict[str, tuple[str, float, float]] = {}
    for where, cells in table[1:]:
        row = dict(zip(header, cells, strict=True))
        kind = row["kind"]
        if kind not in KINDS:
            raise ScenarioError(f"{where}: kind is {shown(kind)}; expected task, robot, map or origin")
        quantities = [each for each in QUANTITIES if each.who == kind]
        _check_empty(where, kind, row, quantities)
        x, y = (_cell(row, where, what, 0 if kind == "map" else -math.inf, strict=kind == "map") for what in "xy")
        if kind in rows:
            values = {
                each.name: _cell(row, where, each.name, strict=each.positive)
                for each in quantities
                if each.default is None or row.get(each.name)
            }
            rows[kind].append((row.get("id", ""), EntityRow(where, x, y, values, row.get("name", ""))))
        elif kind in once:
            raise ScenarioError(
                f"{where}: a second {kind} row, after {place_in_file(once[kind][0])}; expected at most one"
            )
        else:
            once[kind] = where, x, y
    return Part(
        path=str(path),
        tasks=in_id_order(rows["task"], "task"),
        robots=in_id_order(rows["robot"], "robot"),
        map=_map(once),
        name=Path(path).stem,
    )


def is_other_csv(path: Path) -> bool:
    """Whether a CSV file, by its columns, is one of this package's other than a scenario."""
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
    quantities = {**scenario.said("task"), **scenario.said("robot")}
    naming = ["name"] if scenario.task_names or scenario.robot_names else []
    stream = io.StringIO()
    writer = csv.DictWriter(stream, [*PLACE, *quantities, *naming], lineterminator="\n")
    writer.writeheader()
    writer.writerow(dict(zip(PLACE, ("map", *scenario.map_size), strict=True)))
    if scenario.map_origin != (0.0, 0.0):
        writer.writerow(dict(zip(PLACE, ("origin", *scenario.map_origin), strict=True)))
    for who, rows in (("task", task_rows(scenario)), ("robot", robot_rows(scenario))):
        writer.writerows({"kind": who, **row} for row in rows)
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
    for column in PLACE:
        if column not in header:
            raise ScenarioError(f"{where}: column {shown(column)} is missing; expected {', '.join(COLUMNS)}")


def _check_empty(where: str, kind: str, row: dict[str, str], quantities: Sequence[Quantity]) -> None:
    """Refuse a value that its kind of row cannot have: it usually belongs in another column."""
    own = (*PLACE, *(each.name for each in quantities), *(NAMING if quantities else ()))
    for column, cell in row.items():
        if cell and column not in own:
            article = "an" if kind == "origin" else "a"
            raise ScenarioError(f"{where}: {column} of {article} {kind} is {shown(cell)}; expected an empty cell")


def _cell(row: dict[str, str], where: str, what: str, least: float = 0, strict: bool = False) -> float:
    if not row.get(what):
        raise ScenarioError(f"{where}: {row['kind']} has no {what}; expected a number in column {what}")
    return number(row[what], where, what, least, ScenarioError, strict=strict)
