"""A plan as text for people: who does what and when."""

from __future__ import annotations

from mrta_zoo.digits import decimals, full, rounded, share
from mrta_zoo.left_out import Reason, left_out
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.terminal.sheet import Sheet
from mrta_zoo.verify import COST, Score
from mrta_zoo.wording import counted, listed

WHY: dict[Reason, str] = {
    "out of reach": "left out, out of reach (no robot could do them in time)",
    "others were worth more": "left out, others were worth more",
}


def schedule_table(scenario: Scenario, score: Score) -> Sheet:
    """One row per task that is done, robot by robot; times in time units. What has no name is numbered from 0."""
    rows: list[tuple[str, ...]] = []
    ends, digits = [], decimals(score.makespan, 2)
    for robot, visits in enumerate(score.schedule):
        name = scenario.robot_name(robot)
        if not visits:
            rows.append((name, "-", "-", "-", "-", "stays where it is"))
        for visit in visits:
            times = (f"{visit.arrival:.{digits}f}", f"{visit.finish:.{digits}f}", full(visit.deadline))
            rows.append((name, scenario.task_name(visit.task), *times, "" if visit.completed else "late"))
        ends.append(len(rows) - 1)
    left = ("robot", "", *(("task",) if scenario.task_names else ()))
    return Sheet("", ("robot", "task", "arrival", "finish", "deadline", ""), rows, left, ends)


def proven(score: Score, bound: int | None) -> str:
    """A line on what is proven of the best plan, given the most tasks that any plan can complete; "" if nothing is."""
    if bound is None:
        return ""
    if score.completed == bound:
        return "proven optimal: no plan completes more tasks"
    return f"not proven optimal, though it may be; no plan completes more than {counted(bound, 'task')}"


def totals(score: Score) -> str:
    """All scores, on three lines."""
    visited = sum(len(visits) for visits in score.schedule)
    return (
        f"completed {score.completed} of {counted(score.tasks, 'task')} ({share(score.completion)} %), "
        f"{visited - score.completed} late, {score.tasks - visited} not taken\n"
        f"cost {score.cost:.3f} ({COST})\n"
        f"distance {rounded(score.distance)}, makespan {rounded(score.makespan)}"
    )


def missed(scenario: Scenario, plan: Plan, score: Score) -> list[str]:
    """The tasks that a plan does not complete, by name, one line per reason."""
    tasks: dict[str, list[int]] = {
        words: [each.task for each in left_out(scenario, plan) if each.reason == reason]
        for reason, words in WHY.items()
    }
    tasks["finished late"] = [visit.task for visits in score.schedule for visit in visits if not visit.completed]
    return [f"{words}: {listed(map(scenario.task_name, which))}" for words, which in tasks.items() if which]
