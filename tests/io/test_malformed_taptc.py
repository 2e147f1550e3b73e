"""Malformed TAPTC files: one sentence with file, line, value and what was expected."""

from pathlib import Path

import pytest
from sentences import check_sentence, names
from valid_files import AGENTS, TASKS

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io import read_scenario

BAD_TASKS = [
    ("", "is empty; expected"),
    (" \n\t\n\r\n", "is empty; expected"),
    ("hello\n", "line 1: header 'hello' has 1 field; expected 'm dx dy' or 'n m dx dy'"),
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
    (TASKS.replace("1 3 4 20", "1 three 4 20"), "line 3: x is 'three'; expected a finite number"),
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
        "line 4: task id '1' was already used in line 3; expected each id once",
    ),
    (TASKS.replace("2 5 6 20", "2 101 6 20"), "line 4: x is 101.0; expected a number from 0 to 100"),
    (TASKS.replace("2 5 6 20", "2 5 50.5 20"), "line 4: y is 50.5; expected a number from 0 to 50"),
    (TASKS.replace("2 5 6 20", "2 5 -45 20"), "line 4: y is -45.0; expected a number from 0 to 50"),
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
    ("1 100 50\n0 9 10 2.0\n", "has 1 robot; expected 2, the number in line 1 of"),
    (AGENTS.replace("100 50", "50 50"), "line 1: map is 50 x 50; expected 100 x 50 as in"),
    (AGENTS.replace("2.0", "0"), "line 2: capacity is '0'; expected a finite number > 0"),
    (AGENTS.replace("2.0", "2e-13"), "line 2: capacity is 2e-13; expected a number > 0, from 1e-12 to 1e+12"),
    (AGENTS.replace("2.0", "-2"), "line 2: capacity is '-2'; expected a finite number > 0"),
    (AGENTS.replace("2.0", "two"), "line 2: capacity is 'two'; expected a finite number > 0"),
    (AGENTS.replace(" 2.0", ""), "line 2: '0 9 10' has 3 fields; expected 4 (id x y capacity)"),
    (
        AGENTS.replace("1 7 8", "0 7 8"),
        "line 3: agent id '0' was already used in line 2; expected each id once",
    ),
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
