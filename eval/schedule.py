"""A plan as text for people: who does what and when."""

from __future__ import annotations

from rich import box
from rich.table import Table

from mrta_zoo.counted import counted
from mrta_zoo.left_out import Reason, left_out
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import COST, Score

WHY: dict[Reason, str] = {
    "out of reach": "left out, out of reach (no robot could do them in time)",
    "others were worth more": "left out, others were worth more",
}


def schedule_table(scenario: Scenario, score: Score) -> Table:
    """A row for each task that is done, robot by robot; times in time units. What has no name is counted from 0."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for heading in ("robot", "task", "arrival", "finish", "deadline", ""):
        text = heading in ("robot", "") or (heading == "task" and bool(scenario.task_names))
        named = heading in ("robot", "task")  # names are folded where there is no room for them, numbers never
        table.add_column(heading, justify="left" if text else "right", no_wrap=not named, overflow="fold")
    for robot, visits in enumerate(score.schedule):
        name = scenario.robot_name(robot)
        if not visits:
            table.add_row(name, "-", "-", "-", "-", "stays where it is", end_section=True)
        for index, visit in enumerate(visits):
            table.add_row(
                name,
                scenario.task_name(visit.task),
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
    return f"not proven optimal: it may be; no plan completes more than {counted(bound, 'task')}"


def totals(score: Score) -> str:
    """All scores, on three lines."""
    visited = sum(len(visits) for visits in score.schedule)
    return (
        f"completed {score.completed} of {counted(score.tasks, 'task')} ({100 * score.completion:.1f} %), "
        f"{visited - score.completed} late, {score.tasks - visited} not taken\n"
        f"cost {score.cost:.3f} ({COST})\n"
        f"distance {score.distance:.1f}, makespan {score.makespan:.1f}"
    )


def missed(scenario: Scenario, plan: Plan, score: Score) -> list[str]:
    """The tasks that a plan does not complete, by name, a line for each reason there is."""
    tasks: dict[str, list[int]] = {
        words: [each.task for each in left_out(scenario, plan) if each.reason == reason]
        for reason, words in WHY.items()
    }
    tasks["finished late"] = [visit.task for visits in score.schedule for visit in visits if not visit.completed]
    return [f"{words}: {', '.join(map(scenario.task_name, which))}" for words, which in tasks.items() if which]
