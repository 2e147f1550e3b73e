"""The panel beside the map: what the marks mean, with counts, and what each robot does."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mrta_zoo.digits import rough
from mrta_zoo.mission import Mission
from mrta_zoo.rules import Status
from mrta_zoo.show.palette import FAINT, INK, MISSED, URGENCY, blend, robot_colour
from mrta_zoo.show.render.canvas import Canvas, fitted, text_width
from mrta_zoo.show.view import Digits, shown_time
from mrta_zoo.wording import counted

_TOP, _ROW = 60.0, 22.0
_WIDTH = 324.0
_LEGEND_ROWS = 7
_ONE_COLUMN, _MOST_LISTED = 20, 76
"""The most robots that get a sentence each, and that get a few words each, in two columns."""


def draw_panel(canvas: Canvas, mission: Mission, doing: Sequence[str], left: float, bottom: float) -> None:
    """The legend, then the robots.

    Args:
        canvas: to draw on.
        mission: what is shown.
        doing: for each robot `Whereabouts.doing`.
        left: where the column begins, in pixels.
        bottom: where it must end.
    """
    _draw_legend(canvas, mission, left)
    top = _TOP + _LEGEND_ROWS * _ROW + 14
    robots = mission.scenario.num_robots
    canvas.text(counted(robots, "robot"), (left, top), 17, FAINT)
    listed = min(robots, _MOST_LISTED)
    columns = 1 if listed <= _ONE_COLUMN else 2
    rows = -(-listed // columns)
    step = min(27.0, (bottom - top - 20) / (rows + (listed < robots)))
    for robot in range(listed):
        column, row = divmod(robot, rows)
        x, y = left + column * _WIDTH / columns, top + 24 + row * step
        if columns == 1:
            if robot == mission.actor:
                canvas.disc((x + 11, y), 13.0, "#ffffff", INK, 1.6)
            canvas.disc((x + 11, y), 10.0, robot_colour(robot), "#ffffff", 0.5)
            canvas.text(str(robot), (x + 11, y), 15, "#ffffff", align=0.5)
            canvas.text(_sentence(mission, robot, doing[robot]), (x + 29, y), 17, INK)
        else:  # numbers of the robot's colour, as there is no room for discs
            canvas.text(str(robot), (x + 18, y), 16, robot_colour(robot), align=1.0)
            canvas.text(_words(mission, robot, doing[robot]), (x + 25, y), 16, INK)
    if listed < robots:
        canvas.text(f"and {robots - listed} more", (left + 29, top + 24 + rows * step), 15, FAINT)


def _draw_legend(canvas: Canvas, mission: Mission, left: float) -> None:
    scenario = mission.scenario
    counts = np.bincount(mission.status, minlength=len(Status)).tolist()
    horizon = shown_time(scenario, 0.0)
    tasks = scenario.num_tasks
    mark, text = left + 11, left + 29
    canvas.text(counted(tasks, "task"), (left, _TOP), 17, FAINT)
    rows = [_TOP + (row + 1) * _ROW for row in range(_LEGEND_ROWS)]
    canvas.disc((mark, rows[0]), 6.0, blend(URGENCY, 0.4), FAINT, 1.2)
    canvas.text(f"{counts[Status.ACTIVE]} active, by time left to their deadlines:", (text, rows[0]), 17, INK)
    steps = 60
    for step in range(steps):
        canvas.rectangle((text + 22 + 2.5 * step, rows[1] - 5), (2.5, 10), blend(URGENCY, step / (steps - 1)))
    canvas.text("0", (text + 15, rows[1]), 16, FAINT, align=1.0)
    canvas.text(rough(horizon), (text + 29 + 2.5 * steps, rows[1]), 16, FAINT)
    canvas.disc((mark, rows[2]), 7.5, "#ffffff", INK, 2.6)
    canvas.text(f"{counts[Status.ASSIGNED]} assigned, ring of the robot's colour", (text, rows[2]), 17, INK)
    canvas.disc((mark, rows[3]), 4.6, INK, "#ffffff", 0.4)
    canvas.text(f"{counts[Status.COMPLETED]} completed", (text, rows[3]), 17, INK)
    canvas.cross((mark, rows[4]), 4.4, MISSED, 2.2)
    canvas.text(f"{counts[Status.MISSED]} missed", (text, rows[4]), 17, INK)
    canvas.square((mark, rows[5]), 11.0, "#ffffff", INK, 2.0)
    canvas.text("start of a robot", (text, rows[5]), 17, INK)


def _sentence(mission: Mission, robot: int, doing: str) -> str:
    """What a robot does and, if robots have names, its name; its number stands beside the sentence."""
    task, time = mission.heading[robot], Digits.of(mission.scenario).time
    until, due = time(mission.ready[robot]), time(mission.scenario.deadline[task])
    who = "{robot}: " if mission.scenario.robot_names else ""
    what = {
        "acting": "chooses now",
        "waiting": "is free",
        "retired": f"retired after {counted(len(mission.routes[robot]), 'task')}",
        "travelling": f"to task {{task}}, done at {until}, due {due}",
        "working": f"at task {{task}} until {until}, due {due}",
    }[doing]
    return _named(who + what, mission, robot, 17, _WIDTH - 29)


def _words(mission: Mission, robot: int, doing: str) -> str:
    until = Digits.of(mission.scenario).time(mission.ready[robot])
    what = {
        "acting": "chooses now",
        "waiting": "is free",
        "retired": f"retired ({len(mission.routes[robot])})",
        "travelling": f"to {{task}}, done {until}",
        "working": f"at {{task}} until {until}",
    }[doing]
    return _named(what, mission, robot, 16, _WIDTH / 2 - 25)


def _named(what: str, mission: Mission, robot: int, size: float, room: float) -> str:
    """A sentence with the names of a robot and its task filled in, as much of them as there is room for."""
    scenario, task = mission.scenario, mission.heading[robot]
    left = (room - text_width(what.format(robot="", task=""), size)) / max(what.count("{"), 1)
    return what.format(
        robot=fitted(scenario.robot_name(robot), f"robot {robot}", size, left, scenario.robot_names),
        task=fitted(scenario.task_name(task), str(task), size, left, scenario.task_names),
    )
