"""A run's streams of random numbers: none depends on how much was drawn from the others."""

from __future__ import annotations

from enum import IntEnum

import numpy as np


class Stream(IntEnum):
    """What is drawn. The numbers are part of what a seed means."""

    UPDATES = 0
    """The scenarios, or plans, of each update."""
    VALIDATION = 1
    """The validation scenarios."""
    PLANS = 2
    """The scenarios of the plans to imitate."""
    POOLS = 3
    """The plans whose decisions are in each pool."""


def random_numbers(seed: int, stream: Stream, *of: int) -> np.random.Generator:
    """A generator of a run's random numbers.

    Args:
        seed: of the run.
        stream: what is drawn.
        of: which one of them, such as the number of the update.
    """
    return np.random.default_rng((seed, int(stream), *of))
