"""What a solved mission is written to: the plan as JSON, and its schedule as a flat table for spreadsheets."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from mrta_zoo.eval.runner import Solved
from mrta_zoo.io import LeftOutTask, PlanScore, ScheduledTask, write_plan
from mrta_zoo.io.records import write_records
from mrta_zoo.left_out import left_out
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import Score


def write_solved(solved: Solved, path: Path) -> None:
    """Write the plan with its schedule, its score and what it leaves out as JSON."""
    scenario, score = solved.scenario, solved.score
    tasks, robots = scenario.task_names, scenario.robot_names
    write_plan(
        solved.plan,
        path,
        schedule=[
            [
                ScheduledTask(
                    visit.task,
                    visit.arrival,
                    visit.finish,
                    visit.deadline,
                    visit.completed,
                    tasks[visit.task] if tasks else None,
                    robots[robot] if robots else None,
                )
                for visit in visits
            ]
            for robot, visits in enumerate(score.schedule)
        ],
        score=PlanScore(score.completed, score.tasks, score.completion, score.cost, score.distance, score.makespan),
        left_out=[
            LeftOutTask(each.task, each.reason, tasks[each.task] if tasks else None)
            for each in left_out(scenario, solved.plan)
        ],
    )


@dataclass(frozen=True, slots=True)
class ScheduleRow:
    """A task on a robot's route.

    Attributes:
        robot: its number, from 0.
        robot_name: what people call it: its name, or "robot" and its number.
        task: the task's number, from 0.
        task_name: its name, or its number.
        x: where it is, in distance units.
        y: likewise.
        depart: when the robot leaves for it, in time units, >= 0.
        arrive: when it gets there, >= depart.
        finish: when the work is done, >= arrive.
        deadline: of the task, > 0.
        slack: deadline - finish; < 0 if it is late.
    """

    robot: int
    robot_name: str
    task: int
    task_name: str
    x: float
    y: float
    depart: float
    arrive: float
    finish: float
    deadline: float
    slack: float


def schedule_rows(scenario: Scenario, score: Score) -> list[ScheduleRow]:
    """The rows, robot by robot and in order of time."""
    rows = []
    for robot, visits in enumerate(score.schedule):
        depart = 0.0
        for visit in visits:
            x, y = scenario.task_xy[visit.task].tolist()
            rows.append(
                ScheduleRow(
                    robot=robot,
                    robot_name=scenario.robot_name(robot),
                    task=visit.task,
                    task_name=scenario.task_name(visit.task),
                    x=x,
                    y=y,
                    depart=depart,
                    arrive=visit.arrival,
                    finish=visit.finish,
                    deadline=visit.deadline,
                    slack=visit.deadline - visit.finish,
                )
            )
            depart = visit.finish
    return rows


def write_schedule(solved: Solved, path: Path) -> None:
    """Write the schedule as CSV, numbers in full precision and names as they are, the header in any case.

    Raises:
        ConfigError: if the file cannot be written.
    """
    write_records(schedule_rows(solved.scenario, solved.score), path, ScheduleRow)
