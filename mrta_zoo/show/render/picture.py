"""A mission as a picture: the map with tasks and trails, and a panel that says what each robot does.

Needs pygame (``mrta_zoo[render]``), but no display.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pygame

from mrta_zoo.mission import Mission
from mrta_zoo.rules import Status
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.palette import FAINT, GROUND, INK, MISSED, URGENCY, blend, robot_colour
from mrta_zoo.show.render.canvas import Canvas, Point, fitted, text_width
from mrta_zoo.show.render.panel import draw_panel
from mrta_zoo.show.render.whereabouts import whereabouts
from mrta_zoo.show.view import Digits, shown_box, shown_time

SIZE = (1040, 720)
"""Width and height in pixels; both even, as video formats require."""

_LEFT, _TOP, _WIDTH, _HEIGHT = 40.0, 52.0, 636.0, 636.0
_PANEL_LEFT = 704.0
_MOST_NUMBERED = 150
"""The most tasks that get their number or name on the map."""
_LONGEST_NAME = 64.0
"""The widest that the name of a task on the map may be, in pixels."""
_RECENT_LEGS = 4
"""The last legs of each trail, drawn fainter with age; all earlier ones are as faint as the oldest of them."""


def draw(mission: Mission) -> pygame.Surface:
    """The mission at this moment, with robots in transit where they are now; 1040 × 720 pixels."""
    canvas = Canvas(SIZE, "#ffffff")
    frame = _Frame.around(mission.scenario)
    name = mission.scenario.name
    canvas.text(fitted(name, name[:48], 25, _PANEL_LEFT - _LEFT - 20), (_LEFT, 27), 25, INK)
    canvas.text(f"time {Digits.of(mission.scenario).time(mission.time)}", (_PANEL_LEFT, 27), 25, INK)
    _draw_ground(canvas, frame)
    detail = min(1.0, max(0.45, 11.0 / mission.scenario.num_tasks**0.5))  # smaller marks where there are many
    here = [whereabouts(mission, robot) for robot in range(mission.scenario.num_robots)]
    places = [frame.pixel((each.x, each.y)) for each in here]
    for robot, place in enumerate(places):
        _draw_trail(canvas, frame, mission, robot, place, detail)
    _draw_tasks(canvas, frame, mission, detail)
    crowd = 1.0 if mission.scenario.num_robots <= 20 else 0.72
    for robot in sorted(range(len(places)), key=lambda robot: robot == mission.actor):  # the actor on top
        place = places[robot]
        if robot == mission.actor:
            canvas.disc(place, 13.5 * crowd, "#ffffff", INK, 2.0)
        canvas.disc(place, 10.0 * crowd, robot_colour(robot), "#ffffff", 1.2)
        canvas.text(str(robot), place, 15 * crowd if robot < 100 else 11 * crowd, "#ffffff", align=0.5)
    draw_panel(canvas, mission, [each.doing for each in here], _PANEL_LEFT, SIZE[1] - 12.0)
    return canvas.finished()


@dataclass(frozen=True, slots=True)
class _Frame:
    """The part of the plane shown, by its lowest x and y and size; pixels per distance unit; its lower left pixel."""

    low: tuple[float, float]
    size: tuple[float, float]
    scale: float
    corner: Point

    @classmethod
    def around(cls, scenario: Scenario) -> _Frame:
        (x, y), (width, height) = (each.tolist() for each in shown_box(scenario))
        scale = min(_WIDTH / width, _HEIGHT / height)
        corner = _LEFT + (_WIDTH - scale * width) / 2, _TOP + (_HEIGHT + scale * height) / 2
        return cls((x, y), (width, height), scale, corner)

    def pixel(self, place: tuple[float, float]) -> Point:
        (x, y), (left, bottom) = self.low, self.corner
        return (left + self.scale * (place[0] - x), bottom - self.scale * (place[1] - y))


def _draw_ground(canvas: Canvas, frame: _Frame) -> None:
    margin = 12.0
    (left, bottom), (low_x, low_y) = frame.corner, frame.low
    right, top = frame.pixel((low_x + frame.size[0], low_y + frame.size[1]))
    canvas.rectangle((left - margin, top - margin), (right - left + 2 * margin, bottom - top + 2 * margin), GROUND)
    step = _round_step(max(frame.size) / 5)
    written = 0.0  # how far along the numbers below already reach
    for x in _round_numbers(low_x, frame.size[0], step):
        at, width = frame.pixel((x, low_y))[0], text_width(_written(x), 14)
        canvas.line((at, top - margin), (at, bottom + margin), "#ffffff", 1.5)
        if at - width / 2 > written:
            canvas.text(_written(x), (at, bottom + margin + 9), 14, FAINT, align=0.5)
            written = at + width / 2 + 6
    for y in _round_numbers(low_y, frame.size[1], step):
        at = frame.pixel((low_x, y))[1]
        canvas.line((left - margin, at), (right + margin, at), "#ffffff", 1.5)
        inside = text_width(_written(y), 14) > left - margin - 4  # long numbers have no room beside the map
        place = (left - margin + 3, at - 8) if inside else (left - margin - 4, at)
        canvas.text(_written(y), place, 14, FAINT, align=0.0 if inside else 1.0)


def _draw_trail(canvas: Canvas, frame: _Frame, mission: Mission, robot: int, now: Point, detail: float) -> None:
    """Where a robot came from, fainter with age, and where it is heading, dashed."""
    scenario, route = mission.scenario, mission.routes[robot]
    colour, start = robot_colour(robot), frame.pixel(tuple(scenario.robot_xy[robot].tolist()))
    under_way = mission.heading[robot] >= 0
    stops = [frame.pixel(tuple(scenario.task_xy[task].tolist())) for task in route]
    trail = [start, *(stops[:-1] if under_way else stops), now]
    for leg, (begin, end) in enumerate(pairwise(trail)):
        age = min(len(trail) - 2 - leg, _RECENT_LEGS)
        canvas.line(begin, end, blend((colour, GROUND), 0.15 + 0.6 * age / _RECENT_LEGS), 2.2 * detail)
    if under_way:
        canvas.dashes(now, stops[-1], colour, 2.2 * detail)
    canvas.square(start, 11.0 * max(detail, 0.6), "#ffffff", blend((colour, GROUND), 0.3), 2.0)


def _draw_tasks(canvas: Canvas, frame: _Frame, mission: Mission, detail: float) -> None:
    scenario = mission.scenario
    horizon = shown_time(scenario, 0.0)
    numbered = scenario.num_tasks <= _MOST_NUMBERED
    for task, (status, by) in enumerate(zip(mission.status.tolist(), mission.taken_by.tolist(), strict=True)):
        place = frame.pixel(tuple(scenario.task_xy[task].tolist()))
        if status == Status.ACTIVE:
            left = (float(scenario.deadline[task]) - mission.time) / horizon
            canvas.disc(place, 6.0 * detail, blend(URGENCY, left), FAINT, 1.2 * detail)
        elif status == Status.ASSIGNED:
            canvas.disc(place, 7.5 * detail, "#ffffff", robot_colour(by), 2.6 * detail)
        elif status == Status.COMPLETED:
            canvas.disc(place, 4.2 * detail, robot_colour(by), "#ffffff", 0.8 * detail)
        else:
            canvas.cross(place, 4.2 * detail, MISSED, 2.2 * detail)
        if numbered:
            name = fitted(scenario.task_name(task), str(task), 13, _LONGEST_NAME, scenario.task_names)
            left = place[0] + 6 + text_width(name, 13) > _PANEL_LEFT  # or it would run into the panel
            canvas.text(name, (place[0] - 6 if left else place[0] + 6, place[1] - 8), 13, FAINT, align=float(left))


def _round_numbers(low: float, size: float, step: float) -> list[float]:
    """The multiples of a step within a range, including its ends."""
    first, last = np.ceil(low / step - 0.01), np.floor((low + size) / step + 0.01)
    return [step * number + 0.0 for number in np.arange(first, last + 1).tolist()]  # which is never -0.0


def _written(value: float) -> str:
    return f"{value:.15g}"


def _round_step(about: float) -> float:
    """1, 2 or 5 times a power of ten, near `about`."""
    power = 10.0 ** np.floor(np.log10(about))
    return float(power * min((1.0, 2.0, 5.0, 10.0), key=lambda step: abs(step * power - about)))
