"""Malformed CSV tables: one sentence with file, line, value and what was expected."""

from pathlib import Path

import pytest
from sentences import check_sentence, names
from valid_files import TABLE, TASKS

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io import read_scenario

BAD_CSV = [
    ("", "is empty; expected"),
    (TABLE.replace("kind", "type"), "line 1: there is no column 'type'; expected kind, x, y"),
    (
        TABLE.replace(",", ";"),
        "line 1: cells are separated by semicolons; expected commas, and points in numbers (1.5)",
    ),
    (
        TABLE.replace("\n", ";\n").replace(",", ";").replace("20", "20,5"),
        "line 1: cells are separated by semicolons; expected commas, and points in numbers (1.5)",
    ),
    (TABLE.replace(",", "\t"), "line 1: cells are separated by tabs; expected commas"),
    (TABLE.replace("\n", ",\n").replace("100,20,,,", "100,20,,,7"), "line 1: there is no column ''; expected kind"),
    (TABLE.replace("deadline", "x"), "line 1: column 'x' appears twice; expected each column once"),
    ("kind,x\ntask,1\n", "line 1: column 'y' is missing; expected kind, x, y"),
    (TABLE.removeprefix("kind,x,y,deadline,workload,capacity,speed\n"), "line 1: there is no column 'map'"),
    ("kind,x,y,deadline,workload\ntask,1,2,3,4\n", "has 0 robots; expected at least one"),
    ("kind,x,y,capacity\nrobot,1,2,3\n", "has 0 tasks; expected at least one"),
    ("kind,x,y,capacity\ntask,1,2,3\n", "line 2: capacity of a task is '3'; expected an empty cell"),
    ("kind,x,y,capacity\ntask,1,2,\n", "line 2: task has no deadline; expected a number in column deadline"),
    (TABLE.replace("task,3,4", "depot,3,4"), "line 4: kind is 'depot'; expected task, robot, map or origin"),
    (
        TABLE.replace("100,20,,", "100,20,"),
        "line 4: 'task,3,4,100,20,' has 6 cells; expected 7 as in the header",
    ),
    (TABLE.replace("100,20,,", "100,20,,,7"), "line 4: 'task,3,4,100,20,,,7' has 8 cells; expected 7"),
    (
        ",kind,x,y,deadline,workload,capacity\n,task,1,1,1,1,\n7,robot,1,1,,,1\n",
        "line 1: there is no column ''; expected kind",
    ),
    (
        "kind,x,y,,deadline,workload,capacity\ntask,1,1,7,1,1,\nrobot,1,1,,,,1\n",
        "line 1: there is no column ''; expected kind",
    ),
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
    (TABLE.replace("task,3", "task,-103"), "line 4: x is -103.0; expected a number from 0 to 100"),
    (TABLE.replace("task,3", "task,three"), "line 4: x is 'three'; expected a finite number"),
    (TABLE + "origin,-1,-1,,,,\norigin,-1,-1,,,,\n", "line 7: a second origin row, after line 6; expected at most one"),
    (TABLE.replace("map,100,50", "origin,0,0"), "line 2: an origin row without a map row; expected both"),
    (TABLE + "origin,2,0,,,,\n", "line 3: x is 1.0; expected a number from 2 to 102"),
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
        "id,kind,x,y,deadline,workload,capacity\n1,task,1,1,1,1,\n1,task,1,1,1,1,\n0,robot,1,1,,,1\n",
        "line 3: task id '1' was already used in line 2; expected each id once",
    ),
    (
        "id,kind,x,y,deadline,workload,capacity\n,task,1,1,1,1,\n0,task,1,1,1,1,\n0,robot,1,1,,,1\n",
        "line 2: this task has no id; expected one for each task",
    ),
    (
        "id,kind,x,y,deadline,workload,capacity\n0,map,1,1,,,\n",
        "line 2: id of a map is '0'; expected an empty",
    ),
    (
        "name,kind,x,y,deadline,workload,capacity\npump,task,1,1,1,1,\n,task,1,1,1,1,\n,robot,1,1,,,1\n",
        "line 3: this task has no name; expected one for each task",
    ),
    (
        "name,kind,x,y,deadline,workload,capacity\npump,task,1,1,1,1,\npump,task,1,1,1,1,\n,robot,1,1,,,1\n",
        "line 3: task name 'pump' was already used in line 2; expected each name once",
    ),
    (
        "name,kind,x,y,deadline,workload,capacity\npu\x07mp,task,1,1,1,1,\n,robot,1,1,,,1\n",
        "line 2: the task's name is 'pu\\x07mp'; expected text without control characters",
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
    ("kind,x,y,capacity\nrobot,1,1,1\n", "has 1 robot; expected 2, the number in line 1 of"),
    ("kind,x,y,capacity\nrobot,1,1,1\nrobot,1,51,1\n", "line 3: y is 51.0; expected a number from 0 to 50"),
]


@pytest.mark.parametrize(("content", "message"), BAD_AGENT_TABLES, ids=names(BAD_AGENT_TABLES))
def test_bad_agent_table(tmp_path: Path, content: str, message: str) -> None:
    (tmp_path / "cas.txt").write_text(TASKS)
    (tmp_path / "bots.csv").write_text(content)
    with pytest.raises(ScenarioError) as caught:
        read_scenario(tmp_path / "cas.txt", tmp_path / "bots.csv")
    check_sentence(caught.value, "bots.csv", message, "expected")


def test_a_table_without_a_map_cannot_have_far_places(tmp_path: Path) -> None:
    path = tmp_path / "cas.csv"
    path.write_text(TABLE.replace("map,100,50,,,,\n", "").replace("task,3,4", "task,3,4e12"))
    with pytest.raises(
        ScenarioError, match=r"cas\.csv, line 3: y is 4000000000000\.0; expected a number from -1e\+12 to 1e"
    ):
        read_scenario(path)
