"""A plan as text for people: who does what and when."""

from __future__ import annotations

from rich import box
from rich.table import Table

from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import Score


def schedule_table(scenario: Scenario, score: Score) -> Table:
    """A row for each task that is done, robot by robot; times in time units, tasks counted from 0."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for heading in ("robot", "task", "arrival", "finish", "deadline", ""):
        table.add_column(heading, justify="left" if heading in ("robot", "") else "right", no_wrap=True)
    for robot, visits in enumerate(score.schedule):
        name = f"robot {robot}"
        if not visits:
            table.add_row(name, "-", "-", "-", "-", "stays where it is", end_section=True)
        for index, visit in enumerate(visits):
            table.add_row(
                name,
                str(visit.task),
                f"{visit.arrival:.2f}",
                f"{visit.finish:.2f}",
                f"{visit.deadline:g}",
                "" if visit.completed else "late",
                end_section=index == len(visits) - 1,
            )
    return table


def proven(score: Score, bound: int | None) -> str:
    """What is known of the best plan, on a line, given the most tasks that any plan can complete; empty if nothing."""
    if bound is None:
        return ""
    if score.completed == bound:
        return "proven optimal: no plan completes more tasks"
    return f"not proven optimal: it may be; no plan completes more than {bound} tasks"


def totals(score: Score) -> str:
    """All scores, on two lines."""
    visited = sum(len(visits) for visits in score.schedule)
    return (
        f"completed {score.completed} of {score.tasks} tasks ({100 * score.completion:.1f} %), "
        f"{visited - score.completed} late, {score.tasks - visited} not taken\n"
        f"cost {score.cost:.3f}, distance {score.distance:.1f}, makespan {score.makespan:.1f}"
    )
