"""Notebook views of scenarios, plans and scores.

The model does not know how it is shown: `attach`, called when the package is imported, gives each class the method
``_repr_html_`` that notebooks look for.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, get_args

from mrta_zoo.digits import full, rounded, share
from mrta_zoo.plan import Plan
from mrta_zoo.quantities import Who
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.markup import in_order, map_of, table
from mrta_zoo.show.view import shown_box, shown_time
from mrta_zoo.verify import COST, Score
from mrta_zoo.wording import counted


def scenario_html(scenario: Scenario) -> str:
    """The range of each quantity of a scenario, and its map."""
    rows = [
        (what, full(values.min()), full(values.mean()), full(values.max()))
        for who in get_args(Who)
        for what, values in scenario.said(who).items()
    ]
    (x, y), (width, height) = scenario.map_origin, scenario.map_size
    begins = f" from {full(x)}, {full(y)}" if x or y else ""
    title = f"{scenario.name}: {scenario.size}, map {full(width)} by {full(height)}{begins}"
    tasks = [
        (f"task {scenario.task_name(task)}", *place, due)
        for task, (place, due) in enumerate(zip(scenario.task_xy.tolist(), scenario.deadline.tolist(), strict=True))
    ]
    robots = [(scenario.robot_name(robot), *place) for robot, place in enumerate(scenario.robot_xy.tolist())]
    low, size = (tuple(each.tolist()) for each in shown_box(scenario))
    picture = map_of(low, size, tasks, robots, shown_time(scenario, 0.0))
    return table(title, ("", "least", "mean", "most"), rows) + picture


def plan_html(plan: Plan) -> str:
    """Each robot's tasks, in order."""
    of = f" of {plan.scenario}" if plan.scenario else ""
    by = f" by {plan.method}" if plan.method else ""
    rows = [(robot, len(route), in_order(route) or "-") for robot, route in enumerate(plan.routes)]
    title = f"Plan{of}{by}: {counted(sum(map(len, plan.routes)), 'task')} taken"
    return table(title, ("robot", "tasks", "in this order"), rows)


def score_html(score: Score) -> str:
    """The scores, and what each robot did."""
    title = (
        f"{score.completed} of {counted(score.tasks, 'task')} completed ({share(score.completion)} %), "
        f"cost {score.cost:.3f}, distance {rounded(score.distance)}, makespan {rounded(score.makespan)} "
        f"(cost by {COST})"
    )
    tasks = score.task_names or range(score.tasks)
    robots = score.robot_names or range(len(score.schedule))
    rows = [
        (robot, f"{sum(visit.completed for visit in visits)} of {len(visits)}",
         visits[-1].finish if visits else "-", in_order(tasks[visit.task] for visit in visits) or "-")
        for robot, visits in zip(robots, score.schedule, strict=True)
    ]  # fmt: skip
    return table(title, ("robot", "completed", "last finish", "tasks"), rows)


FORMATTERS: dict[type, Callable[[Any], str]] = {Scenario: scenario_html, Plan: plan_html, Score: score_html}


def attach() -> None:
    """Make notebooks show each type by its entry in `FORMATTERS`."""
    for shown, formatter in FORMATTERS.items():
        shown._repr_html_ = formatter  # type: ignore[attr-defined]
