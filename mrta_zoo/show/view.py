"""What is shown of a scenario: which part of the plane, until when, and how many digits of its times and distances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mrta_zoo.digits import decimals
from mrta_zoo.scales import Scales, frame_of
from mrta_zoo.scenario import FloatArray, Scenario

LEAST_FILLED = 1 / 3
"""Of a map that is shown as a whole: how much of its longer side the mission takes up."""
LEAST_SIDE = 0.25
"""Of the shorter side, as a share of the longer one; places may lie on a line."""


def shown_box(scenario: Scenario) -> tuple[FloatArray, FloatArray]:
    """The map or, where the mission would be lost on it, where the mission is: lowest x and y, width and height."""
    low, extent = np.array(scenario.map_origin), np.array(scenario.map_size)
    frame = frame_of(scenario, np.ones((1, 1), dtype=np.bool_))  # of all places, also those out of reach
    if frame[1].max() < LEAST_FILLED * extent.max():
        low, extent = frame
    size = np.maximum(extent, LEAST_SIDE * extent.max())
    return low - (size - extent) / 2, size


def shown_time(scenario: Scenario, makespan: float) -> float:
    """Until when a schedule is shown: until all is done, and until the latest deadline that can matter.

    But not for longer than twice the time in which all is done, so that the schedule is seen; later deadlines are
    marked at the end.

    Args:
        scenario: the mission.
        makespan: when its last task is done; 0 if none is.
    """
    latest: float = Scales.of(scenario).time
    return max(makespan, min(latest, 2 * makespan or latest))


@dataclass(frozen=True, slots=True)
class Digits:
    """Times and distances of a scenario as text, in as many digits as their units ask for.

    Attributes:
        of_times: digits after the point, >= 1.
        of_distances: likewise.
    """

    of_times: int
    of_distances: int

    @classmethod
    def of(cls, scenario: Scenario) -> Digits:
        """Those that tell apart what half of the robots do on the map, and half of the deadlines."""
        side = float(shown_box(scenario)[1].max())
        speed, capacity, work, deadline = (
            float(np.median(each)) for each in (scenario.speed, scenario.capacity, scenario.workload, scenario.deadline)
        )
        return cls(decimals(min(side / speed + work / capacity, deadline), 1), decimals(side, 1))

    def time(self, value: float) -> str:
        """A time."""
        return _written(value, self.of_times)

    def distance(self, value: float) -> str:
        """A distance, or a place along an axis."""
        return _written(value, self.of_distances)


def _written(value: float, digits: int) -> str:
    text = f"{value:.{digits}f}"
    return text if text.strip("-0.") or value == 0 else f"{value:.1g}"  # what is next to nothing is not nothing
