"""Commands, screens and scripts of the stepper."""

from __future__ import annotations

import io
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from factories import small_scenario
from rich.console import Console
from stepping import scripted

from mrta_zoo.debug import Stepper, make_advisor
from mrta_zoo.debug.screen import AROUND, prompt, screen
from mrta_zoo.debug.session import SESSION_COMMANDS, Session
from mrta_zoo.debug.terminal import interact
from mrta_zoo.errors import ActionError, ConfigError, MrtaError
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.io import read_trace
from mrta_zoo.plan import Plan

SCENARIO = small_scenario(2, tasks=12, robots=3)


def session(method: str | None = "nearest") -> Session:
    return Session(Stepper(SCENARIO, method))


def lines_of(what: object, width: int) -> list[str]:
    console = Console(file=io.StringIO(), width=width, markup=False, highlight=False, emoji=False)
    with console.capture() as captured:
        console.print(what)
    return captured.get().split("\n")[:-1]


def test_commands_say_what_came_of_them() -> None:
    steps = session()
    stepper = steps.stepper
    advised = stepper.advice
    assert advised is not None
    other = next(p.task for p in stepper.outlook() if p.task != advised.task)
    finish = stepper.mission.finish_if[0, other]
    assert steps.do(f" {other} ") == (
        f"decision 0: robot 0 takes task {other}, until {finish:.1f} (the policy's choice: task {advised.task})"
    )
    assert steps.do("B") == "decision 0: robot 0 chooses at 0.0"
    assert steps.do("stay").startswith("decision 0: robot 0 stays for good (the policy's choice: task ")
    assert steps.do("g 0") == "decision 0: robot 0 chooses at 0.0"
    assert steps.do("j 2") == "decision 2: robot 2 chooses at 0.0"
    assert steps.do("end").startswith("the mission is over: completed ")
    assert (steps.do("q"), steps.over) == ("", True)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("hop", "there is no command 'hop'; expected a number of a task, or one of follow, take, "),
        ("take", "the command is 'take'; expected take TASK"),
        ("take x", "task is 'x'; expected a whole number >= 0"),
        ("take ²", "task is '²'; expected"),
        ("back -1", "decisions is '-1'; expected a whole number >= 0"),
        ("back 1 2", "the command is 'back 1 2'; expected back [n]"),
        ("3 4", "there is no command '3'"),
        ("99", "robot 0 chose task 99; tasks are numbered 0 to 11"),
        ("jump 3", "there is no robot 3"),
        ("tasks 3", "there is no robot 3"),
        ("sort name", "there is no order 'name'; expected one of rank, "),
        ("save", "there is no file to save to yet; expected save FILE"),
        ("load nowhere.json", "nowhere.json: there is no such file"),
        ("end now", "the command is 'end now'; expected end"),
    ],
)
def test_bad_commands(line: str, message: str) -> None:
    steps = session()
    with pytest.raises(MrtaError, match=re.escape(message)) as caught:
        steps.do(line)
    assert "\n" not in str(caught.value)
    assert (steps.stepper.position, steps.unsaved, steps.over) == (0, 0, False)
    with pytest.raises(type(caught.value), match=r"^script\.txt, line 3: "):
        scripted(session(), f"# first\n\n{line}\nend")


def test_every_command_is_explained() -> None:
    steps = session()
    steps.do("?")
    assert [row.cells[0] for row in steps.listing().rows] == [command.usage for command in SESSION_COMMANDS]
    assert len({command.short for command in SESSION_COMMANDS if command.short}) == sum(
        bool(c.short) for c in SESSION_COMMANDS
    )


@pytest.mark.parametrize(
    ("tasks", "robots", "sizes"), [(4, 1, [(80, 24), (120, 50)]), (100, 7, [(80, 24)]), (1000, 70, [(80, 260)])]
)
def test_a_screen_fits_and_pages_show_all(tasks: int, robots: int, sizes: list[tuple[int, int]]) -> None:
    scenario = TaptcGenerator(tasks=(tasks, tasks), robots=(robots, robots))(np.random.default_rng(1))
    steps = Session(Stepper(scenario, "nearest"))
    for width, height in sizes:
        everything = ("goto 0", f"goto {tasks // 2}", "tasks 0", "sort slack", "robots", "log", "help", "end")
        for command in everything if tasks <= 100 else ("goto 100", "robots"):
            steps.do(command)
            listing, seen = steps.listing(), []
            while True:
                shown = lines_of(screen(steps, height - AROUND, width, "message"), width)
                assert len(shown) <= height - 1  # the prompt comes on the last
                assert max(map(len, shown)) <= width
                seen += [row.split() for row in shown[8:-2]]  # after the header, the title and the table's head
                if f"page {steps.view.page + 1} of" not in "\n".join(shown) or "next" not in shown[-2]:
                    break
                steps.do("n")
            first = next(
                index for index in range(len(listing.columns)) if listing.columns[index]
            )  # the cell that names the row
            assert len(seen) == len(listing.rows)
            names = [row.cells[first].split()[0] for row in listing.rows]
            assert all(name in cells for name, cells in zip(names, seen, strict=True))
        assert len(prompt(steps)) < 75


@pytest.mark.parametrize("width", [8, 13, 18, 24, 30, 33, 40])
def test_no_number_is_cut_however_narrow(width: int) -> None:
    scenario = small_scenario(2, tasks=12, robots=3)
    scenario = replace(scenario, deadline=scenario.deadline * 1e3, workload=scenario.workload + 1234.5)
    steps = Session(Stepper(scenario, "capam-plus"))
    for command in ("goto 0", "goto 3", "robots", "log"):
        steps.do(command)
        listing = steps.listing()
        shown = lines_of(screen(steps, 20, width), width)
        known = {word for row in listing.rows for cell in row.cells for word in cell.split()}
        for line in shown[8:-2]:
            assert {word for word in line.split() if word[-1].isdigit() or word[0].isdigit()} <= known
            assert not re.search(r"\d…", line)


def test_marks_and_tones() -> None:
    steps = session()
    stepper = steps.stepper
    steps.do("f 3")
    steps.do("b")
    made, advice = stepper.made, stepper.advice
    assert made is not None
    assert advice is not None
    marked = {row.cells[0]: row for row in steps.listing().rows if row.cells[0]}
    assert {mark: row.cells[1] for mark, row in marked.items()} == {"*>": str(made.task)}
    other = next(int(row.cells[1]) for row in steps.listing().rows if row.tone == "plain")
    steps.do(str(other))
    steps.do("b")
    marked = {row.cells[0]: row for row in steps.listing().rows if row.cells[0]}
    assert (marked["*"].cells[1], marked["*"].tone) == (str(other), "made")
    assert (marked[">"].cells[1], marked[">"].tone) == (str(advice.task), "advised")
    assert sum(row.tone == "faint" for row in steps.listing().rows) == 12 - stepper.mission.mask(2).sum()


def test_a_script_prints_the_same_always() -> None:
    script = "show 3   # at first\nfollow\n5\nlog\nback 2\nrobots\nend\nshow"
    output = scripted(session(), script)
    assert output == scripted(session(), script)
    assert "\x1b" not in output
    assert all(line == line.rstrip() and len(line) <= 80 for line in output.split("\n"))
    assert output.startswith(
        "> show 3\nsmall: 12 tasks, 3 robots, mask rule feasible\ntime 0.0  decision 0  0 completed, "
    )
    assert "\n> 5\ndecision 1: robot 1 takes task 5, until " in output
    assert "\n> log\n2 decisions so far, the last one first\n" in output
    assert "the mission is over: completed " in output.split("> show\n")[1]


def test_a_script_ends_at_quit() -> None:
    assert "> end" not in scripted(session(), "quit\nend")
    with pytest.raises(ConfigError, match=r"script\.txt, line 1: there is no command 'show'"):
        scripted(session(), "show 0")


def test_saving_and_loading(tmp_path: Path) -> None:
    path = tmp_path / "s.json"
    assert f"> save {path}\n2 decisions saved to {path}\n" in scripted(session(), f"f\nf\nb\nsave {path}\nend\nsave\n")
    trace = read_trace(path)
    assert trace.mission().done
    steps = session(None)
    assert steps.do(f"load {path}").startswith(f"{len(trace.choices)} decisions loaded; the mission is over")
    steps.do("goto 1")
    assert steps.stepper.advice == trace.choices[1]
    with pytest.raises(ActionError, match="the mission is over, after"):
        scripted(session(), "end\nfollow")


def test_a_plans_advice_is_for_its_own_mission(tmp_path: Path) -> None:
    other = small_scenario(9, tasks=5, robots=4)
    Stepper(other, "nearest").save(tmp_path / "other.json")
    for method, advised in (("nearest", True), (Plan(((0,), (), ())), False)):
        advisor = make_advisor(SCENARIO, method)
        steps = Session(Stepper(SCENARIO, advisor), advisor)
        assert steps.do(f"load {tmp_path / 'other.json'}") == "0 decisions loaded; decision 0: robot 0 chooses at 0.0"
        assert steps.stepper.scenario == other
        assert (steps.stepper.advice is not None) == advised


def typed(monkeypatch: pytest.MonkeyPatch, steps: Session, *lines: str) -> str:
    """What a terminal shows if somebody types these lines, then Ctrl-D."""
    rest = iter(lines)

    def answer(prompt: str) -> str:
        try:
            return next(rest)
        except StopIteration:
            raise EOFError from None

    monkeypatch.setattr("builtins.input", answer)
    output = io.StringIO()
    interact(steps, Console(file=output, width=80, height=24, force_terminal=True, markup=False, highlight=False))
    return output.getvalue()


def test_at_a_terminal(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    steps = session()
    assert "! there is no command 'hop'" in typed(monkeypatch, steps, "", "hop", "b")
    assert steps.stepper.position == 0
    legal = str(steps.stepper.outlook()[1].task)
    # Leaving is asked twice if there is something to lose; what is between takes the first time back.
    assert "! choices of your own are not saved" in typed(monkeypatch, steps, legal, "q", "r", "q", "q", "f")
    assert (steps.over, steps.stepper.position) == (True, 1)
    steps.over = False
    typed(monkeypatch, steps, f"save {tmp_path / 's.json'}", "q", "f")
    assert (steps.over, steps.stepper.position) == (True, 1)
