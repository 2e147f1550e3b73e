"""Whatever is wrong with a file, the error is one sentence: file, place, value and what was expected."""

import json
import os
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from mrta_zoo import Plan
from mrta_zoo.errors import MrtaError, PlanError, ScenarioError
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.io import read_cases, read_plan, read_scenario, write_plan, write_scenario

TASKS = "2 3 100 50\n0 1 2 20 255\n1 3 4 20 100\n2 5 6 20 30\n"
AGENTS = "2 100 50\n0 9 10 2.0\n1 7 8 1.0\n"


def check_sentence(error: MrtaError, *parts: str) -> None:
    message = str(error)
    for part in parts:
        assert part in message, f"{part!r} is not in {message!r}"
    assert "\n" not in message
    assert len(message) < 600
    assert error.__cause__ is None
    assert error.__suppress_context__ or error.__context__ is None  # no second traceback above it


def names(cases: Sequence[tuple[str | bytes, str]]) -> list[str]:
    return [message for _, message in cases]


BAD_TASKS = [
    ("", "is empty; expected"),
    (" \n\t\n\r\n", "is empty; expected"),
    ("hello\n", "line 1: header 'hello' has 1 fields; expected 'm dx dy' or 'n m dx dy'"),
    ("3 100\n", "line 1: header '3 100' has 2 fields; expected"),
    ("1 2 3 100 50\n", "line 1: header '1 2 3 100 50' has 5 fields; expected"),
    (TASKS.removeprefix("2 3 100 50\n"), "line 1: header '0 1 2 20 255' has 5 fields; expected"),
    (TASKS.replace("2 3 100", "2 x 100"), "line 1: number of tasks is 'x'; expected a whole number"),
    (TASKS.replace("2 3 100", "2.5 3 100"), "line 1: number of agents is '2.5'; expected a whole number"),
    (TASKS.replace("2 3 100", "2 -3 100"), "line 1: number of tasks is '-3'; expected a whole number"),
    (TASKS.replace("2 3 100", "2 " + "9" * 5000 + " 100"), "line 1: number of tasks is '999"),
    (TASKS.replace("2 3 100", "2 999999999999 100"), "line 1: header says 999999999999 tasks; expected 3"),
    (TASKS.replace("2 3 100", "2 2 100"), "line 1: header says 2 tasks; expected 3"),
    (TASKS.replace("2 3 100", "3 3 100"), "has 2 robots; expected 3, the number in line 1"),
    (TASKS.replace("100 50", "0 50"), "line 1: map width is '0'; expected a finite number > 0"),
    (TASKS.replace("100 50", "100 -50"), "line 1: map height is '-50'; expected a finite number > 0"),
    (TASKS.replace("100 50", "nan 50"), "line 1: map width is 'nan'; expected a finite number > 0"),
    (TASKS.replace("100 50", "100 51"), "line 1: map is 100 x 50; expected 100 x 51"),
    ("2 0 100 50\n", "has 0 tasks; expected at least one"),
    (
        TASKS.replace("1 3 4 20 100", "1 3 4 20"),
        "line 3: '1 3 4 20' has 4 fields; expected 5 (id x y workload",
    ),
    (TASKS.replace("1 3 4 20 100", "1 3 4 20 100 7"), "line 3: '1 3 4 20 100 7' has 6 fields; expected 5"),
    (TASKS[:-8], "line 4: '2 5' has 2 fields; expected 5"),
    (TASKS.replace("1 3 4 20", "1 three 4 20"), "line 3: x is 'three'; expected a finite number >= 0"),
    (TASKS.replace("1 3 4 20", "1 3 0x4 20"), "line 3: y is '0x4'; expected"),
    (TASKS.replace("1 3 4 20", "1 3 4 2_0"), "line 3: workload is '2_0'; expected a finite number >= 0"),
    (TASKS.replace("1 3 4 20", "1 3 4 -20"), "line 3: workload is '-20'; expected a finite number >= 0"),
    (TASKS.replace("1 3 4 20", "1 3 4 2,5"), "line 3: workload is '2,5'; expected"),
    (TASKS.replace("1 3 4 20", "1 3 4 ٢٠"), "line 3: workload is '٢٠'; expected"),
    (TASKS.replace("255", "NaN"), "line 2: deadline is 'NaN'; expected a finite number > 0"),
    (TASKS.replace("255", "inf"), "line 2: deadline is 'inf'; expected a finite number > 0"),
    (TASKS.replace("255", "-infinity"), "line 2: deadline is '-infinity'; expected a finite number > 0"),
    (TASKS.replace("255", "1e999"), "line 2: deadline is '1e999'; expected a finite number > 0"),
    (TASKS.replace("255", "1e300"), "line 2: deadline is 1e+300; expected a number > 0, from 1e-12 to 1e+12"),
    (TASKS.replace("255", "1e-300"), "line 2: deadline is 1e-300; expected a number > 0, from 1e-12 to 1e+12"),
    (TASKS.replace("3 4 20", "3 4 2e12"), "line 3: workload is 2000000000000.0; expected a number from 0 to 1e+12"),
    (TASKS.replace("100 50", "1e13 50"), "line 1: width is 10000000000000.0; expected a number > 0, from 1e-12"),
    (TASKS.replace("255", "0"), "line 2: deadline is '0'; expected a finite number > 0"),
    (TASKS.replace("255", "-255"), "line 2: deadline is '-255'; expected a finite number > 0"),
    (TASKS.replace("255", "9" * 1000), "line 2: deadline is '999"),
    (
        TASKS.replace("2 5 6 20", "1 5 6 20"),
        "line 4: task id 1 was already used in line 3; expected each id once",
    ),
    (TASKS.replace("2 5 6 20", "3 5 6 20"), "line 4: task id is 3; expected each of 0 to 2 once"),
    (TASKS.replace("2 5 6 20", "-2 5 6 20"), "line 4: task id is '-2'; expected a whole number"),
    (TASKS.replace("2 5 6 20", "2.0 5 6 20"), "line 4: task id is '2.0'; expected a whole number"),
    (TASKS.replace("2 5 6 20", "2 101 6 20"), "line 4: x is 101.0; expected a number from 0 to 100"),
    (TASKS.replace("2 5 6 20", "2 5 50.5 20"), "line 4: y is 50.5; expected a number from 0 to 50"),
    (TASKS.replace("2 5 6 20", "2 5 -1 20"), "line 4: y is '-1'; expected a finite number >= 0"),
    (
        AGENTS,
        "line 2: '0 9 10 2.0' has 4 fields; expected 5 (id x y workload deadline); is this an agent file?",
    ),
    (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "line 1: byte 0x89 is not UTF-8; expected UTF-8 text"),
    (b"2 3 100 50\n\0\0\0\0", "line 2: holds the byte 0x00, as binary files do; expected text"),
    (TASKS.encode("utf-16"), "looks like UTF-16; expected UTF-8 text"),
    (TASKS.encode("utf-16-le"), "looks like UTF-16; expected UTF-8 text"),
    (TASKS.encode("utf-16-be"), "looks like UTF-16; expected UTF-8 text"),
    (b"2 3 100 50\n0 1 2 20 255 \xe9t\xe9", "line 2: byte 0xe9 is not UTF-8; expected UTF-8 text"),
]


@pytest.mark.parametrize(("content", "message"), BAD_TASKS, ids=names(BAD_TASKS))
def test_bad_task_file(tmp_path: Path, content: str | bytes, message: str) -> None:
    task_file, agent_file = tmp_path / "cas.txt", tmp_path / "bots.txt"
    task_file.write_bytes(content if isinstance(content, bytes) else content.encode())
    agent_file.write_text(AGENTS)
    with pytest.raises(ScenarioError) as caught:
        read_scenario(task_file, agent_file)
    check_sentence(caught.value, "cas.txt", message, "expected")


BAD_AGENTS = [
    ("", "is empty; expected"),
    ("0 100 50\n", "has 0 robots; expected at least one"),
    (
        TASKS,
        "line 1: header '2 3 100 50' has 4 fields; expected 'n dx dy' (n agents, map size); is this a task",
    ),
    (
        TASKS.removeprefix("2 "),
        "line 2: '0 1 2 20 255' has 5 fields; expected 4 (id x y capacity); is this a task",
    ),
    (AGENTS.replace("2 100", "3 100"), "line 1: header says 3 agents; expected 2, the lines that follow"),
    ("1 100 50\n0 9 10 2.0\n", "has 1 robots; expected 2, the number in line 1 of"),
    (AGENTS.replace("100 50", "50 50"), "line 1: map is 50 x 50; expected 100 x 50 as in"),
    (AGENTS.replace("2.0", "0"), "line 2: capacity is '0'; expected a finite number > 0"),
    (AGENTS.replace("2.0", "2e-13"), "line 2: capacity is 2e-13; expected a number > 0, from 1e-12 to 1e+12"),
    (AGENTS.replace("2.0", "-2"), "line 2: capacity is '-2'; expected a finite number > 0"),
    (AGENTS.replace("2.0", "two"), "line 2: capacity is 'two'; expected a finite number > 0"),
    (AGENTS.replace(" 2.0", ""), "line 2: '0 9 10' has 3 fields; expected 4 (id x y capacity)"),
    (
        AGENTS.replace("1 7 8", "0 7 8"),
        "line 3: agent id 0 was already used in line 2; expected each id once",
    ),
    (AGENTS.replace("1 7 8", "2 7 8"), "line 3: agent id is 2; expected each of 0 to 1 once"),
    (AGENTS.replace("1 7 8", "1 700 8"), "line 3: x is 700.0; expected a number from 0 to 100"),
]


@pytest.mark.parametrize(("content", "message"), BAD_AGENTS, ids=names(BAD_AGENTS))
def test_bad_agent_file(tmp_path: Path, content: str, message: str) -> None:
    task_file, agent_file = tmp_path / "cas.txt", tmp_path / "bots.txt"
    task_file.write_text(TASKS)
    agent_file.write_text(content)
    with pytest.raises(ScenarioError) as caught:
        read_scenario(task_file, agent_file)
    check_sentence(caught.value, "bots.txt", message, "expected")


SCENARIO = """{
  "format": "mrta_zoo.scenario",
  "version": 1,
  "map": {"width": 100, "height": 50},
  "tasks": [
    {"x": 1, "y": 2, "deadline": 255, "workload": 20},
    {"x": 3, "y": 4, "deadline": 100, "workload": 20}
  ],
  "robots": [{"x": 5, "y": 6, "capacity": 1, "speed": 1}]
}"""
BAD_JSON = [
    ("", "is empty; expected"),
    ("{}", "has no field 'format'; expected format 'mrta_zoo.scenario'"),
    ("[1, 2]", "holds a list of 2; expected an object with format, version"),
    ("3", "holds 3; expected an object"),
    (TASKS, "line 1, column 3: extra data at '3 100 50'; expected JSON"),
    (SCENARIO[:-1], "line 10, column 1: expecting ',' delimiter at the end of the line; expected JSON"),
    (SCENARIO.replace("20}\n", "20},\n"), "; expected JSON"),  # the place depends on the version of Python
    (SCENARIO.replace("255", "x255"), "line 6, column 34: expecting value at 'x255, "),
    (SCENARIO.replace("255", "0xFF"), "line 6, column 35: expecting ',' delimiter at 'xFF, "),
    (SCENARIO.replace("255", "2_5"), "line 6, column 35: expecting ',' delimiter at '_5, "),
    (SCENARIO.replace("255", "NaN"), "line 6: NaN is no JSON number; expected a finite number"),
    (SCENARIO.replace("255", "-Infinity"), "line 6: -Infinity is no JSON number; expected a finite number"),
    (SCENARIO.replace("255", "1e999"), "line 6: '1e999' is too large; expected a finite number"),
    (SCENARIO.replace("255", "9" * 5000), "is too large; expected a finite number"),
    (SCENARIO.replace('4, "deadline"', '4, "y": 4, "deadline"'), "field 'y' appears twice in an object"),
    (SCENARIO.replace("mrta_zoo.scenario", "mrta_zoo.plan"), "format is 'mrta_zoo.plan'; expected"),
    (SCENARIO.replace('"mrta_zoo.scenario"', "[]"), "format is a list of 0; expected 'mrta_zoo.scenario'"),
    (SCENARIO.replace('"version": 1', '"version": 2'), "version is 2; expected 1"),
    (SCENARIO.replace('"version": 1', '"version": true'), "version is true; expected 1"),
    (SCENARIO.replace('"version": 1', '"version": "1"'), "version is '1'; expected 1"),
    (SCENARIO.replace('"version": 1,', ""), "has no field 'version'; expected version 1"),
    (SCENARIO.replace('"version": 1', '"version": 1, "depot": 3'), "has an unknown field 'depot'; expected"),
    (SCENARIO.replace('"version": 1', '"version": 1, "name": 3'), "name is 3; expected text"),
    (SCENARIO.replace('"version": 1', '"version": 1, "name": "\\ud800"'), "name is '\\ud800'; expected text"),
    (SCENARIO.replace('"height": 50', '"height": 0'), "map.height is 0; expected a number > 0"),
    (SCENARIO.replace('"height": 50', '"height": "50"'), "map.height is '50'; expected a number"),
    (SCENARIO.replace(', "height": 50', ""), "map has no field 'height'; expected width, height"),
    (SCENARIO.replace('{"width": 100, "height": 50}', "null"), "map is null; expected an object"),
    (SCENARIO.replace("255", '"255"'), "tasks[0].deadline is '255'; expected a number"),
    (SCENARIO.replace("255", "true"), "tasks[0].deadline is true; expected a number"),
    (SCENARIO.replace("255", "null"), "tasks[0].deadline is null; expected a number"),
    (SCENARIO.replace("255", "1e300"), "tasks[0]: deadline is 1e+300; expected a number > 0, from 1e-12 to 1e+12"),
    (SCENARIO.replace('"speed": 1', '"speed": 1e-13'), "robots[0]: speed is 1e-13; expected a number > 0, from"),
    (SCENARIO.replace('"height": 50', '"height": 5e12'), "map: height is 5000000000000.0; expected a number > 0, from"),
    (SCENARIO.replace('"version": 1', '"version": 1, "name": "\\u001b[31m"'), "name is '\\x1b[31m'; expected text"),
    (SCENARIO.replace("255", "0"), "tasks[0].deadline is 0; expected a number > 0"),
    (SCENARIO.replace("255", "[[[]]]"), "tasks[0].deadline is a list of 1; expected a number"),
    (SCENARIO.replace('"y": 4', '"y": 50.5'), "tasks[1]: y is 50.5; expected a number from 0 to 50"),
    (SCENARIO.replace('"y": 4', '"y": -4'), "tasks[1].y is -4; expected a number >= 0"),
    (SCENARIO.replace('"y": 4', '"z": 4'), "tasks[1] has an unknown field 'z'; expected only x, y, deadline"),
    (SCENARIO.replace('"y": 4, ', ""), "tasks[1] has no field 'y'; expected x, y, deadline, workload"),
    (SCENARIO.replace('"capacity": 1', '"capacity": -1'), "robots[0].capacity is -1; expected a number > 0"),
    (SCENARIO.replace('"speed": 1', '"speed": 0'), "robots[0].speed is 0; expected a number > 0"),
    (SCENARIO.replace('"robots": [{', '"robots": [7, {'), "robots[0] is 7; expected an object"),
    (SCENARIO.replace('"robots"', '"tasks"'), "field 'tasks' appears twice in an object; expected it once"),
    (SCENARIO[: SCENARIO.index(',\n  "robots"')] + "}", "has 0 robots; expected at least one"),
    ("[" * 100_000, "is nested too deeply; expected a mrta_zoo.scenario file"),
    ('{"format":' * 100_000, "is nested too deeply; expected a mrta_zoo.scenario file"),
    (SCENARIO.encode("utf-16"), "looks like UTF-16; expected UTF-8 text"),
    (b'{"\xff": 1}', "line 1: byte 0xff is not UTF-8; expected UTF-8 text"),
]  # fmt: skip


@pytest.mark.parametrize(("content", "message"), BAD_JSON, ids=names(BAD_JSON))
def test_bad_json(tmp_path: Path, content: str | bytes, message: str) -> None:
    path = tmp_path / "cas.json"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ScenarioError) as caught:
        read_scenario(path)
    check_sentence(caught.value, "cas.json", message, "expected")


TABLE = """kind,x,y,deadline,workload,capacity,speed
map,100,50,,,,
task,1,2,255,20,,
task,3,4,100,20,,
robot,5,6,,,2,1
"""
BAD_CSV = [
    ("", "is empty; expected"),
    (TABLE.replace("kind", "type"), "line 1: there is no column 'type'; expected kind, x, y"),
    (
        TABLE.replace(",", ";"),
        "line 1: there is no column 'kind;x;y;deadline;workload;",
    ),
    (TABLE.replace("deadline", "x"), "line 1: column 'x' appears twice; expected each column once"),
    ("kind,x\ntask,1\n", "line 1: column 'y' is missing; expected kind, x, y"),
    (TABLE.removeprefix("kind,x,y,deadline,workload,capacity,speed\n"), "line 1: there is no column 'map'"),
    ("kind,x,y,deadline,workload\ntask,1,2,3,4\n", "has 0 robots; expected at least one"),
    ("kind,x,y,capacity\nrobot,1,2,3\n", "has 0 tasks; expected at least one"),
    ("kind,x,y,capacity\ntask,1,2,3\n", "line 2: capacity of a task is '3'; expected an empty cell"),
    ("kind,x,y,capacity\ntask,1,2,\n", "line 2: task has no workload; expected a number in column workload"),
    (TABLE.replace("task,3,4", "depot,3,4"), "line 4: kind is 'depot'; expected task, robot or map"),
    (
        TABLE.replace("100,20,,", "100,20,"),
        "line 4: 'task,3,4,100,20,' has 6 cells; expected 7 as in the header",
    ),
    (TABLE.replace("100,20,,", "100,20,,,"), "line 4: 'task,3,4,100,20,,,' has 8 cells; expected 7"),
    (TABLE.replace("100,20,,", "100,20,1,"), "line 4: capacity of a task is '1'; expected an empty cell"),
    (TABLE.replace("5,6,,,2", "5,6,30,,2"), "line 5: deadline of a robot is '30'; expected an empty cell"),
    (TABLE.replace("100,50,,", "100,50,7,"), "line 2: deadline of a map is '7'; expected an empty cell"),
    (
        TABLE.replace("100,20,,", ",20,,"),
        "line 4: task has no deadline; expected a number in column deadline",
    ),
    (TABLE.replace("100,20,,", "0,20,,"), "line 4: deadline is '0'; expected a finite number > 0"),
    (TABLE.replace("100,20,,", "NaN,20,,"), "line 4: deadline is 'NaN'; expected a finite number > 0"),
    (TABLE.replace("100,20,,", "1_0,20,,"), "line 4: deadline is '1_0'; expected a finite number > 0"),
    (TABLE.replace("100,20,,", "100,-1,,"), "line 4: workload is '-1'; expected a finite number >= 0"),
    (TABLE.replace("task,3", "task,300"), "line 4: x is 300.0; expected a number from 0 to 100"),
    (TABLE.replace("task,3", "task,-3"), "line 4: x is '-3'; expected a finite number >= 0"),
    (TABLE.replace("2,1\n", "0,1\n"), "line 5: capacity is '0'; expected a finite number > 0"),
    (TABLE.replace("2,1\n", ",1\n"), "line 5: robot has no capacity; expected a number in column capacity"),
    (TABLE.replace("2,1\n", "2,0\n"), "line 5: speed is '0'; expected a finite number > 0"),
    (TABLE.replace("map,100", "map,0"), "line 2: x is '0'; expected a finite number > 0"),
    (TABLE + "map,100,50,,,,\n", "line 6: a second map row, after line 2; expected at most one"),
    (TABLE.replace("task,3", 'task,"3'), "line 5: unexpected end of data; expected cells"),
    (TABLE.replace("task,3", 'task,"3"3'), "line 4: ',' expected after '\"'; expected cells"),
    (
        TABLE.replace("task,3", "task," + "3" * 200_000),
        "line 4: field larger than field limit (131072); expected",
    ),
    (
        "id,kind,x,y,deadline,workload,capacity\n1,task,1,1,1,1,\n0,robot,1,1,,,1\n",
        "line 2: task id is 1; expected",
    ),
    (
        "id,kind,x,y,deadline,workload,capacity\n,task,1,1,1,1,\n0,robot,1,1,,,1\n",
        "line 2: task id is ''; expected",
    ),
    (
        "id,kind,x,y,deadline,workload,capacity\n0,map,1,1,,,\n",
        "line 2: id of a map is '0'; expected an empty",
    ),
    (b"kind,x,y\n\xff", "line 2: byte 0xff is not UTF-8; expected UTF-8 text"),
    (b"kind,x,y\n\0", "line 2: holds the byte 0x00, as binary files do; expected text"),
]


@pytest.mark.parametrize(("content", "message"), BAD_CSV, ids=names(BAD_CSV))
def test_bad_csv(tmp_path: Path, content: str | bytes, message: str) -> None:
    path = tmp_path / "cas.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ScenarioError) as caught:
        read_scenario(path)
    check_sentence(caught.value, "cas.csv", message, "expected")


BAD_AGENT_TABLES = [
    (TABLE, "line 3: has a task; expected only robots in the agent file"),
    (
        "kind,x,y,capacity\nmap,100,51,\nrobot,1,1,1\nrobot,1,1,1\n",
        "line 2: map is 100 x 51; expected 100 x 50 as in",
    ),
    ("kind,x,y,capacity\nmap,100,50,\n", "has 0 robots; expected at least one"),
    ("kind,x,y,capacity\nrobot,1,1,1\n", "has 1 robots; expected 2, the number in line 1 of"),
    ("kind,x,y,capacity\nrobot,1,1,1\nrobot,1,51,1\n", "line 3: y is 51.0; expected a number from 0 to 50"),
]


@pytest.mark.parametrize(("content", "message"), BAD_AGENT_TABLES, ids=names(BAD_AGENT_TABLES))
def test_bad_agent_table(tmp_path: Path, content: str, message: str) -> None:
    (tmp_path / "cas.txt").write_text(TASKS)
    (tmp_path / "bots.csv").write_text(content)
    with pytest.raises(ScenarioError) as caught:
        read_scenario(tmp_path / "cas.txt", tmp_path / "bots.csv")
    check_sentence(caught.value, "bots.csv", message, "expected")


def test_agents_cannot_be_json(tmp_path: Path) -> None:
    (tmp_path / "cas.txt").write_text(TASKS)
    with pytest.raises(ScenarioError, match=r"bots\.json has the suffix '\.json'; expected a \.csv or TAPTC agent"):
        read_scenario(tmp_path / "cas.txt", tmp_path / "bots.json")


PLAN = '{\n  "format": "mrta_zoo.plan",\n  "version": 1,\n  "routes": [[0, 2], [1]]\n}'
BAD_PLANS = [
    ("", "is empty; expected"),
    (SCENARIO, "format is 'mrta_zoo.scenario'; expected 'mrta_zoo.plan'"),
    (PLAN.replace("[[0, 2], [1]]", "7"), "routes is 7; expected a list"),
    (PLAN.replace("[1]", "1"), "routes[1] is 1; expected a list"),
    (PLAN.replace("2]", "-2]"), "routes[0][1] is -2; expected a whole number >= 0"),
    (PLAN.replace("2]", "2.5]"), "routes[0][1] is 2.5; expected a whole number"),
    (PLAN.replace("2]", '"2"]'), "routes[0][1] is '2'; expected a whole number"),
    (PLAN.replace("2]", "true]"), "routes[0][1] is true; expected a whole number"),
    (PLAN.replace("2]", "2"), "line 5, column 1: expecting ',' delimiter at '}'; expected JSON"),
    (PLAN.replace('"version": 1', '"version": 1, "score": {}'), "score has no field 'completed'; expected"),
    (
        PLAN.replace('"version": 1', '"version": 1, "schedule": [[{"task": 1}]]'),
        "schedule[0][0] has no field",
    ),
    (
        PLAN.replace('"version": 1', '"version": 1, "route": []'),
        "has an unknown field 'route'; expected only",
    ),
]


@pytest.mark.parametrize(("content", "message"), BAD_PLANS, ids=names(BAD_PLANS))
def test_bad_plan(tmp_path: Path, content: str, message: str) -> None:
    path = tmp_path / "plan.json"
    path.write_text(content)
    with pytest.raises(PlanError) as caught:
        read_plan(path)
    check_sentence(caught.value, "plan.json", message, "expected")


@pytest.mark.parametrize("suffix", [".txt", ".json", ".csv"])
def test_file_that_cannot_be_read(tmp_path: Path, suffix: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        read_scenario(tmp_path / f"missing{suffix}", tmp_path / "agents.txt")
    check_sentence(caught.value, f"missing{suffix}: there is no such file")
    (tmp_path / f"folder{suffix}").mkdir()
    with pytest.raises(ScenarioError) as caught:
        read_scenario(tmp_path / f"folder{suffix}")
    check_sentence(caught.value, f"folder{suffix} is a folder; expected a file")
    with pytest.raises(ScenarioError) as caught:
        read_scenario(f"nul\0l{suffix}")
    check_sentence(caught.value, f"nul\\0l{suffix} cannot be read")
    with pytest.raises(ScenarioError) as caught:
        read_scenario("x" * 300 + suffix)
    assert "cannot be read" in str(caught.value)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_no_permission(tmp_path: Path) -> None:
    path = tmp_path / "cas.json"
    path.write_text(SCENARIO)
    path.chmod(0)
    with pytest.raises(ScenarioError) as caught:
        read_scenario(path)
    check_sentence(caught.value, "cas.json: no permission")


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no endless file here")
def test_endless_file() -> None:
    with pytest.raises(ScenarioError) as caught:
        read_scenario("/dev/zero")
    check_sentence(caught.value, "/dev/zero is larger than 64 MiB")


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
        "reference.csv": lambda: read_cases(tmp_path),
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
            check_sentence(error)
            refused += 1
    assert refused > MUTATIONS / 3
    (tmp_path / kind).write_bytes(original)
    assert readers[kind]() is not None


def test_scenario_fixture_is_valid(tmp_path: Path) -> None:
    """The malformed inputs above are one change away from files that can be read."""
    for name, content in (
        ("cas.txt", TASKS),
        ("cas.json", SCENARIO),
        ("cas.csv", TABLE),
        ("plan.json", PLAN),
    ):
        (tmp_path / name).write_text(content)
    (tmp_path / "bots.txt").write_text(AGENTS)
    assert read_scenario(tmp_path / "cas.txt", tmp_path / "bots.txt").num_tasks == 3
    assert read_scenario(tmp_path / "cas.json").num_tasks == 2
    assert read_scenario(tmp_path / "cas.csv").num_tasks == 2
    assert read_plan(tmp_path / "plan.json").routes == ((0, 2), (1,))
    assert json.loads(SCENARIO)["version"] == 1


def test_a_table_without_a_map_cannot_have_far_places(tmp_path: Path) -> None:
    path = tmp_path / "cas.csv"
    path.write_text(TABLE.replace("map,100,50,,,,\n", "").replace("task,3,4", "task,3,4e12"))
    with pytest.raises(ScenarioError, match=r"cas\.csv, line 3: y is 4000000000000\.0; expected a number from 0 to 1e"):
        read_scenario(path)


def test_names_with_control_characters(tmp_path: Path) -> None:
    (tmp_path / "a\x1bb.csv").write_text(TABLE)
    with pytest.raises(ScenarioError, match=r"the scenario's name is 'a\\x1bb'; expected text without control"):
        read_scenario(tmp_path / "a\x1bb.csv")
    (tmp_path / "a\x1bb.csv").rename(tmp_path / "cas.csv")
    reference = tmp_path / "reference.csv"
    for text in ("case,tasks,robots,me\x1b\ncas,2,1,1\n", "case,tasks,robots,me\ncas\x1b,2,1,1\n"):
        reference.write_text(text)
        with pytest.raises(ScenarioError, match=r"reference\.csv, line .*\\x1b'; expected text without control"):
            read_cases(tmp_path)
    with pytest.raises(PlanError, match="method is 'a\\\\tb'; expected text without control characters"):
        write_plan(Plan.of([[0]], "cas", "a\tb"), tmp_path / "plan.json")
