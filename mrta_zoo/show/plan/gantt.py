"""A plan's schedule as a Gantt chart, in which a line joins each task to its deadline.

Needs matplotlib (``mrta_zoo[plot]``), which it uses without its global state. Heights are in points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mrta_zoo.extras import importing
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.axes import plain
from mrta_zoo.show.lanes import deadline_lanes
from mrta_zoo.show.lettering import fitted, round_number, text_width
from mrta_zoo.show.palette import FAINT, GROUND, INK, robot_colour
from mrta_zoo.show.view import shown_time
from mrta_zoo.verify import Score, Visit

with importing("plot", "a picture"):
    from matplotlib.collections import LineCollection
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    from matplotlib.patheffects import withStroke

LATE = "#000000"
BAR, APART, LANE = 20.0, 9.0, 3.0
"""Heights of bars, of gaps between robots, and of lanes for lines; where there is room, up to twice as much."""
FARTHEST = 70.0
"""The widest gap between robots, however few."""
THINNEST_LANE = 1.2
"""In lanes thinner than this, lines would run into each other: deadlines are then ticks that no line joins to tasks."""
TICKS = 5.0
"""Height of such ticks."""
NAME, LABEL = 9.0, 7.0
"""Sizes of text."""
LONGEST = 150.0
"""The widest that a robot's name may be."""
HIGH = 600.0
"""A chart higher than this has numbers along its top, too."""
LEAST_FOR_NAME, LEAST_FOR_BOTH = 5.5, 22.0
"""Least heights of a row that has room for the robot's name, and also for its numbers of tasks."""


@dataclass(frozen=True, slots=True)
class Schedule:
    """The chart: the heights of its parts, and how it is drawn.

    Attributes:
        scenario: what was planned.
        score: the verifier's score of the plan.
        end: where the axis of time ends; deadlines beyond are marked at its end.
        lanes: for each robot, the lanes of its tasks' lines to their deadlines, see `lanes.deadline_lanes`.
        bar: height of a bar.
        apart: gap between the rows of two robots.
        lane: height of a lane; 0 if deadlines are mere ticks.
        numbered: robots whose number precedes their name, as the map has no room for the name.
    """

    scenario: Scenario
    score: Score
    end: float
    lanes: list[list[int]]
    bar: float = BAR
    apart: float = APART
    lane: float = LANE
    numbered: frozenset[int] = frozenset()

    @classmethod
    def of(cls, scenario: Scenario, score: Score, least: float, most: float) -> Schedule:
        """A chart no higher than `most` and, unless that would stretch it too much, no lower than `least`."""
        end = shown_time(scenario, score.makespan)
        chart = cls(scenario, score, end, [deadline_lanes(visits) for visits in score.schedule])
        natural = chart.height
        if natural < least:
            larger = min(least / natural, 2.0)
            chart = replace(chart, bar=BAR * min(larger, 1.5), lane=LANE * larger)
            return replace(chart, apart=min(APART + (least - chart.height) / scenario.num_robots, FARTHEST))
        if natural <= most:
            return chart
        count = sum(sum(chart._counts(robot)) for robot in range(scenario.num_robots))
        lane = (most - (natural - LANE * count)) / max(count, 1)
        if lane >= THINNEST_LANE:
            return replace(chart, lane=lane)
        chart = replace(chart, lane=0.0)
        share = min(most / chart.height, 1.0)
        return replace(chart, bar=BAR * share, apart=APART * share)

    @property
    def height(self) -> float:
        """Height of all rows together."""
        return sum(self._row(robot) for robot in range(self.scenario.num_robots))

    def left(self) -> float:
        """Room for the names of robots."""
        return max(text_width(line, NAME, "bold") for each in self._names() for line in each.split("\n")) + 6

    def draw(self, axes: Any, width: float) -> None:
        """Draw it on axes of this width and of its `height`."""
        low, high = -0.005 * self.end, 1.012 * self.end
        scale = width / (high - low)
        axes.set(xlim=(low, high), ylim=(self.height, 0.0))
        plain(axes)
        axes.grid(axis="y", visible=False)
        middles, top = [], 0.0
        for robot in range(self.scenario.num_robots):
            base = top + self.apart / 2 + self.lane * self._counts(robot)[0]
            middles.append(base + self.bar / 2)
            if self.score.schedule[robot]:
                self._draw_row(axes, robot, base, scale)
            top += self._row(robot)
        self._draw_names(axes, middles)
        axes.xaxis.set_major_formatter(lambda value, _: round_number(value))
        axes.xaxis.set_tick_params(labeltop=self.height > HIGH)
        axes.set_xlabel("time units", color=FAINT, fontsize=9)
        axes.set_title("Who does what when", fontsize=10, color=FAINT, loc="left")

    def legend(self) -> list[Any]:
        """What the marks mean, as handles with labels."""
        known_as = "name" if self.scenario.task_names else "number"
        joined = "from a bar to the task's deadline" if self.lane else "deadlines of the robot's tasks"
        return [
            Line2D([], [], color=FAINT, linewidth=1.6, label="travel"),
            Patch(facecolor=FAINT, edgecolor=FAINT, label=f"work ({known_as} of the task)"),
            Line2D([0, 1], [0, 0], color=FAINT, linewidth=0.8 if self.lane else 0.0, marker="|", markevery=[1],
                   markersize=7, markeredgewidth=1.8, label=joined),
            Line2D([], [], color=LATE, marker="x", linestyle="", markersize=6, markeredgewidth=1.6,
                   label="finished late"),
        ]  # fmt: skip

    def _counts(self, robot: int) -> tuple[int, int]:
        """How many lanes lie above a robot's bars, and below."""
        both = list(zip(self.score.schedule[robot], self.lanes[robot], strict=True))
        above, below = (
            max((lane for visit, lane in both if visit.completed == in_time), default=-1) + 1
            for in_time in (False, True)
        )
        return above, below

    def _row(self, robot: int) -> float:
        return self.bar + self.apart + (self.lane * sum(self._counts(robot)) if self.lane else TICKS * self.bar / BAR)

    def _names(self) -> list[str]:
        least = min(self._row(robot) for robot in range(self.scenario.num_robots))
        if least < LEAST_FOR_NAME:
            return [""] * self.scenario.num_robots
        scenario, names = self.scenario, []
        for robot in range(scenario.num_robots):
            number = f"{robot}: " if robot in self.numbered else ""
            room = LONGEST - text_width(number, NAME, "bold")
            names.append(number + fitted(scenario.robot_name(robot), room, NAME, "bold", scenario.robot_names))
        if least < LEAST_FOR_BOTH:
            return names
        return [f"{name}\n{_load(visits)}" for name, visits in zip(names, self.score.schedule, strict=True)]

    def _draw_names(self, axes: Any, middles: list[float]) -> None:
        size = min(NAME, 0.8 * min(self._row(robot) for robot in range(len(middles))))
        axes.set_yticks(middles, self._names())
        for robot, label in enumerate(axes.get_yticklabels()):
            label.set(color=robot_colour(robot), fontweight="bold", fontsize=size)

    def _draw_row(self, axes: Any, robot: int, base: float, scale: float) -> None:
        visits, colour = self.score.schedule[robot], robot_colour(robot)
        arrival = np.array([visit.arrival for visit in visits])
        finish = np.array([visit.finish for visit in visits])
        late = np.array([not visit.completed for visit in visits])
        leave, middle = np.concatenate(([0.0], finish[:-1])), np.full(len(visits), base + self.bar / 2)
        ends = np.stack((leave, middle, arrival, middle), axis=1)
        axes.add_collection(
            LineCollection(list(ends.reshape(-1, 2, 2)), colors=colour, linewidths=1.6, alpha=0.8, zorder=2)
        )
        wide = scale * (finish - arrival) > 2.5  # an edge in the background's colour separates bars that touch
        looks = ((~late & wide, colour, GROUND), (~late & ~wide, colour, colour), (late, "white", LATE))
        for which, face, edge in looks:
            if not which.any():
                continue
            axes.bar(
                arrival[which], self.bar, (finish - arrival)[which], base, align="edge", color=face, edgecolor=edge,
                linewidth=1.0, hatch="////" if face == "white" else None, zorder=3,
            )  # fmt: skip
        self._draw_deadlines(axes, robot, base, colour)
        for visit in visits:
            self._write(axes, visit, base + self.bar / 2, scale * (visit.finish - visit.arrival) - 4.0)

    def _write(self, axes: Any, visit: Visit, middle: float, room: float) -> None:
        """The name of a task in its bar, upright or on its side, if there is room for it."""
        name, height = self.scenario.task_name(visit.task), self.bar - 4.0
        among = self.scenario.task_names
        upright = fitted(name, room, LABEL, among=among) if height >= LABEL - 2.0 else ""
        turned = fitted(name, height, LABEL, among=among) if room >= LABEL and upright != name else ""
        on_its_side = len(turned) > len(upright)
        written = turned if on_its_side else upright
        if written:
            axes.text(
                (visit.arrival + visit.finish) / 2, middle, written, fontsize=LABEL, ha="center",
                va="center" if on_its_side else "center_baseline", rotation=90 if on_its_side else 0,
                color="white" if visit.completed else INK, zorder=6, clip_on=True,
                path_effects=[] if visit.completed else [withStroke(linewidth=3, foreground="white")],
            )  # fmt: skip

    def _draw_deadlines(self, axes: Any, robot: int, base: float, colour: str) -> None:
        """A tick for each deadline, joined to the end of its task's bar; those beyond the axis are at its end."""
        visits, bottom = self.score.schedule[robot], base + self.bar
        above, below = self._counts(robot)
        lines, due, at = [], [], []
        for visit, lane in zip(visits, self.lanes[robot], strict=True):
            if visit.completed:
                side, place = bottom, bottom + self.lane * (below - lane - 0.2)
            else:
                side, place = base, base - self.lane * (above - lane - 0.4)
            due.append(min(visit.deadline, self.end))
            at.append(place if self.lane else bottom + 0.6 * TICKS * self.bar / BAR)
            lines.append([(visit.finish, side), (visit.finish, place), (due[-1], place)])
        half = 0.4 * min(self.lane, 5.0) if self.lane else 0.4 * TICKS * self.bar / BAR
        places, heights = np.array(due), np.array(at)
        if self.lane:
            axes.add_collection(
                LineCollection(lines, colors=colour, linewidths=min(0.8, 0.4 * self.lane), alpha=0.7, zorder=2.5)
            )
        axes.vlines(places, heights - half, heights + half, color=colour, linewidth=1.8, zorder=3)
        beyond = np.array([visit.deadline > self.end for visit in visits])
        if beyond.any():
            axes.scatter(places[beyond], heights[beyond], marker=">", s=30, color=colour, zorder=3, clip_on=False)
        late = np.array([not visit.completed for visit in visits])
        if late.any():
            finish = np.array([visit.finish for visit in visits])[late]
            crosses = heights[late] if self.lane else np.full(len(finish), base)
            axes.scatter(finish, crosses, marker="x", s=22, c=LATE, linewidths=1.6, zorder=5)


def _load(visits: Sequence[Visit]) -> str:
    return f"{sum(visit.completed for visit in visits)} of {len(visits)}"
