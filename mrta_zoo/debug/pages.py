"""The tables of a stepper: tasks, robots, the log of decisions, and help."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from rich.cells import cell_len

from mrta_zoo.debug.naming import cells, headings, label, shortened
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
class TableView:
    """Which table the user looks at, and how.

    Attributes:
        subject: the table.
        page: its page, from 0.
        robot: the robot whose view of the tasks is shown; None for the robot that chooses next.
        order: how the tasks are sorted.
    """

    subject: Subject = "tasks"
    page: int = 0
    robot: int | None = None
    order: SortKey = "rank"


@dataclass(frozen=True, slots=True)
class Line:
    """A line of a table.

    Attributes:
        cells: the text of each cell; the last one is a note.
        tone: "advised", "made", "plain", or "faint" for what may not be chosen or is over.
        name: a name within the note, which may be shortened; empty if there is none.
    """

    cells: tuple[str, ...]
    tone: str = "plain"
    name: str = ""

    def note(self, most: int, least: int, among: Sequence[str] = ()) -> str:
        """The note, with the name in it shortened so that it fits.

        Args:
            most: columns available for the note.
            least: columns that the name keeps in any case.
            among: names that this one must be told apart from.
        """
        text = self.cells[-1]
        room = cell_len(self.name) - (cell_len(text) - most)
        return text.replace(self.name, shortened(self.name, max(room, least), among), 1) if self.name else text


@dataclass(frozen=True, slots=True)
class Listing:
    """A table whose last column holds notes.

    Attributes:
        title: the line above it.
        columns: the headings.
        left: the headings of the left-aligned columns.
        rows: the lines.
        spare: the columns to leave out where room is short, the most dispensable first.
    """

    title: str
    columns: tuple[str, ...]
    left: tuple[str, ...]
    rows: Sequence[Line]
    spare: tuple[str, ...] = ()


def listing(stepper: Stepper, view: TableView, commands: Sequence[tuple[str, str]]) -> Listing:
    """The table that the user looks at.

    Args:
        stepper: the episode.
        view: which table, and how.
        commands: how each command is typed and what it does, for help.
    """
    if view.subject == "help":
        return Listing("commands", ("command", "what it does"), ("command", "what it does"), [*map(Line, commands)])
    if view.subject == "log":
        return _log(stepper)
    if view.subject == "robots" or (stepper.done and view.robot is None):
        return _robots(stepper)
    return _tasks(stepper, view)


def _tasks(stepper: Stepper, view: TableView) -> Listing:
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
            str(decision.index), digits.time(decision.time), label(decision.robot, scenario.robot_names),
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
    """The left-aligned columns: those without a heading, and the last of these if there are names."""
    return ("", *headings[-1:]) if names else ("",)
