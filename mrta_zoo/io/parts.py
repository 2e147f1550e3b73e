"""What one file says of a scenario, before the task file and the agent file are put together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.source import check_name
from mrta_zoo.scenario import BOUNDS, LARGEST, SMALLEST, Scenario


class TaskRow(NamedTuple):
    """One task as read: where it stands ("file, line 3"), its place, deadline > 0 and workload >= 0."""

    where: str
    x: float
    y: float
    deadline: float
    workload: float


class RobotRow(NamedTuple):
    """One robot as read: where it stands ("file, line 3"), its start, capacity > 0 and speed > 0."""

    where: str
    x: float
    y: float
    capacity: float
    speed: float


class MapRow(NamedTuple):
    """The map as read: where it stands, its width > 0 and height > 0."""

    where: str
    width: float
    height: float


Row = TypeVar("Row", TaskRow, RobotRow)


@dataclass(frozen=True, slots=True)
class Part:
    """All that one file says. Rows are in index order; their values are checked, except against the map.

    Attributes:
        path: the file.
        tasks: its tasks, maybe none.
        robots: its robots, maybe none.
        map: its map, None if it names none.
        name: the scenario's name.
        num_robots: the number of robots a task file promises, None if it is silent.
    """

    path: str
    tasks: tuple[TaskRow, ...] = ()
    robots: tuple[RobotRow, ...] = ()
    map: MapRow | None = None
    name: str = ""
    num_robots: int | None = None


def assemble(main: Part, agents: Part | None) -> Scenario:
    """The scenario of a file that has all, or of a file with tasks and another with the robots.

    Without a map in either file it is the smallest square from the origin that holds every place and has a
    whole side >= 1.

    Raises:
        ScenarioError: if something is missing or said twice, a number is too small or large, or a place is outside
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
            f"{agents.path} has {len(agents.robots)} robots; expected {main.num_robots}, "
            f"the number in line 1 of {main.path}"
        )
    for each in (main.map, *main.tasks, agents.map, *agents.robots):
        if each is not None:
            check_magnitudes(each)
    map_size = _map_size(main, agents)
    for rows in (main.tasks, agents.robots):
        check_inside(rows, map_size)
    return Scenario(
        task_xy=[(row.x, row.y) for row in main.tasks],  # type: ignore[arg-type]
        deadline=[row.deadline for row in main.tasks],  # type: ignore[arg-type]
        workload=[row.workload for row in main.tasks],  # type: ignore[arg-type]
        robot_xy=[(row.x, row.y) for row in agents.robots],  # type: ignore[arg-type]
        capacity=[row.capacity for row in agents.robots],  # type: ignore[arg-type]
        speed=[row.speed for row in agents.robots],  # type: ignore[arg-type]
        map_size=map_size,
        name=main.name,
    )


def _map_size(main: Part, agents: Part) -> tuple[float, float]:
    if main.map and agents.map and main.map[1:] != agents.map[1:]:
        raise ScenarioError(
            f"{agents.map.where}: map is {agents.map.width:g} x {agents.map.height:g}; expected "
            f"{main.map.width:g} x {main.map.height:g} as in {main.path}"
        )
    named = main.map or agents.map
    if named:
        return named.width, named.height
    rows: tuple[TaskRow | RobotRow, ...] = (*main.tasks, *agents.robots)
    side = max(1.0, *(max(row.x, row.y) for row in rows))
    return (float(-(-side // 1)),) * 2  # ceil that stays a float, however large


def check_magnitudes(row: TaskRow | RobotRow | MapRow) -> None:
    """Raises ScenarioError for a number of a row that `Scenario` would refuse without saying where it stands."""
    for what, value in zip(row._fields[1:], row[1:], strict=True):
        may_be_zero = what in ("x", "y", "workload")
        if not (may_be_zero or value >= SMALLEST) or value > LARGEST:
            expected = f"a number from 0 to {LARGEST:g}" if may_be_zero else f"a number > 0{BOUNDS}"
            raise ScenarioError(f"{row.where}: {what} is {value!r}; expected {expected}")


def check_inside(rows: Sequence[TaskRow | RobotRow], map_size: tuple[float, float]) -> None:
    """Raises ScenarioError for the first row whose place is outside the map."""
    for row in rows:
        for letter, value, side in (("x", row.x, map_size[0]), ("y", row.y, map_size[1])):
            if not 0 <= value <= side:
                raise ScenarioError(
                    f"{row.where}: {letter} is {value!r}; expected a number from 0 to {side!r}, inside the map"
                )


def in_id_order(rows: Sequence[tuple[int, Row]], what: str) -> tuple[Row, ...]:
    """The rows sorted by the ids they came with, which must be each of 0..N-1 once.

    Raises:
        ScenarioError: for an id out of range or met before; a gap always shows as one of the two.
    """
    ordered: list[Row | None] = [None] * len(rows)
    for index, row in rows:
        if index >= len(rows):
            raise ScenarioError(
                f"{row.where}: {what} id is {index}; expected each of 0 to {len(rows) - 1} once, "
                f"as there are {len(rows)} {what}s"
            )
        earlier = ordered[index]
        if earlier is not None:
            raise ScenarioError(
                f"{row.where}: {what} id {index} was already used in {earlier.where.rpartition(', ')[2]}; "
                "expected each id once"
            )
        ordered[index] = row
    return tuple(row for row in ordered if row is not None)
