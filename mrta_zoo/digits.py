"""How many digits of a number people are shown: enough to tell it from others, and never fewer than its whole part."""

from __future__ import annotations

import math

COUNT = 3
"""Digits that count, which the largest of some rounded numbers has at least."""
WHOLE = 1e5
"""Numbers from here on keep their last digits."""


def decimals(largest: float, least: int) -> int:
    """Digits after the point that leave the largest of some numbers `COUNT` digits that count, but `least` of them."""
    return max(least, COUNT - 1 - math.floor(math.log10(largest))) if largest > 0 else least


def rounded(value: float, least: int = 1) -> str:
    """A number by itself that was worked out: 12345.7, 12.3, 0.0123."""
    return f"{value:.{decimals(abs(value), least)}f}"


def full(value: float) -> str:
    """A number as it was given, of which a large one keeps its last digits."""
    return f"{value:g}" if abs(value) < WHOLE else f"{value:.12g}"


def rough(value: float) -> str:
    """A number in few digits, for a place with little room: 2, 0.333, 12345."""
    return f"{round(value, decimals(abs(value), 0)):.15g}"


def percentage(value: float, digits: int = 1) -> str:
    """A number of %, without the sign: 62.3; what is not all, or not none, is not shown as 100.0 or 0.0.

    Args:
        value: 0 to 100, or not far from it.
        digits: after the point, but for what is that near.
    """
    text, rest = f"{value + 0.0:.{digits}f}", abs(100 - value)
    if float(text) == 100 and rest > 1e-9:  # less is an error of rounding
        return f"{value:.{1 - math.floor(math.log10(rest))}f}"
    return f"{value:.2g}" if float(text) == 0 and value != 0 else text


def share(value: float, digits: int = 1) -> str:
    """A share, 0 to 1, as `percentage`."""
    return percentage(100 * value, digits)
