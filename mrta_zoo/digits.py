"""Digits of displayed numbers: enough to tell them apart, and never fewer than the whole part."""

from __future__ import annotations

import math

COUNT = 3
"""The least significant digits of the largest of some rounded numbers."""
WHOLE = 1e5
"""Numbers from here on are not rounded to six digits."""


def decimals(largest: float, least: int) -> int:
    """Digits after the point, at least `least`, that give the largest of some numbers `COUNT` significant digits."""
    return max(least, COUNT - 1 - math.floor(math.log10(largest))) if largest > 0 else least


def rounded(value: float, least: int = 1) -> str:
    """A computed number shown on its own: 12345.7, 12.3, 0.0123."""
    return f"{value:.{decimals(abs(value), least)}f}"


def full(value: float) -> str:
    """A number as it was given; a large one is not rounded to six digits."""
    return f"{value:g}" if abs(value) < WHOLE else f"{value:.12g}"


def rough(value: float) -> str:
    """A number in few digits, for a place with little room: 2, 0.333, 12345."""
    return f"{round(value, decimals(abs(value), 0)):.15g}"


def percentage(value: float, digits: int = 1) -> str:
    """A percentage without the sign: 62.3. Only 100 is shown as 100.0, and only 0 as 0.0.

    Args:
        value: 0 to 100, or just outside.
        digits: after the point; values closer than that to 0 or 100 get more.
    """
    text, rest = f"{value + 0.0:.{digits}f}", abs(100 - value)
    if float(text) == 100 and rest > 1e-9:  # less is an error of rounding
        return f"{value:.{1 - math.floor(math.log10(rest))}f}"
    return f"{value:.2g}" if float(text) == 0 and value != 0 else text


def share(value: float, digits: int = 1) -> str:
    """A share, 0 to 1, as a percentage, see `percentage`."""
    return percentage(100 * value, digits)
