"""What a solved mission is written to: the plan as JSON, and its schedule as a flat table for spreadsheets."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from pathlib import Path

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.runner import Solved
from mrta_zoo.io import write_plan
from mrta_zoo.io.text_files import write_text
from mrta_zoo.left_out import left_out

SCHEDULE_COLUMNS = (
    "robot", "robot_name", "task", "task_name", "x", "y", "depart", "arrive", "finish", "deadline", "slack",
)  # fmt: skip
"""Numbers from 0 and names of robot and task, the task's place, when the robot leaves for it, arrives and has finished,
its deadline, and the slack deadline - finish, < 0 if it is late."""


def write_solved(solved: Solved, path: Path) -> None:
    """Write the plan with its schedule, its score and what it leaves out as JSON."""
    write_plan(solved.plan, path, solved.score, left_out(solved.scenario, solved.plan))


def write_schedule(solved: Solved, path: Path) -> None:
    """Write the schedule as CSV, numbers in full precision and names as they are, the header in any case.

    Raises:
        ConfigError: if the file cannot be written.
    """
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(SCHEDULE_COLUMNS)
    writer.writerows(_schedule_rows(solved))
    write_text(stream.getvalue(), path, ConfigError)


def _schedule_rows(solved: Solved) -> Iterator[tuple[object, ...]]:
    """Robot by robot, in order of time."""
    scenario = solved.scenario
    for robot, visits in enumerate(solved.score.schedule):
        who, depart = (robot, scenario.robot_name(robot)), 0.0
        for visit in visits:
            what = (visit.task, scenario.task_name(visit.task), *scenario.task_xy[visit.task].tolist())
            yield *who, *what, depart, visit.arrival, visit.finish, visit.deadline, visit.deadline - visit.finish
            depart = visit.finish
