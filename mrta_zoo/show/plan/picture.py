"""A picture of a plan: the routes on the map, and the schedule of each robot.

Needs matplotlib (``mrta_zoo[plot]``), which it uses without its global state, so that it draws in any thread, with
or without a display.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from mrta_zoo.digits import share
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.figure import LiteralFigure, save_picture
from mrta_zoo.show.lettering import fitted
from mrta_zoo.show.markup import set_apart
from mrta_zoo.show.palette import INK
from mrta_zoo.show.plan.gantt import Schedule
from mrta_zoo.show.plan.route_map import RouteMap
from mrta_zoo.verify import Score, verify
from mrta_zoo.wording import counted

WIDTH, TOP, BOTTOM, SIDE, APART = 1224.0, 62.0, 54.0, 14.0, 26.0
"""Width of the picture, and margins above and below the map and the chart, beside them, and between them; in points,
1/72 of an inch."""
MAP = (400.0, 400.0)
"""The largest that the map may be."""
LEAST, MOST = 250.0, 2700.0
"""The least and greatest height of the chart; a square map is no lower either."""
TITLE, LEGEND = 13.0, 9.0
"""Sizes of text."""
NARROW = 380.0
"""Legends narrower than this have two lines."""


def draw_plan(scenario: Scenario, plan: Plan, score: Score | None = None) -> LiteralFigure:
    """The picture as a matplotlib figure.

    Args:
        scenario: what was planned.
        plan: its plan.
        score: the verifier's score, if it is already known.

    Raises:
        PlanError: if the plan does not fit the scenario.
    """
    score = verify(scenario, plan) if score is None else score
    chart = Schedule.of(scenario, score, LEAST, MOST)
    room = min(max(chart.height, LEAST), MAP[1])
    routes = RouteMap.of(scenario, plan, score, (MAP[0], room))
    chart = replace(chart, numbered=routes.numbered())
    map_width = max(routes.size[0], 0.6 * LEAST)  # for the legend below
    left = SIDE + routes.left()
    chart_left = left + map_width + APART + chart.left()
    height = TOP + max(chart.height, routes.size[1]) + BOTTOM
    figure = LiteralFigure(figsize=(WIDTH / 72, height / 72), dpi=110, facecolor="white")

    def axes_at(x: float, size: tuple[float, float]) -> Any:
        return figure.add_axes((x / WIDTH, 1 - (TOP + size[1]) / height, size[0] / WIDTH, size[1] / height))

    chart_width = WIDTH - chart_left - SIDE
    map_axes, chart_axes = axes_at(left, routes.size), axes_at(chart_left, (chart_width, chart.height))
    routes.draw(map_axes)
    chart.draw(chart_axes, chart_width)
    _legend_below(map_axes, routes.legend(), map_width, 18.0)
    _legend_below(chart_axes, chart.legend(), chart_width, 30.0)
    figure.suptitle(
        _title(scenario, plan, score), y=1 - 12 / height, va="top", fontsize=TITLE, fontweight="bold", color=INK
    )
    return figure


def save_plan_picture(scenario: Scenario, plan: Plan, path: Path, score: Score | None = None) -> None:
    """Write the picture; see `figure.save_picture`.

    Raises:
        ConfigError: if there is no such format here, or the file cannot be written.
        PlanError: if the plan does not fit the scenario.
    """
    save_picture(draw_plan(scenario, plan, score), path)


def _title(scenario: Scenario, plan: Plan, score: Score) -> str:
    late = sum(not visit.completed for visits in score.schedule for visit in visits)
    visited = sum(len(visits) for visits in score.schedule)
    name, method = (set_apart(fitted(each, WIDTH / 4, TITLE, "bold")) for each in (scenario.name, plan.method))
    by = f", planned by {method}" if method else ""
    return (
        f"{name}{by}: {score.completed} of {counted(score.tasks, 'task')} completed "
        f"({share(score.completion)} %), {late} late, {score.tasks - visited} not taken"
    )


def _legend_below(axes: Any, handles: list[Any], width: float, below: float) -> None:
    """A legend `below` points below the axes, in two lines if one line has no room."""
    height = axes.get_position().height * axes.figure.get_figheight() * 72
    columns = len(handles) if width >= NARROW else -(-len(handles) // 2)
    axes.legend(
        handles=handles, loc="upper left", bbox_to_anchor=(0.0, -below / height), borderaxespad=0.0, borderpad=0.0,
        ncols=columns, frameon=False, fontsize=LEGEND, labelcolor=INK, handletextpad=0.4, columnspacing=1.4,
    )  # fmt: skip
