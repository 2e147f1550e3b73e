"""Probabilities in words for people, in which what is unlikely differs from what is impossible."""

from __future__ import annotations

from mrta_zoo.digits import share

FINEST = 1e-3
"""The least distance from 100 % that is written out."""


def percent(probability: float, only: bool = False) -> str:
    """A probability in %, without the sign: 62.3; 99.9979 and 0.0021 rather than 100.0 and 0.0.

    Args:
        probability: 0 to 1. As networks compute and traces round, 0 stands for next to none, and 1 for nearly all.
        only: there was nothing else to choose, so that 1 is 1.
    """
    if probability == 0:
        return "<0.1"
    nearly_all = 100 * (1 - probability) < FINEST and not (only and probability == 1)
    return f">{100 - FINEST}" if nearly_all else share(probability)
