"""What pictures show of a scenario: which part of the plane, and until when."""

from __future__ import annotations

import numpy as np

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
