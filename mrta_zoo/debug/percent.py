"""Probabilities as text, in which the unlikely differs from the impossible."""

from __future__ import annotations

from mrta_zoo.digits import share

FINEST = 1e-3
"""The smallest distance from 100 % that is written out."""


def percent(probability: float, only: bool = False) -> str:
    """A probability in %, without the sign: 62.3; 99.9979 and 0.0021 rather than 100.0 and 0.0.

    Args:
        probability: 0 to 1. Because networks and traces round, 0 may stand for next to none, and 1 for nearly all.
        only: whether there was nothing else to choose, so that 1 is exact.
    """
    if probability == 0:
        return "<0.1"
    nearly_all = 100 * (1 - probability) < FINEST and not (only and probability == 1)
    return f">{100 - FINEST}" if nearly_all else share(probability)
