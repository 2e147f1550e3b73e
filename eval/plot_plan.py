"""A picture of a plan: the routes on the map, and what each robot does when.

Needs matplotlib (``mrta_zoo[plot]``), which it uses without its global state, so that it draws in any thread, with
or without a display.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from mrta_zoo.eval.figure import Figure, LiteralFigure, save_picture
from mrta_zoo.extras import require
from mrta_zoo.palette import FAINT, INK, robot_colour
from mrta_zoo.plan import Plan
from mrta_zoo.render.style import plain
from mrta_zoo.scenario import FloatArray, Scenario
from mrta_zoo.verify import Score, verify

try:
    from matplotlib.collections import LineCollection
    from matplotlib.layout_engine import ConstrainedLayoutEngine
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    from matplotlib.patheffects import withStroke
except ImportError:
    require("plot", "a picture")
    raise


LATE = "#000000"
HEIGHT_PER_ROBOT, LEAST_HEIGHT, MOST_HEIGHT = 0.4, 6.4, 30.0
"""Of the picture, in inches."""
LEAST_ROWS = 4
"""Rows of the chart on the right that there is room for, so that a single robot does not fill it."""
MOST_NUMBERED = 150
"""Tasks on the map that still get their number, and robots that get a label of their own."""


def draw_plan(scenario: Scenario, plan: Plan, score: Score | None = None) -> Figure:
    """The picture as a matplotlib figure.

    Args:
        scenario: what was planned.
        plan: its plan.
        score: the verifier's, if it is already known.

    Raises:
        PlanError: if the plan does not fit the scenario.
    """
    score = verify(scenario, plan) if score is None else score
    height = min(max(LEAST_HEIGHT, 1.4 + HEIGHT_PER_ROBOT * scenario.num_robots), MOST_HEIGHT)
    figure = LiteralFigure(
        figsize=(17.0, height), dpi=110, facecolor="white", layout=ConstrainedLayoutEngine(h_pad=0.12, w_pad=0.12)
    )
    chart_map, chart_time = figure.subplots(1, 2, width_ratios=(1.0, 1.75))
    _draw_map(chart_map, scenario, plan, score)
    _draw_time(chart_time, scenario, score)
    figure.suptitle(_title(scenario, plan, score), fontsize=13, fontweight="bold", color=INK)
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
    method = f", planned by {plan.method}" if plan.method else ""
    return (
        f"{scenario.name}{method}: {score.completed} of {score.tasks} tasks completed "
        f"({100 * score.completion:.1f} %), {late} late, {score.tasks - visited} not taken"
    )


def _draw_map(axes: Any, scenario: Scenario, plan: Plan, score: Score) -> None:
    width, height = scenario.map_size
    margin = 0.035 * max(width, height)
    axes.set(xlim=(-margin, width + margin), ylim=(-margin, height + margin), aspect="equal", anchor="N")
    plain(axes)
    numbered = scenario.num_tasks <= MOST_NUMBERED
    size = 34.0 if numbered else max(4.0, 5000.0 / scenario.num_tasks)
    taken = np.zeros(scenario.num_tasks, dtype=np.bool_)
    for robot, route in enumerate(plan.routes):
        tasks = np.array(route, dtype=np.intp)
        taken[tasks] = True
        way = np.vstack((scenario.robot_xy[robot], scenario.task_xy[tasks]))
        _draw_way(axes, way, robot_colour(robot), arrows=numbered)
        completed = np.array([visit.completed for visit in score.schedule[robot]], dtype=np.bool_)
        axes.scatter(
            *scenario.task_xy[tasks[completed]].T,
            s=size,
            c=robot_colour(robot),
            edgecolors="white",
            linewidths=0.8,
            zorder=4,
        )
        axes.scatter(*scenario.task_xy[tasks[~completed]].T, s=1.6 * size, c=LATE, marker="x", linewidths=1.8, zorder=5)
    axes.scatter(
        *scenario.task_xy[~taken].T, s=0.7 * size, facecolors="white", edgecolors=FAINT, linewidths=1.0, zorder=3
    )
    if numbered:
        for task, (x, y) in enumerate(scenario.task_xy):
            axes.annotate(
                str(task), (x, y), (3.5, 3.0), textcoords="offset points", fontsize=6.5, zorder=7,
                color=INK if taken[task] else FAINT, path_effects=[withStroke(linewidth=1.6, foreground="white")],
            )  # fmt: skip
    if scenario.num_robots <= MOST_NUMBERED:
        for robot, (x, y) in enumerate(scenario.robot_xy):
            axes.text(
                x, y, str(robot), fontsize=8, fontweight="bold", color="white", ha="center", va="center_baseline",
                zorder=9, bbox={"boxstyle": "square,pad=0.3", "facecolor": robot_colour(robot), "edgecolor": "white"},
            )  # fmt: skip
    marks = [
        Line2D([], [], marker="s", color="white", markerfacecolor=FAINT, markersize=9, label="start of a robot"),
        Line2D([], [], marker="o", color="white", markerfacecolor=FAINT, markersize=7, label="completed"),
        Line2D([], [], marker="x", linestyle="", color=LATE, markeredgewidth=1.8, markersize=7, label="finished late"),
        Line2D([], [], marker="o", color="white", markerfacecolor="white", markeredgecolor=FAINT, label="not taken"),
    ]
    _legend_below(axes, marks)
    axes.set_title("Routes (distance units)", fontsize=10, color=FAINT, loc="left")


def _draw_way(axes: Any, way: FloatArray, colour: str, arrows: bool) -> None:
    """A route with an arrow head in the middle of each leg that is long enough for one."""
    axes.plot(*way.T, color=colour, linewidth=1.5, alpha=0.8, zorder=2, solid_joinstyle="round")
    if not arrows:
        return
    legs = np.diff(way, axis=0)
    middle = way[:-1] + 0.55 * legs
    span = axes.get_xlim()[1] - axes.get_xlim()[0]
    for place, leg in zip(middle, legs, strict=True):
        length = float(np.hypot(*leg))
        if length > 0.04 * span:
            axes.annotate(
                "", place + 0.001 * span * leg / length, place,
                arrowprops={"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 11},
                zorder=3,
            )  # fmt: skip


def _draw_time(axes: Any, scenario: Scenario, score: Score) -> None:
    end = max(score.makespan, float(scenario.deadline.max()))
    m = scenario.num_robots
    axes.set(xlim=(-0.01 * end, 1.015 * end), ylim=(max(m, LEAST_ROWS) - 0.45, -0.6))
    plain(axes)
    axes.grid(axis="y", visible=False)
    numbered = m <= 20  # more rows leave no room for text in the bars
    for robot, visits in enumerate(score.schedule):
        colour = robot_colour(robot)
        if not visits:
            continue
        arrival = np.array([visit.arrival for visit in visits])
        finish = np.array([visit.finish for visit in visits])
        deadline = np.array([visit.deadline for visit in visits])
        late = np.array([not visit.completed for visit in visits])
        leave = np.concatenate(([0.0], finish[:-1]))
        _segments(axes, leave, arrival, robot, colour)
        for which, face in ((~late, colour), (late, "white")):
            axes.bar(
                arrival[which], 0.42, finish[which] - arrival[which], robot - 0.21, align="edge", color=face,
                edgecolor=colour, linewidth=0.9, hatch="////" if face == "white" else None, zorder=3,
            )  # fmt: skip
        axes.vlines(deadline, robot + 0.26, robot + 0.40, color=colour, linewidth=1.3, zorder=3)
        axes.scatter(
            finish[late], np.full(late.sum(), robot - 0.32), marker="x", s=34, c=LATE, linewidths=1.8, zorder=5
        )
        for visit in visits if numbered else ():
            if visit.finish - visit.arrival > 0.011 * end:
                axes.text(
                    (visit.arrival + visit.finish) / 2, robot, str(visit.task), fontsize=7, ha="center",
                    va="center_baseline", color="white" if visit.completed else INK, zorder=6,
                    rotation=90 if visit.finish - visit.arrival < 0.02 * end else 0, clip_on=True,
                    path_effects=[] if visit.completed else [withStroke(linewidth=3, foreground="white")],
                )  # fmt: skip
    axes.set_xlabel("time units", color=FAINT, fontsize=9)
    if m <= MOST_NUMBERED:
        axes.set_yticks(range(m), [f"robot {robot}\n{_load(score, robot)}" for robot in range(m)])
        for robot, label in enumerate(axes.get_yticklabels()):
            label.set(color=robot_colour(robot), fontweight="bold", fontsize=9 if m <= 20 else 6)
    _legend_below(
        axes,
        [
            Line2D([], [], color=FAINT, linewidth=1.6, label="travel"),
            Patch(facecolor=FAINT, edgecolor=FAINT, label="work (number of the task)"),
            Line2D([], [], color=FAINT, marker="|", linestyle="", markersize=8, markeredgewidth=1.6,
                   label="deadlines of the robot's tasks"),
            Line2D([], [], color=LATE, marker="x", linestyle="", markersize=7, markeredgewidth=1.8,
                   label="finished late"),
        ],
    )  # fmt: skip
    axes.set_title("Who does what when", fontsize=10, color=FAINT, loc="left")


def _segments(axes: Any, leave: FloatArray, arrival: FloatArray, robot: int, colour: str) -> None:
    ends = np.stack((leave, np.full_like(leave, robot), arrival, np.full_like(leave, robot)), axis=1)
    axes.add_collection(
        LineCollection(list(ends.reshape(-1, 2, 2)), colors=colour, linewidths=1.6, alpha=0.8, zorder=2)
    )


def _load(score: Score, robot: int) -> str:
    visits = score.schedule[robot]
    return f"{sum(visit.completed for visit in visits)} of {len(visits)}"


def _legend_below(axes: Any, handles: list[Any]) -> None:
    below = -0.34 / axes.figure.get_figheight()  # inches, beyond the labels of the axis
    axes.legend(
        handles=handles, loc="upper center", bbox_to_anchor=(0.5, below), ncols=len(handles), frameon=False, fontsize=9,
        labelcolor=INK, handletextpad=0.4, columnspacing=1.4,
    )  # fmt: skip
