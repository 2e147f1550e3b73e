"""What there is to be seen of a stepper, as rows of text, and which of them a page shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rich.cells import cell_len

from mrta_zoo.debug.called import called, cells, headings, shortened
from mrta_zoo.debug.outlook import SortKey
from mrta_zoo.debug.percent import percent
from mrta_zoo.debug.stepper import Stepper
from mrta_zoo.digits import full
from mrta_zoo.rules import MaskReason
from mrta_zoo.show.render.whereabouts import whereabouts
from mrta_zoo.show.view import Digits
from mrta_zoo.wording import counted

Subject = Literal["tasks", "robots", "log", "help"]


@dataclass(slots=True)
class View:
    """What is looked at.

    Attributes:
        subject: the table.
        page: of it, from 0.
        robot: whose tasks; None for those of the robot that is to choose.
        order: of the tasks.
    """

    subject: Subject = "tasks"
    page: int = 0
    robot: int | None = None
    order: SortKey = "rank"


@dataclass(frozen=True, slots=True)
class Line:
    """A line of a table.

    Attributes:
        cells: its text.
        tone: "advised", "made", "plain", or "faint" for what may not be chosen or is over.
        name: the one in its last cell that may be shortened, if any.
    """

    cells: tuple[str, ...]
    tone: str = "plain"
    name: str = ""

    def note(self, most: int, least: int, among: Sequence[str] = ()) -> str:
        """Its last cell, in so many columns if that can be had by shortening the name, though not below `least`."""
        text = self.cells[-1]
        room = cell_len(self.name) - (cell_len(text) - most)
        return text.replace(self.name, shortened(self.name, max(room, least), among), 1) if self.name else text


@dataclass(frozen=True, slots=True)
class Listing:
    """A table, whose last column is text.

    Attributes:
        title: above it.
        columns: their names.
        left: those whose text begins at the left.
        rows: the lines.
        spare: the columns to leave out, one after the other, where there is no room.
    """

    title: str
    columns: tuple[str, ...]
    left: tuple[str, ...]
    rows: Sequence[Line]
    spare: tuple[str, ...] = ()


def listing(stepper: Stepper, view: View, commands: Sequence[tuple[str, str]]) -> Listing:
    """The table that is looked at.

    Args:
        stepper: as it stands.
        view: what is looked at.
        commands: each with what it does, for help.
    """
    if view.subject == "help":
        return Listing("commands", ("command", "what it does"), ("command", "what it does"), [*map(Line, commands)])
    if view.subject == "log":
        return _log(stepper)
    if view.subject == "robots" or (stepper.done and view.robot is None):
        return _robots(stepper)
    return _tasks(stepper, view)


def _tasks(stepper: Stepper, view: View) -> Listing:
    robot = stepper.robot if view.robot is None else view.robot
    own = robot == stepper.robot
    advice, made = (stepper.advice, stepper.made) if own else (None, None)
    probable = advice is not None and advice.probabilities is not None
    rows, scenario, digits = [], stepper.scenario, Digits.of(stepper.scenario)
    choices = int(stepper.mission.mask(robot).sum())
    for each in stepper.outlook(robot, view.order):
        advised, chosen = advice is not None and each.task == advice.task, made is not None and each.task == made.task
        share = "" if each.probability is None else percent(each.probability, only=choices == 1)
        free = each.reason == MaskReason.CHOOSABLE
        row = (
            ("*" if chosen else "") + (">" if advised else ""),
            *cells(each.task, scenario.task_names),
            digits.distance(each.distance),
            digits.time(each.travel),
            digits.time(each.finish),
            digits.time(each.slack),
            digits.time(each.deadline),
            *((share if free else "",) if probable else ()),
            str(each),
        )
        tone = "advised" if advised else "made" if chosen else "plain" if free else "faint"
        rows.append(Line(row, tone, each.who if scenario.robot_names else ""))
    when = "" if own else " when it is next free"
    title = f"{scenario.robot_name(robot)} may choose {choices} of {counted(len(rows), 'task')}{when}"
    numbers = ("dist", "travel", "finish", "slack", "due", *(("prob %",) if probable else ()))
    tasks = headings("task", scenario.task_names)
    spare = ("dist", "travel", "due", "finish")
    return Listing(title, ("", *tasks, *numbers, ""), _texts(tasks, scenario.task_names), rows, spare)


def _robots(stepper: Stepper) -> Listing:
    mission, scenario = stepper.mission, stepper.scenario
    rows, digits = [], Digits.of(scenario)
    for robot, route in enumerate(mission.routes):
        now = whereabouts(mission, robot)
        doing = {
            "acting": "chooses now",
            "waiting": "is free now",
            "retired": "retired",
            "travelling": f"to task {scenario.task_name(mission.heading[robot])}",
            "working": f"at task {scenario.task_name(mission.heading[robot])}",
        }[now.doing]
        row = (
            *cells(robot, scenario.robot_names), f"({digits.distance(now.x)}, {digits.distance(now.y)})",
            full(scenario.capacity[robot]), full(scenario.speed[robot]),
            str(len(route)), digits.time(mission.ready[robot]), str(int(mission.mask(robot).sum())), doing,
        )  # fmt: skip
        tone = "advised" if now.doing == "acting" else "faint" if now.doing == "retired" else "plain"
        rows.append(Line(row, tone, _named(mission.heading[robot], scenario.task_names)))
    robots = headings("robot", scenario.robot_names)
    columns = (*robots, "place", "capacity", "speed", "taken", "free at", "choices", "")
    spare = ("speed", "place", "capacity", "taken", "choices")
    return Listing(counted(len(rows), "robot"), columns, _texts(robots, scenario.robot_names), rows, spare)


def _log(stepper: Stepper) -> Listing:
    """The decisions made so far, the last one first."""
    trace, scenario = stepper.trace(), stepper.scenario
    rows, digits = [], Digits.of(scenario)
    for mission, decision in trace.steps():
        if decision.index == stepper.position:
            break
        choice = decision.choice
        task = choice.task
        finish = None if task is None else float(mission.finish_if[decision.robot, task])
        words = "" if choice.advice is None else f"the policy's choice was task {scenario.task_name(choice.advice)}"
        row = (
            str(decision.index), digits.time(decision.time), called(decision.robot, scenario.robot_names),
            "stays" if task is None else scenario.task_name(task),
            "" if finish is None else digits.time(finish),
            "" if finish is None or task is None else digits.time(scenario.deadline[task] - finish), words,
        )  # fmt: skip
        tone = "plain" if choice.advice is None else "made"
        rows.append(Line(row, tone, _named(choice.advice, scenario.task_names)))
    columns = ("decision", "time", "robot", "task", "finish", "slack", "")
    texts = (*_texts(("robot",), scenario.robot_names), *_texts(("task",), scenario.task_names))
    title = f"{counted(len(rows), 'decision')} so far, the last one first"
    return Listing(title, columns, texts, rows[::-1], ("time", "finish", "slack", "robot"))


def _named(index: int | None, names: Sequence[str]) -> str:
    """The name of a task, if there is such a task and it has one."""
    return names[index] if names and index is not None and index >= 0 else ""


def _texts(headings: tuple[str, ...], names: Sequence[str]) -> tuple[str, ...]:
    """The columns that hold text: those without a heading, and the last of these if there are names."""
    return ("", *headings[-1:]) if names else ("",)
