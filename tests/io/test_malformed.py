"""Malformed files: each is read, or refused in one sentence with file, place, value and what was expected.

Valid files are damaged in every field and at random; a handful of exact sentences, one for each decision, are examples.
"""

from __future__ import annotations

import copy
import json
import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sentences import check_sentence, names
from valid_files import AGENTS, PLAN, SCENARIO, TABLE, TASKS, TRACE

from mrta_zoo import Plan
from mrta_zoo.errors import MrtaError
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.io import read_cases, read_plan, read_scenario, read_trace, write_plan, write_scenario

FILES = {
    "cas.json": SCENARIO,
    "plan.json": PLAN,
    "trace.json": TRACE,
    "cas.csv": TABLE,
    "cas.txt": TASKS,
    "bots.txt": AGENTS,
    "bots.csv": "kind,x,y,capacity\nmap,100,50,\nrobot,1,1,1\nrobot,1,1,1\n",
}


def read(folder: Path, name: str, content: str | bytes) -> object:
    """What the file of this name holds; tasks and robots in files apart are read together."""
    if not (folder / "cas.txt").exists():
        (folder / "cas.txt").write_text(TASKS)
        (folder / "bots.txt").write_text(AGENTS)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    if name == "plan.json":
        return read_plan(folder / name)
    if name == "trace.json":
        return read_trace(folder / name)
    if name in ("cas.txt", "bots.txt", "bots.csv"):
        return read_scenario(folder / "cas.txt", folder / ("bots.csv" if name == "bots.csv" else "bots.txt"))
    return read_scenario(folder / name)


@pytest.mark.parametrize("name", FILES)
def test_the_files_are_valid_before(tmp_path: Path, name: str) -> None:
    assert read(tmp_path, name, FILES[name]) is not None


def nodes(value: Any, place: str = "") -> Iterator[tuple[str, Any, Any]]:
    """Every value in a document with its place, and what holds it."""
    for key in value if isinstance(value, dict) else range(len(value)):
        here = f"{place}[{key}]" if isinstance(value, list) else f"{place}.{key}".removeprefix(".")
        yield here, value, key
        if isinstance(value[key], (dict, list)):
            yield from nodes(value[key], here)


@pytest.mark.parametrize("name", ["cas.json", "plan.json", "trace.json"])
def test_damaged_fields_are_told_with_their_place(tmp_path: Path, name: str) -> None:
    document = json.loads(FILES[name])
    refused = 0
    for index, (place, _, _) in enumerate(nodes(document)):
        for wrong in (None, True, -1, 1.5, 1e300, "x\n", [], {}, [[[]]], {"x": 1}, "gone"):
            damaged = copy.deepcopy(document)
            _, holder, key = list(nodes(damaged))[index]
            if wrong == "gone":
                del holder[key]
            else:
                holder[key] = wrong
            try:
                read(tmp_path, name, json.dumps(damaged))
            except MrtaError as error:
                # What is legal by itself may not fit what the file says of the decisions.
                field = "decision" if "decision" in str(error) else place.split(".")[0].split("[")[0]
                check_sentence(error, f"{tmp_path / name}", field)
                refused += 1
    assert refused > 7 * index


@pytest.mark.parametrize(
    ("name", "separator"), [("cas.csv", ","), ("bots.csv", ","), ("cas.txt", " "), ("bots.txt", " ")]
)
def test_damaged_cells_are_told_with_their_line(tmp_path: Path, name: str, separator: str) -> None:
    lines = FILES[name].splitlines()
    for number, line in enumerate(lines, start=1):
        cells = line.split(separator)
        for index in range(len(cells)):
            for token in ("x1", "nan", "1e999", "1_0", "0x1", "٢٠", "9" * 400, "-1", "\x1b", '"', ""):
                changed = separator.join([*cells[:index], token, *cells[index + 1 :]])
                try:
                    read(tmp_path, name, "\n".join([*lines[: number - 1], changed, *lines[number:]]) + "\n")
                except MrtaError as error:
                    what = "" if token == '"' else f"line {number}:"  # an open quote ends with the file
                    check_sentence(error, f"{tmp_path / name}, line", what, "expected")
                else:
                    assert token in ("", '"', "-1") or name.endswith(".txt"), (line, token)


TOKENS = (
    b"nan", b"-1", b"1e999", b"0x1", b"1_0", b"", b"\xff", b"\0", b'"', b"[", b"}", b"null", b"\n", b",",
    b"9" * 400, b"0", b"true", b"-", b"1e-400", b"\xc2\xa0", b"\r", b"\x1c", b"9999999", b"{}", b" ",
)  # fmt: skip


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """The file with one to three small damages of the kinds that editors, disks and scripts do."""
    for _ in range(rng.integers(1, 4)):
        kind = rng.integers(6)
        first, last = sorted(int(place) for place in rng.integers(0, len(data) + 1, 2))
        last = min(last, first + 40) if kind != 0 else last
        if kind == 0:
            data = data[:first] if rng.random() < 0.2 else data[:last] + data[last + 3 :]
        elif kind == 1:
            data = data[:first] + data[last:]
        elif kind == 2:
            data = data[:last] + data[first:last] + data[last:]
        elif kind == 3:
            data = data[:first] + TOKENS[rng.integers(len(TOKENS))] + data[first:]
        elif kind == 4:
            data = data[:first] + rng.bytes(2) + data[first + 2 :]
        else:
            words = data.split(b" ")
            words[rng.integers(len(words))] = TOKENS[rng.integers(len(TOKENS))]
            data = b" ".join(words)
    return data


MUTATIONS = int(os.environ.get("MRTA_ZOO_MUTATIONS", "250"))


@pytest.mark.parametrize("kind", ["cas.txt", "agent/cas.txt", "cas.csv", "cas.json", "plan.json", "reference.csv"])
def test_damaged_files_are_read_or_refused(tmp_path: Path, kind: str) -> None:
    """Set MRTA_ZOO_MUTATIONS for more of them."""
    rng = np.random.default_rng(len(kind))
    scenario = TaptcGenerator(tasks=(8, 8), robots=(3, 3), integer=False)(rng, name="cas")
    readers: dict[str, Callable[[], object]] = {
        "cas.txt": lambda: read_scenario(tmp_path / "cas.txt"),
        "agent/cas.txt": lambda: read_scenario(tmp_path / "cas.txt"),
        "cas.csv": lambda: read_scenario(tmp_path / "cas.csv"),
        "cas.json": lambda: read_scenario(tmp_path / "cas.json"),
        "plan.json": lambda: read_plan(tmp_path / "plan.json"),
        "reference.csv": lambda: read_cases(tmp_path, [].append),
    }
    if kind == "plan.json":
        write_plan(Plan.of([[0, 5, 1], [], [7, 3]], "cas", "nearest"), tmp_path / kind)
    elif kind == "reference.csv":
        write_scenario(scenario, tmp_path / "cas.json")
        (tmp_path / kind).write_text("case,tasks,robots,nearest,pyvrp\ncas,8,3,5,6\nother,100,2,30,40\n")
    else:
        write_scenario(scenario, tmp_path / Path(kind).name)
    original = (tmp_path / kind).read_bytes()
    refused = 0
    for _ in range(MUTATIONS):
        (tmp_path / kind).write_bytes(mutated(original, rng))
        try:
            readers[kind]()
        except MrtaError as error:
            check_sentence(error, str(tmp_path))
            refused += 1
    assert refused > MUTATIONS / 3
    (tmp_path / kind).write_bytes(original)
    assert readers[kind]() is not None


def csv(*rows: str) -> str:
    """A table with ids and names; `rows` come before a robot."""
    return "\n".join(("id,name,kind,x,y,deadline,workload,capacity", *rows, ",,robot,1,1,,,1", ""))


SENTENCES: dict[str, list[tuple[str | bytes, str]]] = {
    "cas.json": [
        ("", "is empty; expected"),
        ("[1, 2]", "holds a list of 2; expected an object with format, version"),
        ("{}", "has no field 'format'; expected format 'mrta_zoo.scenario'"),
        (SCENARIO.replace('"version": 1', '"version": true'), "version is true; expected 1"),
        (SCENARIO.replace("255", "x255"), "line 6, column 34: expecting value at 'x255, "),
        (SCENARIO[:-1], "line 10, column 1: expecting ',' delimiter at the end of the line; expected JSON"),
        (SCENARIO.replace("255", "NaN"), "line 6: NaN is not a JSON number; expected a finite number"),
        (SCENARIO.replace("255", "1e999"), "line 6: '1e999' is too large; expected a finite number"),
        (SCENARIO.replace("255", "9" * 5000), "is too large; expected a finite number"),
        (SCENARIO.replace('4, "deadline"', '4, "y": 4, "deadline"'), "line 7: field 'y' appears twice in an object"),
        (SCENARIO.replace('"version": 1', '"version": 1, "name": "\\ud800"'), "name is '\\ud800'; expected text"),
        (SCENARIO.replace('{"width": 100, "height": 50}', "3"), "map is 3; expected an object or null"),
        (SCENARIO.replace('"y": 4', '"z": 4'), "tasks[1] has an unknown field 'z'; expected only x, y, deadline"),
        (SCENARIO.replace('"y": 4, ', ""), "tasks[1] has no field 'y'; expected x, y, deadline, workload"),
        (SCENARIO.replace("255", "[[[]]]"), "tasks[0].deadline is a list of 1; expected a number"),
        (SCENARIO.replace('"speed": 1', '"speed": 0'), "robots[0].speed is 0; expected a number > 0"),
        (SCENARIO.replace('"speed": 1', '"speed": 1e-13'), "robots[0]: speed is 1e-13; expected a number > 0, from"),
        (SCENARIO.replace('"height": 50', '"height": 5e12'), "map: height is 5000000000000.0; expected a number > 0"),
        (SCENARIO.replace('"height": 50', '"height": 50, "x": 0'), "map has only one of x and y; expected both"),
        (SCENARIO.replace('"y": 4', '"y": 50.5'), "tasks[1]: y is 50.5; expected a number from 0 to 50"),
        (SCENARIO[: SCENARIO.index(',\n  "robots"')] + "}", "has 0 robots; expected at least one"),
        ("[" * 100_000, "is nested too deeply; expected a mrta_zoo.scenario file"),
    ],
    "plan.json": [
        (SCENARIO, "format is 'mrta_zoo.scenario'; expected 'mrta_zoo.plan'"),
        (PLAN.replace("2]", "-2]"), "routes[0][1] is -2; expected a whole number >= 0"),
        (PLAN.replace("2]", "2.5]"), "routes[0][1] is 2.5; expected a whole number"),
        (PLAN.replace('"version": 1', '"version": 1, "schedule": [[{"task": 1}]]'), "schedule[0][0] has no field"),
        (PLAN.replace('"version": 1', '"version": 1, "route": []'), "has an unknown field 'route'; expected only"),
    ],
    "cas.csv": [
        (TABLE.replace("kind", "type"), "line 1: there is no column 'type'; expected kind, x, y"),
        (TABLE.replace(",", ";"), "line 1: cells are separated by semicolons; expected commas, and points in numbers"),
        (TABLE.replace(",", "\t"), "line 1: cells are separated by tabs; expected commas"),
        (TABLE.replace("deadline", "x"), "line 1: column 'x' appears twice; expected each column once"),
        ("kind,x\ntask,1\n", "line 1: column 'y' is missing; expected kind, x, y"),
        ("kind,x,y,capacity\nrobot,1,2,3\n", "has 0 tasks; expected at least one"),
        (TABLE.replace("task,3,4", "depot,3,4"), "line 4: kind is 'depot'; expected task, robot, map or origin"),
        (TABLE.replace("100,20,,", "100,20,,,7"), "line 4: 'task,3,4,100,20,,,7' has 8 cells; expected 7"),
        (TABLE.replace("100,20,,", "100,20,1,"), "line 4: capacity of a task is '1'; expected an empty cell"),
        (TABLE.replace("100,20,,", ",20,,"), "line 4: task has no deadline; expected a number in column deadline"),
        (TABLE.replace("100,20,,", "0,20,,"), "line 4: deadline is '0'; expected a finite number > 0"),
        (TABLE.replace("map,100", "map,0"), "line 2: x is '0'; expected a finite number > 0"),
        (TABLE.replace("task,3", "task,-103"), "line 4: x is -103.0; expected a number from 0 to 100"),
        (TABLE.replace("map,100,50,,,,\n", "").replace("3,4,", "3,4e12,"), "line 3: y is 4000000000000.0; expected"),
        (TABLE + "map,100,50,,,,\n", "line 6: a second map row, after line 2; expected at most one"),
        (TABLE.replace("map,100,50", "origin,0,0"), "line 2: an origin row without a map row; expected both"),
        (TABLE.replace("task,3", 'task,"3'), "line 5: unexpected end of data; expected cells"),
        (csv("1,,task,1,1,1,1,", "1,,task,1,1,1,1,"), "line 3: task id '1' was already used in line 2; expected each"),
        (csv(",,task,1,1,1,1,", "0,,task,1,1,1,1,"), "line 2: this task has no id; expected one for each task"),
        (csv("0,,map,1,1,,,"), "line 2: id of a map is '0'; expected an empty"),
        (csv(",a,task,1,1,1,1,", ",,task,1,1,1,1,"), "line 3: this task has no name; expected one for each task"),
        (csv(",a,task,1,1,1,1,", ",a,task,1,1,1,1,"), "line 3: task name 'a' was already used in line 2; expected"),
        (csv(",\x07,task,1,1,1,1,"), "line 2: the task's name is '\\x07'; expected text without control characters"),
        (b"kind,x,y\n\xff", "line 2: byte 0xff is not UTF-8; expected UTF-8 text"),
        (b"kind,x,y\n\0", "line 2: holds the byte 0x00, as binary files do; expected text"),
    ],
    "bots.csv": [
        (TABLE, "line 3: has a task; expected only robots in the agent file"),
        ("kind,x,y,capacity\nmap,100,51,\nrobot,1,1,1\nrobot,1,1,1\n", "line 2: map is 100 x 51; expected 100 x 50 as"),
        ("kind,x,y,capacity\nmap,100,50,\n", "has 0 robots; expected at least one"),
        ("kind,x,y,capacity\nrobot,1,1,1\n", "has 1 robot; expected 2, the number in line 1 of"),
        ("kind,x,y,capacity\nrobot,1,1,1\nrobot,1,51,1\n", "line 3: y is 51.0; expected a number from 0 to 50"),
    ],
    "cas.txt": [
        (" \n\t\n\r\n", "is empty; expected"),
        ("hello\n", "line 1: header 'hello' has 1 field; expected 'm dx dy' or 'n m dx dy'"),
        (TASKS.replace("2 3 100", "2 x 100"), "line 1: number of tasks is 'x'; expected a whole number"),
        (TASKS.replace("2 3 100", "2 999999999999 100"), "line 1: header says 999999999999 tasks; expected 3"),
        (TASKS.replace("100 50", "0 50"), "line 1: map width is '0'; expected a finite number > 0"),
        (TASKS.replace("1 3 4 20 100", "1 3 4 20"), "line 3: '1 3 4 20' has 4 fields; expected 5 (id x y workload"),
        (TASKS.replace("255", "NaN"), "line 2: deadline is 'NaN'; expected a finite number > 0"),
        (TASKS.replace("255", "1e300"), "line 2: deadline is 1e+300; expected a number > 0, from 1e-12 to 1e+12"),
        (TASKS.replace("3 4 20", "3 4 2e12"), "line 3: workload is 2000000000000.0; expected a number from 0 to 1e+12"),
        (TASKS.replace("2 5 6 20", "1 5 6 20"), "line 4: task id '1' was already used in line 3; expected each id"),
        (AGENTS, "has 4 fields; expected 5 (id x y workload deadline); is this an agent file?"),
        (TASKS.encode("utf-16"), "looks like UTF-16; expected UTF-8 text"),
        (TASKS.encode("utf-16-be"), "looks like UTF-16; expected UTF-8 text"),
    ],
    "bots.txt": [
        ("0 100 50\n", "has 0 robots; expected at least one"),
        (TASKS, "line 1: header '2 3 100 50' has 4 fields; expected 'n dx dy' (n agents, map size); is this a task"),
        (TASKS.removeprefix("2 "), "has 5 fields; expected 4 (id x y capacity); is this a task"),
        (AGENTS.replace("2 100", "3 100"), "line 1: header says 3 agents; expected 2, the lines that follow"),
        ("1 100 50\n0 9 10 2.0\n", "has 1 robot; expected 2, the number in line 1 of"),
        (AGENTS.replace("100 50", "50 50"), "line 1: map is 50 x 50; expected 100 x 50 as in"),
    ],
}  # fmt: skip
CASES = [(name, *case) for name, cases in SENTENCES.items() for case in cases]


@pytest.mark.parametrize(("name", "content", "message"), CASES, ids=names([case[1:] for case in CASES]))
def test_the_sentence(tmp_path: Path, name: str, content: str | bytes, message: str) -> None:
    with pytest.raises(MrtaError) as caught:
        read(tmp_path, name, content)
    check_sentence(caught.value, name, message, "expected")
