"""Probabilities in words for people, in which what is unlikely differs from what is impossible."""

from __future__ import annotations

import math

FINEST = 1e-3
"""The least distance from 100 % that is written out."""


def percent(probability: float, only: bool = False) -> str:
    """A probability in %, without the sign: 62.3; 99.9979 and 0.0021 rather than 100.0 and 0.0.

    Args:
        probability: 0 to 1. As networks compute and traces round, 0 stands for next to none, and 1 for nearly all.
        only: there was nothing else to choose, so that 1 is 1.
    """
    text = f"{100 * probability:.1f}"
    if text not in ("0.0", "100.0") or (only and probability == 1):
        return text
    if text == "0.0":
        return f"{100 * probability:.2g}" if probability > 0 else "<0.1"
    rest = 100 * (1 - probability)
    if rest == 0:
        return ">99.9"
    if rest < FINEST:
        return ">99.999"
    return f"{100 - rest:.{1 - math.floor(math.log10(rest))}f}"
