"""The view of a scenario: which part of the plane and of time is shown, and how many digits of times and distances."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mrta_zoo.digits import decimals
from mrta_zoo.scales import Scales, frame_of
from mrta_zoo.scenario import FloatArray, Scenario

LEAST_FILLED = 1 / 3
"""The whole map is shown if the mission takes up at least this share of its longer side."""
LEAST_SIDE = 0.25
"""The least share that the shorter side shown is of the longer one, as places may lie on a line."""


def shown_box(scenario: Scenario) -> tuple[FloatArray, FloatArray]:
    """The map or, if the mission would be lost on it, the mission's frame: lowest x and y, width and height."""
    low, extent = np.array(scenario.map_origin), np.array(scenario.map_size)
    frame = frame_of(scenario, np.ones((1, 1), dtype=np.bool_))  # of all places, also those out of reach
    if frame[1].max() < LEAST_FILLED * extent.max():
        low, extent = frame
    size = np.maximum(extent, LEAST_SIDE * extent.max())
    return low - (size - extent) / 2, size


def shown_time(scenario: Scenario, makespan: float) -> float:
    """The time until which a schedule is shown: until all is done and the latest deadline that can matter has passed.

    But at most twice the makespan, so that the schedule stays visible; later deadlines are marked at the end.

    Args:
        scenario: the mission.
        makespan: when its last task is done; 0 if none is.
    """
    latest: float = Scales.of(scenario).time
    return max(makespan, min(latest, 2 * makespan or latest))


@dataclass(frozen=True, slots=True)
class Digits:
    """Times and distances of a scenario as text, with as many digits as their units need.

    Attributes:
        of_times: digits after the point, >= 1.
        of_distances: likewise.
    """

    of_times: int
    of_distances: int

    @classmethod
    def of(cls, scenario: Scenario) -> Digits:
        """Enough digits for a median robot's way across the map and work, the median deadline, and the map's side."""
        side = float(shown_box(scenario)[1].max())
        speed, capacity, work, deadline = (
            float(np.median(each)) for each in (scenario.speed, scenario.capacity, scenario.workload, scenario.deadline)
        )
        return cls(decimals(min(side / speed + work / capacity, deadline), 1), decimals(side, 1))

    def time(self, value: float) -> str:
        """A time."""
        return _written(value, self.of_times)

    def distance(self, value: float) -> str:
        """A distance, or a coordinate."""
        return _written(value, self.of_distances)


def _written(value: float, digits: int) -> str:
    text = f"{value:.{digits}f}"
    return text if text.strip("-0.") or value == 0 else f"{value:.1g}"  # a tiny number is not shown as 0
