"""Text files of the TAPTC benchmark (Mitiche, Boughaci, Gini 2019): one for the tasks, one for the agents.

Task file: ``m dx dy`` or ``n m dx dy`` (m tasks, n agents, map dx x dy), then m lines
``id x y workload deadline``. Agent file: ``n dx dy``, then n lines ``id x y capacity``. If the ids are 0..N-1, each
once, in any order, they number the tasks or robots; otherwise these are numbered in order of their lines, and the ids
are names. `mrta_zoo.map.map_origin_for` says where the map begins. Every robot has speed 1.
"""

from __future__ import annotations

import math
import os
import re
from pathlib import Path

import numpy as np

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.parts import EntityRow, MapRow, Part, in_id_order
from mrta_zoo.io.paths import as_spelt
from mrta_zoo.io.text_files import StrPath, count, number, read_text, shown, write_text
from mrta_zoo.map import map_origin_for
from mrta_zoo.scenario import QUANTITIES, Scenario
from mrta_zoo.wording import counted

_CASE_NAME = re.compile(r"r[0-9]+(a[0-9]+i[0-9]+)", re.IGNORECASE)
_TASK_LINE = "id x y workload deadline"
_AGENT_LINE = "id x y capacity"


def find_agent_file(task_path: StrPath) -> Path:
    """The agent file that belongs to a task file, by the layout of the published cases.

    For ``DIR/group1/r11a2i00.txt`` it is the first that exists of ``r11a2i00.txt`` and ``a2i00.txt`` in
    ``DIR/agent/``, then in ``DIR/group1/agent/``, in lower or upper case.

    Raises:
        ScenarioError: if none of them exists.
    """
    path = Path(task_path)
    names = [path.name]
    if case := _CASE_NAME.fullmatch(path.stem):
        names.append(case[1] + path.suffix)
    folders = (Path(os.path.normpath(path.parent / "..")) / "agent", path.parent / "agent")
    candidates = [folder / name for folder in folders for name in names]
    for candidate in candidates:
        there = as_spelt(as_spelt(candidate.parent) / candidate.name)
        if os.path.isfile(there):  # unlike Path.is_file it is also False without permission
            return there
    raise ScenarioError(
        f"{path}: there is no agent file; looked for {', '.join(map(str, candidates))}; name one with --agents"
    )


def read_task_part(path: StrPath) -> Part:
    """What a task file says.

    Raises:
        ScenarioError: if it is missing or malformed.
    """
    (first, header), *lines = _lines(path)
    if len(header) not in (3, 4):
        raise ScenarioError(
            f"{first}: header {shown(' '.join(header))} has {counted(len(header), 'field')}; "
            "expected 'm dx dy' or 'n m dx dy' (m tasks, n agents, map size)"
        )
    num_robots = count(header[0], first, "number of agents", ScenarioError) if len(header) == 4 else None
    num_tasks = count(header[-3], first, "number of tasks", ScenarioError)
    rows = []
    for where, fields in lines:
        hint = "; is this an agent file?" if len(fields) == 4 else ""
        _check_fields(where, fields, _TASK_LINE, hint)
        x, y = (
            number(text, where, what, -math.inf, ScenarioError) for text, what in zip(fields[1:3], "xy", strict=True)
        )
        workload = number(fields[3], where, "workload", 0, ScenarioError)
        deadline = number(fields[4], where, "deadline", 0, ScenarioError, strict=True)
        rows.append((fields[0], EntityRow(where, x, y, {"deadline": deadline, "workload": workload})))
    _check_count(path, first, num_tasks, len(rows), "task")
    return Part(
        path=str(path),
        tasks=in_id_order(rows, "task"),
        map=_map(first, header),
        name=Path(path).stem,
        num_robots=num_robots,
    )


def read_agent_part(path: StrPath) -> Part:
    """What an agent file says.

    Raises:
        ScenarioError: if it is missing or malformed.
    """
    (first, header), *lines = _lines(path)
    if len(header) != 3:
        hint = "; is this a task file?" if len(header) == 4 else ""
        raise ScenarioError(
            f"{first}: header {shown(' '.join(header))} has {counted(len(header), 'field')}; "
            f"expected 'n dx dy' (n agents, map size){hint}"
        )
    num_robots = count(header[0], first, "number of agents", ScenarioError)
    rows = []
    for where, fields in lines:
        hint = "; is this a task file?" if len(fields) == 5 else ""
        _check_fields(where, fields, _AGENT_LINE, hint)
        x, y = (
            number(text, where, what, -math.inf, ScenarioError) for text, what in zip(fields[1:3], "xy", strict=True)
        )
        capacity = number(fields[3], where, "capacity", 0, ScenarioError, strict=True)
        rows.append((fields[0], EntityRow(where, x, y, {"capacity": capacity})))
    _check_count(path, first, num_robots, len(rows), "agent")
    return Part(path=str(path), robots=in_id_order(rows, "agent"), map=_map(first, header), name=Path(path).stem)


def write_taptc(scenario: Scenario, task_path: StrPath, agent_path: StrPath) -> None:
    """Write a scenario exactly, as a task file and an agent file; its name is not kept, but read from the task file's.

    Raises:
        ScenarioError: if the format cannot express the scenario (a speed is not 1, a name holds blanks, names would be
            read as numbers, or the map begins where a reader would not expect it), or a file cannot be written.
    """
    for each in QUANTITIES:
        for index, value in enumerate(getattr(scenario, each.name).tolist()):
            if each.default not in (None, value):
                raise ScenarioError(
                    f"{task_path}: {each.who} {index} has {each.name} {value:g}; expected {each.default:g}, "
                    f"as TAPTC files hold no {each.name.removesuffix('s')}s (JSON and CSV do)"
                )
    places = np.concatenate((scenario.task_xy, scenario.robot_xy))
    if map_origin_for(places, scenario.map_size) != scenario.map_origin:
        x, y = scenario.map_origin
        raise ScenarioError(
            f"{task_path}: the map begins at {x:g}, {y:g}; expected one that begins at 0, 0 or at the least whole x "
            "and y of all places, as TAPTC files do not say where it lies (JSON and CSV do)"
        )
    task_ids = _ids(scenario.task_names, scenario.num_tasks, "task", task_path)
    robot_ids = _ids(scenario.robot_names, scenario.num_robots, "robot", task_path)
    side = " ".join(_text(value) for value in scenario.map_size)
    tasks = [f"{scenario.num_robots} {scenario.num_tasks} {side}"]
    for name, (x, y), workload, deadline in zip(
        task_ids, scenario.task_xy, scenario.workload, scenario.deadline, strict=True
    ):
        tasks.append(" ".join([name, *map(_text, (x, y, workload, deadline))]))
    agents = [f"{scenario.num_robots} {side}"]
    for name, (x, y), capacity in zip(robot_ids, scenario.robot_xy, scenario.capacity, strict=True):
        agents.append(" ".join([name, *map(_text, (x, y, capacity))]))
    write_text("\n".join(agents) + "\n", agent_path, ScenarioError)
    write_text("\n".join(tasks) + "\n", task_path, ScenarioError)


def _ids(names: tuple[str, ...], count: int, who: str, path: StrPath) -> list[str]:
    """The first fields of the lines of the tasks, or of the robots."""
    numbers = [str(index) for index in range(count)]
    if set(names) == set(numbers):
        raise ScenarioError(
            f"{path}: the names of the {who}s are the numbers 0 to {count - 1} in another order; expected other names, "
            "as TAPTC files would number them by these (JSON and CSV do not)"
        )
    for name in names:
        if name.split() != [name]:
            raise ScenarioError(
                f"{path}: a {who} is called {shown(name)}; expected a name without blanks, as TAPTC files cannot hold "
                "one (JSON and CSV do)"
            )
    return list(names) or numbers


def _lines(path: StrPath) -> list[tuple[str, list[str]]]:
    """The place and the fields of each line that is not blank; at least one line."""
    lines = enumerate(read_text(path, ScenarioError).split("\n"), start=1)
    return [(f"{path}, line {index}", fields) for index, line in lines if (fields := line.split())]


def _check_fields(where: str, fields: list[str], expected: str, hint: str) -> None:
    if len(fields) != len(expected.split()):
        raise ScenarioError(
            f"{where}: {shown(' '.join(fields))} has {counted(len(fields), 'field')}; "
            f"expected {len(expected.split())} ({expected}){hint}"
        )


def _check_count(path: StrPath, first: str, promised: int, found: int, what: str) -> None:
    if promised != found:
        raise ScenarioError(f"{first}: header says {promised} {what}s; expected {found}, the lines that follow")


def _map(first: str, header: list[str]) -> MapRow:
    width, height = (
        number(text, first, what, 0, ScenarioError, strict=True)
        for text, what in zip(header[-2:], ("map width", "map height"), strict=True)
    )
    return MapRow(first, width, height)


def _text(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return repr(float(value)).removesuffix(".0")
