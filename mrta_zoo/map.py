"""The map of a mission: its size and origin, and what they are by default."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mrta_zoo.errors import ScenarioError
from mrta_zoo.quantities import BOUNDS, LARGEST, SMALLEST, FloatArray

Pair = tuple[float, float]

UNSAID: Pair = (math.nan, math.nan)
"""Stands for a map's size or origin that is not given but follows from the places on it."""
DEFAULT_SIZE: Pair = (100.0, 100.0)


def map_around(places: FloatArray, size: Any, origin: Any) -> tuple[Pair, Pair]:
    """Size and origin of the map, as given or, if `UNSAID`, as they follow from the places.

    Args:
        places: (P, 2) at least one place.
        size: the map's width and height.
        origin: the map's lowest x and y.

    Raises:
        ScenarioError: if one is given that is not two numbers in range.
    """
    if _is_unsaid(size):
        size = DEFAULT_SIZE
        if _is_unsaid(origin) and np.isfinite(places).all():
            least = np.array(map_origin_for(places, DEFAULT_SIZE))
            if not ((places >= least) & (places <= least + DEFAULT_SIZE)).all():
                size, origin = square_around(places)
    size = _pair(size, "map_size", SMALLEST, f"two finite numbers > 0{BOUNDS}")
    if _is_unsaid(origin):
        origin = map_origin_for(places, size)
    return size, _pair(origin, "map_origin", -LARGEST, f"two numbers from {-LARGEST:g} to {LARGEST:g}")


def map_origin_for(places: FloatArray, map_size: Pair) -> Pair:
    """The origin of a map of which only the size is given.

    It is (0, 0). But if a coordinate is negative, or no place would lie on the map, as with survey coordinates, it is
    the smallest whole x and y of all places, provided that the map then holds every place.

    Args:
        places: (P, 2) at least one place.
        map_size: the map's width and height.
    """
    on_map = (places <= map_size).all(axis=1)
    if (places < 0).any() or not on_map.any():
        corner = np.floor(places.min(axis=0))
        if (places <= corner + map_size).all():
            return float(corner[0]), float(corner[1])
    return 0.0, 0.0


def square_around(places: FloatArray) -> tuple[Pair, Pair]:
    """Size and origin of the map of a mission that gives neither.

    It is the smallest square with a whole side >= 1 and its corner at (0, 0) that holds every place. If a coordinate is
    negative, or that square would be more than twice as wide, the corner is at their smallest whole x and y instead.

    Args:
        places: (P, 2) at least one place.
    """

    def side(origin: FloatArray) -> float:
        return max(1.0, float(np.ceil((places - origin).max())))  # which stays a float, however large

    origin = np.zeros(2)
    corner = np.floor(places.min(axis=0))
    if corner.min() < 0 or side(origin) > 2 * side(corner):
        origin = corner
    return (side(origin),) * 2, (float(origin[0]), float(origin[1]))


def _is_unsaid(pair: Any) -> bool:
    return isinstance(pair, tuple) and len(pair) == 2 and all(isinstance(each, float) and each != each for each in pair)


def _pair(value: Any, attribute: str, least: float, expected: str) -> Pair:
    try:
        x, y = (float(each) + 0.0 for each in value)
    except (TypeError, ValueError, OverflowError):  # a whole number too large for a float
        x = y = math.nan
    if not (least <= x <= LARGEST and least <= y <= LARGEST):
        raise ScenarioError(f"{attribute} is {value!r}; expected {expected}")
    return x, y
