"""A mission as a picture: the map with tasks and routes, and a column that says what each robot does.

Needs matplotlib (``mrta_zoo[plot]``), which it uses without its global state, so that it draws in any thread, with
or without a display.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from mrta_zoo.extras import require
from mrta_zoo.mission import Mission
from mrta_zoo.render.style import FAINT, INK, plain
from mrta_zoo.render.whereabouts import whereabouts
from mrta_zoo.rules import Status

try:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
except ImportError:
    require("plot", "a picture")
    raise

ROBOT_COLOURS = (
    "#3b6fb6", "#d9772b", "#7a52a3", "#0f9aa8", "#c2478f", "#8a6a3a", "#5a6b7d", "#a3a12a", "#2f4b8f", "#b35c5c",
)  # fmt: skip
"""One for each robot, from the start again after the last."""

TASK_STYLE: dict[Status, dict[str, Any]] = {
    Status.ACTIVE: {"marker": "o", "s": 30, "facecolors": "white", "edgecolors": "#5f6b76", "linewidths": 1.2},
    Status.ASSIGNED: {"marker": "o", "s": 34, "facecolors": "#f6c445", "edgecolors": "#7d5f06", "linewidths": 1.0},
    Status.COMPLETED: {"marker": "o", "s": 34, "facecolors": "#3fa35b", "edgecolors": "#1d5c30", "linewidths": 1.0},
    Status.MISSED: {"marker": "X", "s": 64, "facecolors": "#d6453d", "edgecolors": "white", "linewidths": 0.7},
}
MOST_LISTED = 24


def picture(mission: Mission) -> npt.NDArray[np.uint8]:
    """(720, 1040, 3) uint8, the mission at this moment."""
    figure = draw(mission)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].copy()


def draw(mission: Mission) -> Figure:
    """The same as a matplotlib figure, to be saved in any format."""
    figure = Figure(figsize=(10.4, 7.2), dpi=100, facecolor="white")
    _draw_map(figure.add_axes((0.055, 0.06, 0.62, 0.86)), mission)
    _draw_robots(figure.add_axes((0.70, 0.06, 0.29, 0.86)), mission)
    figure.text(0.055, 0.955, mission.scenario.name, fontsize=13, fontweight="bold", color=INK)
    figure.text(0.70, 0.955, f"time {mission.time:.1f}", fontsize=13, fontweight="bold", color=INK)
    return figure


def _draw_map(axes: Any, mission: Mission) -> None:
    scenario = mission.scenario
    width, height = scenario.map_size
    margin = 0.025 * max(width, height)
    axes.set(xlim=(-margin, width + margin), ylim=(-margin, height + margin), aspect="equal")
    plain(axes)
    for robot, route in enumerate(mission.routes):
        colour = _colour(robot)
        now = whereabouts(mission, robot)
        under_way = mission.heading[robot] >= 0
        done = route[:-1] if under_way else route
        trail = np.vstack((scenario.robot_xy[robot], scenario.task_xy[done], (now.x, now.y)))
        axes.plot(*trail.T, color=colour, linewidth=1.6, alpha=0.75, zorder=2, solid_joinstyle="round")
        if under_way:
            ahead = np.vstack(((now.x, now.y), scenario.task_xy[route[-1]]))
            axes.plot(*ahead.T, color=colour, linewidth=1.6, linestyle=(0, (2, 1.5)), zorder=2)
        axes.scatter(*scenario.robot_xy[robot], marker="s", s=44, c="white", edgecolors=colour, linewidths=2, zorder=3)
    for status, style in TASK_STYLE.items():
        axes.scatter(*scenario.task_xy[mission.status == status].T, zorder=4, **style)
    for robot in range(scenario.num_robots):
        now = whereabouts(mission, robot)
        ring = INK if robot == mission.actor else "white"
        axes.scatter(now.x, now.y, s=190, c=_colour(robot), edgecolors=ring, linewidths=1.8, zorder=5)
        axes.text(
            now.x, now.y, str(robot), color="white", fontsize=8, fontweight="bold", ha="center", va="center_baseline",
            zorder=6,
        )  # fmt: skip


def _draw_robots(axes: Any, mission: Mission) -> None:
    """The legend: tasks by status, then what each robot does."""
    axes.set_axis_off()
    axes.set(xlim=(0, 1), ylim=(0, 1))
    counts = np.bincount(mission.status, minlength=len(Status))
    handles = [
        Line2D(
            [], [], linestyle="", marker=style["marker"], markersize=8, markerfacecolor=style["facecolors"],
            markeredgecolor=style["edgecolors"], label=f"{counts[status]} {status.name.lower()}",
        )
        for status, style in TASK_STYLE.items()
    ]  # fmt: skip
    handles.append(
        Line2D([], [], linestyle="", marker="s", markersize=7, markerfacecolor="white",
               markeredgecolor=INK, markeredgewidth=1.6, label="start of a robot")
    )  # fmt: skip
    legend = axes.legend(
        handles=handles, loc="upper left", frameon=False, fontsize=10, borderaxespad=0, borderpad=0,
        handletextpad=0.6, labelspacing=0.55, labelcolor=INK, title=f"{mission.scenario.num_tasks} tasks",
        alignment="left",
    )  # fmt: skip
    legend.get_title().set(fontsize=10, color=FAINT)
    listed = min(mission.scenario.num_robots, MOST_LISTED)
    step = min(0.062, 0.66 / (listed + 1))
    axes.text(0, 0.70, f"{mission.scenario.num_robots} robots", fontsize=10, color=FAINT, va="center")
    for robot in range(listed):
        height = 0.70 - (robot + 1) * step
        axes.scatter(0.045, height, s=min(190, 3200 * step), c=_colour(robot), clip_on=False)
        axes.text(0.045, height, str(robot), color="white", fontsize=7, fontweight="bold", ha="center",
                  va="center_baseline")  # fmt: skip
        acting = robot == mission.actor
        axes.text(0.12, height, _sentence(mission, robot), fontsize=min(10, 170 * step), color=INK,
                  va="center_baseline", fontweight="bold" if acting else "normal")  # fmt: skip
    if listed < mission.scenario.num_robots:
        axes.text(0.12, 0.0, f"and {mission.scenario.num_robots - listed} more", fontsize=9, color=INK)


def _sentence(mission: Mission, robot: int) -> str:
    task, until = mission.heading[robot], mission.ready[robot]
    return {
        "acting": "chooses now",
        "waiting": "is free",
        "retired": f"retired after {len(mission.routes[robot])} tasks",
        "travelling": f"to task {task}, until {until:.1f}",
        "working": f"works on task {task}, until {until:.1f}",
    }[whereabouts(mission, robot).doing]


def _colour(robot: int) -> str:
    return ROBOT_COLOURS[robot % len(ROBOT_COLOURS)]
