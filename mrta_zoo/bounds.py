"""Checks of options that are numbers or ranges of numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from mrta_zoo.errors import ConfigError

MOST = 1_000_000
"""The most tasks or robots of a drawn scenario; more would exhaust memory before the mistake is noticed."""

MAX_SEED = 2**63 - 1
"""The largest seed that every random generator in use accepts."""

MAX_THREADS = 1024
"""More than any machine can use; torch fails if asked for more threads than the system can start."""


def is_number(value: object) -> bool:
    """Whether a value is a finite number; True and False are not."""
    if not isinstance(value, (int, float, np.integer, np.floating)) or isinstance(value, bool):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer larger than any float
        return False


def as_finite(field: str, value: Any) -> float:
    """The value of an option that must be a finite number.

    Raises:
        ConfigError: if it is not.
    """
    if not is_number(value):
        raise ConfigError(f"{field} is {value!r}; expected a finite number")
    return float(value)


def check_seed(seed: int) -> None:
    """Check a seed given on the command line, to a solver or to a training run.

    Raises:
        ConfigError: if it is out of range.
    """
    if not 0 <= seed <= MAX_SEED:
        raise ConfigError(f"seed is {seed}; expected a whole number from 0 to {MAX_SEED}")


def check_threads(threads: int, least: int) -> None:
    """Check a number of CPU threads.

    Raises:
        ConfigError: if it is less than `least` or more than `MAX_THREADS`.
    """
    if not least <= threads <= MAX_THREADS:
        raise ConfigError(f"threads is {threads}; expected a whole number from {least} to {MAX_THREADS}")


def as_range(field: str, value: Any, positive: bool) -> tuple[float, float]:
    """(lowest, highest), >= 0 or > 0, from a pair or a single number.

    Raises:
        ConfigError: if it is neither, out of range or out of order.
    """
    pair = _pair(value)
    if pair is None or pair[0] > pair[1] or pair[0] < 0 or (positive and pair[0] == 0):
        bound = "> 0" if positive else ">= 0"
        raise ConfigError(f"{field} is {value!r}; expected (lowest, highest), finite numbers {bound} in order")
    return float(pair[0]), float(pair[1])


def as_count_range(field: str, value: Any) -> tuple[int, int]:
    """(lowest, highest), whole numbers from 1 to `MOST`, from a pair or a single number.

    Raises:
        ConfigError: if it is neither, out of range or out of order.
    """
    pair = _pair(value)
    if pair is None or pair[0] > pair[1] or pair[0] < 1 or any(end != int(end) for end in pair):
        raise ConfigError(f"{field} is {value!r}; expected (lowest, highest), whole numbers >= 1 in order")
    if pair[1] > MOST:
        raise ConfigError(f"{field} is {value!r}; expected (lowest, highest), whole numbers from 1 to {MOST}")
    return int(pair[0]), int(pair[1])


def as_sides(value: Any) -> tuple[float, float]:
    """(width, height) of a map, from a pair or a single number.

    Raises:
        ConfigError: if it is neither, or a side is not > 0.
    """
    pair = _pair(value)
    if pair is None or pair[0] <= 0 or pair[1] <= 0:
        raise ConfigError(f"map_size is {value!r}; expected (width, height), finite numbers > 0")
    return float(pair[0]), float(pair[1])


def _pair(value: Any) -> tuple[Any, Any] | None:
    """(lowest, highest) from a pair or from a single number, None if it is neither."""
    if is_number(value):
        return value, value
    if isinstance(value, Sequence) and len(value) == 2 and all(is_number(end) for end in value):
        return value[0], value[1]
    return None
