"""Parts of a scenario: what one file says of it, before a task file and an agent file are put together."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from mrta_zoo.digits import full
from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.text_files import check_name, shown
from mrta_zoo.map import square_around
from mrta_zoo.names import usable_name
from mrta_zoo.quantities import BOUNDS, COORDINATE, LARGEST, SMALLEST, FloatArray, RowError, Who
from mrta_zoo.scenario import QUANTITIES, Scenario
from mrta_zoo.wording import composed, counted


@dataclass(frozen=True, slots=True)
class EntityRow:
    """One task or robot as read.

    Attributes:
        where: its place in the file: "file, line 3".
        x: its place, or where it starts.
        y: likewise.
        values: its quantities, see `mrta_zoo.scenario.QUANTITIES`; those with a default may be missing.
        name: its name; empty if it has none.
    """

    where: str
    x: float
    y: float
    values: Mapping[str, float]
    name: str = ""


class MapRow(NamedTuple):
    """The map as read: its place in the file, its size, and its lowest x and y, NaN if not given."""

    where: str
    width: float
    height: float
    x: float = math.nan
    y: float = math.nan


@dataclass(frozen=True, slots=True)
class Part:
    """All that one file says. Rows are in index order; their values are checked, except against the map.

    Attributes:
        path: the file.
        tasks: its tasks, if any.
        robots: its robots, if any.
        map: its map; None if it gives none.
        name: the scenario's name.
        num_robots: the number of robots that a task file announces; None if it announces none.
    """

    path: str
    tasks: tuple[EntityRow, ...] = ()
    robots: tuple[EntityRow, ...] = ()
    map: MapRow | None = None
    name: str = ""
    num_robots: int | None = None


def assemble(main: Part, agents: Part | None) -> Scenario:
    """The scenario in one file, or in a file with the tasks and another with the robots.

    If neither file gives a map, it is `mrta_zoo.map.square_around` all places.

    Raises:
        ScenarioError: if something is missing or given twice, a number is too small or large, or a place is outside
            the map.
    """
    check_name(main.name, main.path, "the scenario's name", ScenarioError)
    if not main.tasks:
        raise ScenarioError(f"{main.path} has 0 tasks; expected at least one")
    if agents is None:
        agents = main
    else:
        if main.robots:
            raise ScenarioError(
                f"{main.robots[0].where}: has a robot, but {agents.path} was given for the robots; "
                "expected robots in one of the two files only"
            )
        if agents.tasks:
            raise ScenarioError(f"{agents.tasks[0].where}: has a task; expected only robots in the agent file")
    if not agents.robots:
        hint = "; name an agent file with --agents" if agents is main else ""
        raise ScenarioError(f"{agents.path} has 0 robots; expected at least one{hint}")
    if main.num_robots is not None and main.num_robots != len(agents.robots):
        raise ScenarioError(
            f"{agents.path} has {counted(len(agents.robots), 'robot')}; expected {main.num_robots}, "
            f"the number in line 1 of {main.path}"
        )
    rows_of: dict[Who, tuple[EntityRow, ...]] = {"task": main.tasks, "robot": agents.robots}
    for row in (*main.tasks, *agents.robots):
        for letter, value in (("x", row.x), ("y", row.y)):
            _check_number(row.where, letter, value, -LARGEST, COORDINATE)
    places = np.array([(row.x, row.y) for row in (*main.tasks, *agents.robots)])
    given = _map_of(main, agents)
    size, origin = (given[1:3], given[3:]) if given else square_around(places)
    try:
        return Scenario(
            task_xy=places[: len(main.tasks)],
            robot_xy=places[len(main.tasks) :],
            map_size=size,
            name=composed(main.name),
            map_origin=origin,
            task_names=_names(main.tasks, "task"),
            robot_names=_names(agents.robots, "robot"),
            **{  # type: ignore[arg-type]
                each.name: [row.values.get(each.name, each.default) for row in rows_of[each.who]] for each in QUANTITIES
            },
        )
    except RowError as error:
        raise ScenarioError(f"{rows_of[error.who][error.index].where}: {error.complaint}") from None


def _map_of(main: Part, agents: Part) -> MapRow | None:
    """The map that either file gives."""
    for each in filter(None, (main.map, agents.map)):
        for what in ("width", "height"):
            _check_number(each.where, what, getattr(each, what), SMALLEST, f"a number > 0{BOUNDS}")
        for what in "xy":
            if not math.isnan(getattr(each, what)):
                _check_number(each.where, what, getattr(each, what), -LARGEST, COORDINATE)
    if main.map and agents.map and repr(main.map[1:]) != repr(agents.map[1:]):  # as texts, in which NaN equals NaN
        raise ScenarioError(
            f"{agents.map.where}: map is {_map_text(agents.map)}; expected {_map_text(main.map)} as in {main.path}"
        )
    return main.map or agents.map


def _map_text(row: MapRow) -> str:
    return f"{full(row.width)} x {full(row.height)}" + (
        "" if math.isnan(row.x) else f" from {full(row.x)}, {full(row.y)}"
    )


def _names(rows: Sequence[EntityRow], who: Who) -> tuple[str, ...]:
    """The names of the rows, which must either all have one or none."""
    if not any(row.name for row in rows):
        return ()
    first: dict[str, EntityRow] = {}
    for row in rows:
        if not row.name:
            raise ScenarioError(f"{row.where}: this {who} has no name; expected one for each {who}, as others have one")
        check_name(row.name, row.where, f"the {who}'s name", ScenarioError)
        name = usable_name(row.name)
        if not name:
            raise ScenarioError(
                f"{row.where}: the {who}'s name is {shown(row.name)}; expected text without control characters"
            )
        if name in first:
            raise ScenarioError(
                f"{row.where}: {who} name {shown(name)} was already used in "
                f"{place_in_file(first[name].where)}; expected each name once"
            )
        first[name] = row
    return tuple(first)


def _check_number(where: str, what: str, value: float, least: float, expected: str) -> None:
    if not least <= value <= LARGEST:
        raise ScenarioError(f"{where}: {what} is {value!r}; expected {expected}")


def place_in_file(where: str) -> str:
    """The place within the file: "line 3" of "file, line 3"."""
    return re.split(r"[:,] ", where)[-1]


def in_id_order(rows: Sequence[tuple[str, EntityRow]], what: str) -> tuple[EntityRow, ...]:
    """Rows, given with their ids: sorted by the ids if these are 0..N-1, each once, otherwise named after them.

    "01" is a name, not such a number. Rows that have a name keep it.

    Raises:
        ScenarioError: if an id is repeated, or missing where others have one.
    """
    ids = [given for given, _ in rows]
    if not any(ids):
        return tuple(row for _, row in rows)
    first: dict[str, EntityRow] = {}
    for given, row in rows:
        if not given:
            raise ScenarioError(f"{row.where}: this {what} has no id; expected one for each {what}, as others have one")
        if given in first:
            raise ScenarioError(
                f"{row.where}: {what} id {shown(given)} was already used in {place_in_file(first[given].where)}; "
                "expected each id once"
            )
        first[given] = row
    numbers = [str(index) for index in range(len(rows))]
    if first.keys() == set(numbers):
        return tuple(first[number] for number in numbers)
    return tuple(row if row.name else replace(row, name=given) for given, row in rows)


def task_rows(scenario: Scenario) -> list[dict[str, Any]]:
    """The tasks of a scenario as files hold them: name, if they have names, x, y and their quantities."""
    return _rows(scenario.task_names, scenario.task_xy, scenario.said("task"))


def robot_rows(scenario: Scenario) -> list[dict[str, Any]]:
    """The robots of a scenario, likewise."""
    return _rows(scenario.robot_names, scenario.robot_xy, scenario.said("robot"))


def _rows(names: Sequence[str], places: FloatArray, quantities: Mapping[str, FloatArray]) -> list[dict[str, Any]]:
    columns = {**({"name": names} if names else {}), "x": places[:, 0].tolist(), "y": places[:, 1].tolist()}
    columns |= {name: values.tolist() for name, values in quantities.items()}
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
