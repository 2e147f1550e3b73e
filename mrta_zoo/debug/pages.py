"""What there is to be seen of a stepper, as rows of text, and which of them a page shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from mrta_zoo.debug.outlook import SortKey
from mrta_zoo.debug.stepper import Stepper
from mrta_zoo.render.whereabouts import whereabouts
from mrta_zoo.rules import MaskReason

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
class Row:
    """A line of a table.

    Attributes:
        cells: its text.
        tone: "advised", "made", "plain", or "faint" for what may not be chosen or is over.
    """

    cells: tuple[str, ...]
    tone: str = "plain"


@dataclass(frozen=True, slots=True)
class Listing:
    """A table: its title, its columns, those whose text begins at the left, and the rows."""

    title: str
    columns: tuple[str, ...]
    left: tuple[str, ...]
    rows: Sequence[Row]


def listing(stepper: Stepper, view: View, commands: Sequence[tuple[str, str]]) -> Listing:
    """The table that is looked at.

    Args:
        stepper: as it stands.
        view: what is looked at.
        commands: each with what it does, for help.
    """
    if view.subject == "help":
        return Listing("commands", ("command", "what it does"), ("command", "what it does"), [*map(Row, commands)])
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
    rows = []
    for each in stepper.outlook(robot, view.order):
        advised, chosen = advice is not None and each.task == advice.task, made is not None and each.task == made.task
        share = "" if each.probability is None else f"{100 * each.probability:.1f}"
        free = each.reason == MaskReason.CHOOSABLE
        cells = (
            ("*" if chosen else "") + (">" if advised else ""),
            str(each.task),
            f"{each.distance:.1f}",
            f"{each.travel:.1f}",
            f"{each.finish:.1f}",
            f"{each.slack:.1f}",
            f"{each.deadline:.1f}",
            *((share if free else "",) if probable else ()),
            str(each),
        )
        rows.append(Row(cells, "advised" if advised else "made" if chosen else "plain" if free else "faint"))
    choices = int(stepper.mission.mask(robot).sum())
    title = f"robot {robot} may choose {choices} of {len(rows)} tasks" + ("" if own else " when it is next free")
    numbers = ("task", "dist", "travel", "finish", "slack", "due", *(("prob %",) if probable else ()))
    return Listing(title, ("", *numbers, ""), ("",), rows)


def _robots(stepper: Stepper) -> Listing:
    mission = stepper.mission
    rows = []
    for robot, route in enumerate(mission.routes):
        now = whereabouts(mission, robot)
        doing = {
            "acting": "chooses now",
            "waiting": "is free now",
            "retired": "retired",
            "travelling": f"to task {mission.heading[robot]}",
            "working": f"at task {mission.heading[robot]}",
        }[now.doing]
        scenario = mission.scenario
        cells = (
            str(robot), f"({now.x:.1f}, {now.y:.1f})", f"{scenario.capacity[robot]:g}", f"{scenario.speed[robot]:g}",
            str(len(route)), f"{mission.ready[robot]:.1f}", str(int(mission.mask(robot).sum())), doing,
        )  # fmt: skip
        rows.append(Row(cells, "advised" if now.doing == "acting" else "faint" if now.doing == "retired" else "plain"))
    columns = ("robot", "place", "capacity", "speed", "taken", "free at", "choices", "")
    return Listing(f"{len(rows)} robots", columns, ("",), rows)


def _log(stepper: Stepper) -> Listing:
    """The decisions made so far, the last one first."""
    trace = stepper.trace()
    rows = []
    for mission, decision in trace.replay():
        if decision.index == stepper.position:
            break
        choice = decision.choice
        task = choice.task
        finish = None if task is None else float(mission.finish_if[decision.robot, task])
        words = "" if choice.advice is None else f"the policy's choice was task {choice.advice}"
        cells = (
            str(decision.index), f"{decision.time:.1f}", str(decision.robot), "stays" if task is None else str(task),
            "" if finish is None else f"{finish:.1f}",
            "" if finish is None or task is None else f"{stepper.scenario.deadline[task] - finish:.1f}", words,
        )  # fmt: skip
        rows.append(Row(cells, "plain" if choice.advice is None else "made"))
    columns = ("decision", "time", "robot", "task", "finish", "slack", "")
    return Listing(f"{len(rows)} decisions so far, the last one first", columns, ("",), rows[::-1])
