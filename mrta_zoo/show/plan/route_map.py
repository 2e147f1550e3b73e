"""A plan's routes on the map.

Needs matplotlib (``mrta_zoo[plot]``), which it uses without its global state. Sizes are in points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mrta_zoo.extras import importing
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import FloatArray, Scenario
from mrta_zoo.show.axes import plain
from mrta_zoo.show.lettering import fitted, places_of_labels, round_number, text_width
from mrta_zoo.show.palette import FAINT, INK, robot_colour
from mrta_zoo.show.plan.starts import PAD, SIZE, StartLabel, start_labels
from mrta_zoo.show.view import shown_box
from mrta_zoo.verify import Score

with importing("plot", "a picture"):
    from matplotlib.lines import Line2D
    from matplotlib.patheffects import withStroke
    from matplotlib.ticker import MaxNLocator

LATE = "#000000"
MOST_NUMBERED = 150
"""With more tasks than this, or more robots, they get no labels."""
MARGIN = 0.035
"""Margin around the map, as a share of its longer side."""
LABEL, TICK = 6.5, 8.0
"""Sizes of text."""
LONGEST = 60.0
"""The widest that a task's label may be."""


@dataclass(frozen=True, slots=True)
class RouteMap:
    """The map, as large as there is room for.

    Attributes:
        scenario: what was planned.
        plan: its plan.
        score: the verifier's score.
        low: the lowest x and y that it shows.
        scale: points per distance unit.
        size: width and height.
    """

    scenario: Scenario
    plan: Plan
    score: Score
    low: FloatArray
    scale: float
    size: tuple[float, float]

    @classmethod
    def of(cls, scenario: Scenario, plan: Plan, score: Score, room: tuple[float, float]) -> RouteMap:
        """The largest map that fits within a width and a height."""
        low, size = shown_box(scenario)
        margin = MARGIN * float(size.max())
        low, high = low - margin, low + size + margin
        scale = float(np.min(np.array(room) / (high - low)))
        width, height = (scale * (high - low)).tolist()
        return cls(scenario, plan, score, low, scale, (width, height))

    def left(self) -> float:
        """Room for the numbers beside the axis."""
        return max((text_width(round_number(each), TICK) for each in self._ticks(1)), default=0.0) + 12

    def draw(self, axes: Any) -> None:
        """Draw it on axes of its size."""
        high = self.low + np.array(self.size) / self.scale
        axes.set(xlim=(self.low[0], high[0]), ylim=(self.low[1], high[1]))
        plain(axes)
        for side, axis in enumerate((axes.xaxis, axes.yaxis)):
            ticks = self._ticks(side)
            axis.set_ticks(ticks, [round_number(each) for each in ticks])
        numbered = self.scenario.num_tasks <= MOST_NUMBERED
        size = 34.0 if numbered else max(4.0, 5000.0 / self.scenario.num_tasks)
        taken = np.zeros(self.scenario.num_tasks, dtype=np.bool_)
        for robot, route in enumerate(self.plan.routes):
            tasks = np.array(route, dtype=np.intp)
            taken[tasks] = True
            self._draw_way(axes, robot, tasks, arrows=numbered)
            completed = np.array([visit.completed for visit in self.score.schedule[robot]], dtype=np.bool_)
            axes.scatter(*self._xy(tasks[completed]).T, s=size, c=robot_colour(robot), edgecolors="white",
                         linewidths=0.8, zorder=4)  # fmt: skip
            axes.scatter(*self._xy(tasks[~completed]).T, s=1.6 * size, c=LATE, marker="x", linewidths=1.8, zorder=5)
        axes.scatter(*self._xy(~taken).T, s=0.7 * size, facecolors="white", edgecolors=FAINT, linewidths=1.0, zorder=3)
        starts = self._starts()
        self._draw_starts(axes, starts)
        if numbered:
            self._draw_labels(axes, taken, starts)
        axes.set_title("Routes (distance units)", fontsize=10, color=FAINT, loc="left")

    def numbered(self) -> frozenset[int]:
        """The robots labelled by number although they have names, as these have no room."""
        return frozenset(each.robot for each in self._starts() if self.scenario.robot_names and each.text.isdecimal()
                         and each.text != self.scenario.robot_name(each.robot))  # fmt: skip

    def _ticks(self, side: int) -> list[float]:
        """Round numbers along x (0) or y (1), as many as there is room for."""
        low, length = float(self.low[side]), self.size[side]
        high = low + length / self.scale
        for most in range(6, 1, -1):
            found = [float(each) for each in MaxNLocator(most).tick_values(low, high) if low <= each <= high]
            needed = (
                1.3 * max((text_width(round_number(each), TICK) for each in found), default=0.0) if side == 0 else 24.0
            )
            if needed * len(found) <= length:
                break
        return found

    def legend(self) -> list[Any]:
        """What the marks mean, as handles with labels."""
        return [
            Line2D([], [], marker="s", color="white", markerfacecolor=FAINT, markersize=9, label="start of a robot"),
            Line2D([], [], marker="o", color="white", markerfacecolor=FAINT, markersize=7, label="completed"),
            Line2D([], [], marker="x", linestyle="", color=LATE, markeredgewidth=1.8, markersize=7,
                   label="finished late"),
            Line2D([], [], marker="o", color="white", markerfacecolor="white", markeredgecolor=FAINT,
                   label="not taken"),
        ]  # fmt: skip

    def _xy(self, which: Any) -> FloatArray:
        places: FloatArray = self.scenario.task_xy[which]
        return places

    def _points(self, places: FloatArray) -> FloatArray:
        return self.scale * (places - self.low)

    def _draw_way(self, axes: Any, robot: int, tasks: Any, arrows: bool) -> None:
        """A route with an arrow head in the middle of each leg that is long enough for one."""
        way, colour = np.vstack((self.scenario.robot_xy[robot], self._xy(tasks))), robot_colour(robot)
        axes.plot(*way.T, color=colour, linewidth=1.5, alpha=0.8, zorder=2, solid_joinstyle="round")
        if not arrows:
            return
        legs = np.diff(way, axis=0)
        for place, leg in zip(way[:-1] + 0.55 * legs, legs, strict=True):
            length = float(np.hypot(*leg))
            if self.scale * length > 16.0:
                axes.annotate(
                    "", place + 0.5 * leg / (self.scale * length), place,
                    arrowprops={"arrowstyle": "-|>", "color": colour, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 11},
                    zorder=3,
                )  # fmt: skip

    def _starts(self) -> list[StartLabel]:
        if self.scenario.num_robots > MOST_NUMBERED:
            return []
        return start_labels(
            self._points(self.scenario.robot_xy), self.scenario.robot_names, self._marks(slice(None)), self.size
        )

    def _marks(self, which: Any) -> FloatArray:
        """(N, 4) what the marks of tasks cover: left, bottom, right, top."""
        tasks = self._points(self._xy(which))
        return np.hstack((tasks - 2.5, tasks + 2.5))

    def _draw_starts(self, axes: Any, starts: Sequence[StartLabel]) -> None:
        for label in starts:
            axes.text(
                *(self.scenario.robot_xy[label.robot] + np.array(label.shift) / self.scale), label.text, fontsize=SIZE,
                fontweight="bold", color="white", ha="center", va="center_baseline", zorder=9,
                bbox={"boxstyle": f"square,pad={PAD}", "facecolor": label.colour, "edgecolor": "white"},
            )  # fmt: skip

    def _draw_labels(self, axes: Any, taken: Any, starts: Sequence[StartLabel]) -> None:
        """Names or numbers of tasks where there is room; tasks that robots do go first."""
        order = np.argsort(~taken, kind="stable")
        among = self.scenario.task_names
        names = [fitted(self.scenario.task_name(task), LONGEST, LABEL, among=among) for task in order.tolist()]
        clear = np.concatenate((self._marks(order), np.reshape([each.box for each in starts], (-1, 4))))
        found = places_of_labels(self._points(self._xy(order)), names, LABEL, clear, self.size)
        for index, corner in found.items():
            if names[index]:
                axes.text(
                    *(self.low + np.array(corner) / self.scale), names[index], fontsize=LABEL, zorder=7,
                    color=INK if taken[order[index]] else FAINT,
                    path_effects=[withStroke(linewidth=1.6, foreground="white")],
                )  # fmt: skip
