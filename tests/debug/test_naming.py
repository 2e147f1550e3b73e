"""Stepping through a mission whose tasks and robots have names."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from factories import named_scenario
from rich.cells import cell_len
from stepping import scripted

from mrta_zoo import Scenario
from mrta_zoo.debug import Stepper
from mrta_zoo.debug.screen import header, prompt
from mrta_zoo.debug.session import Session
from mrta_zoo.debug.terminal import without_comment
from mrta_zoo.errors import ActionError, ConfigError

NAMED = named_scenario()


def session(*task_names: str) -> Session:
    return Session(Stepper(replace(NAMED, task_names=task_names or NAMED.task_names), "nearest"))


@pytest.mark.parametrize("line", ["pump #3 <b>", "take pump #3 <b>", "  take   pump #3 <b>  ", "1", "take 1"])
def test_a_task_is_taken_by_its_name_or_number(line: str) -> None:
    steps = session()
    said = "decision 0: Ann takes task pump #3 <b>, until 40.0 (the policy's choice: task valve-A)"
    assert steps.do(line) == said
    assert steps.stepper.trace().choices[0].task == 1


def test_names_that_are_numbers_are_names() -> None:
    steps = session("1", "2", "3", "4", "5")
    assert steps.do("2").startswith("decision 0: Ann takes task 2, until 40.0")
    assert steps.stepper.trace().choices[0].task == 1
    with pytest.raises(ConfigError, match=r"there is no task '0'; expected a name; the tasks are 1, 2, 3, 4, 5"):
        steps.do("take 0")
    with pytest.raises(ConfigError, match="there is no command '0'; expected a task's name, or one of"):
        steps.do("0")


def test_a_name_that_is_a_command() -> None:
    steps = session("b", "Back", "end", "e", "follow")
    for line, expected in (
        ("b", "'b' is a task and a command; expected take b for the task, or back for the command"),
        ("Back", "expected take Back for the task, or back for the command"),
        ("end", "expected take end for the task"),
    ):
        with pytest.raises(ConfigError, match=re.escape(expected)):
            steps.do(line)
    assert steps.do("take b").startswith("decision 0: Ann takes task b, until 15.0")
    assert steps.do("back") == "decision 0: Ann chooses at 0.0"
    assert steps.do("") == "decision 0: Ann takes task b, until 15.0"  # Enter is no name


def test_robots_by_name() -> None:
    steps = session()
    assert steps.do("j Bob & Co") == "decision 1: Bob & Co chooses at 0.0"
    steps.do("t Ann")
    assert steps.listing().title == "Ann may choose 1 of 5 tasks when it is next free"
    with pytest.raises(ConfigError, match=r"there is no robot 'Eve'; expected a name, or a number; .* Ann, Bob & Co"):
        steps.do("jump Eve")
    with pytest.raises(ActionError, match=r"^robot 1 \(Bob & Co\) may not choose task 3 \(弁\[red\]\) at time 0: too"):
        steps.do("take 弁[red]")


def test_what_is_shown() -> None:
    steps = session()
    output = scripted(steps, "show # as it stands\ntake pump #3 <b>  # by name\nlog\nrobots\nend")
    assert "Ann at (0.0, 0.0), capacity 1, speed 1, chooses; nearest advises valve-A" in output
    assert "next: Bob & Co at 0.0" in output
    rows = [line for line in output.splitlines() if line.startswith((">     0  valve-A ", "      3  弁[red] "))]
    assert [row.split() for row in rows] == [
        [">", "0", "valve-A", "10.0", "10.0", "15.0", "5.0", "20.0", "nobody", "else", "in", "time"],
        ["3", "弁[red]", "100.0", "100.0", "100.0", "-80.0", "20.0", "too", "late", "by", "80.0"],
    ]
    assert len({cell_len(row[: re.search(r"\d\.0 ", row).end()]) for row in rows}) == 1  # type: ignore[union-attr]
    assert "\n       0  0.0 Ann   pump…3 <b>   40.0  10.0 the policy's choice was task valve-A\n" in output
    assert re.search(r"\n    1 Bob & Co +\(100\.0, 0\.0\) .* chooses now\n", output)
    assert prompt(session()).startswith("Enter: valve-A, or name; ")


@pytest.mark.parametrize("line", ["1", "robot 1", "robot_1"])
def test_robots_by_number(line: str) -> None:
    for steps in (session(), Session(Stepper(replace(NAMED, robot_names=()), "nearest"))):
        assert steps.do(f"jump {line}").startswith("decision 1: ")
        assert steps.stepper.robot == 1
        steps.do(f"tasks {line}")
        assert steps.listing().title.endswith("when it is next free") == (steps.stepper.robot != 1)
    names = {"robot_names": ("robot_1", "robot 0")}
    steps = Session(Stepper(replace(NAMED, **names), "nearest"))
    assert steps.do("jump robot 0") == "decision 1: robot 0 chooses at 0.0"  # a name counts before a number


SITE = Scenario(
    task_xy=[[10.0 + 5 * index, 30.0] for index in range(12)],
    deadline=[150.0] * 11 + [5.0],
    workload=[10.0] * 12,
    robot_xy=[[100.0, 30.0], [0.0, 30.0], [0.0, 30.0]],
    capacity=[2.0, 1.0, 1.5],
    speed=[1.5, 1.0, 1.0],
    name="site",
    task_names=tuple(f"transformer station {index}" for index in range(12)),
    robot_names=("Spot", "Husky (the spare one)", "Ann"),
)


def test_reasons_are_read_at_80_columns() -> None:
    steps = Session(Stepper(SITE, "capam-plus"))
    output = scripted(steps, "show 12\nf 2\nshow 12")
    lines = output.splitlines()
    assert all(cell_len(line) <= 80 for line in lines)
    assert "site: 12 tasks, 3 robots, mask rule feasible" in lines
    assert any(
        re.match(r"Spot at \(100\.0, 30\.0\), capacity 2, .*chooses; capam-plus advises trans", line) for line in lines
    )
    tables = [line for line in lines if re.match(r"[* ]?[> ]? +\d+ trans", line)]
    assert len(tables) == 24
    reason = r"(could by|done by .* at|on it until|too late by) \d+\.\d$|nobody else in time$|deadline passed$"
    for line in tables:
        assert re.match(r"[*> ]+\d+ t\S*(…| )\S* *\d+( +-?[\d.]+){4,}", line), line
        assert re.search(reason, line), line
    assert any(re.search(r"Hus\S*\) could by", line) for line in tables)  # its ends tell a name from others


def test_a_narrow_header_leaves_out_what_can_be_spared() -> None:
    steps = Session(Stepper(SITE, "nearest"))
    for width, told in ((100, "capacity 2, speed 1.5, "), (76, "capacity 2, "), (64, "")):
        line = header(steps, width)[2].plain  # type: ignore[union-attr]
        assert line == f"Spot at (100.0, 30.0), {told}chooses; nearest advises transformer s…10", width
    assert header(steps, 50)[2].plain == "Spot chooses; nearest advises transformer s…10"  # type: ignore[union-attr]
    assert header(steps, 40)[3].plain == "next: Husky (t…re one) at 0.0, …"  # type: ignore[union-attr]


def test_long_names_leave_numbers_whole() -> None:
    long = session("valve " * 20, "w" * 90, "x" * 90, "y" * 90, "z" * 90)
    output = scripted(long, "show")
    assert all(cell_len(line) <= 80 for line in output.splitlines())
    assert re.search(r"\n>     0  valve.*….*  10\.0    10\.0    15\.0    5\.0  20\.0  nobody else in time\n", output)


@pytest.mark.parametrize(
    ("line", "command"),
    [("f # on", "f "), ("# pump", ""), ("take pump #3 <b> # it", "take pump #3 <b> "), ("f#", "f"), ("f", "f")],
)
def test_a_comment_begins_after_names(line: str, command: str) -> None:
    assert without_comment(line, NAMED.task_names) == command
