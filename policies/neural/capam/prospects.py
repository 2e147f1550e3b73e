"""What a robot could do next, and after that, where a task would take it: how much there is within reach."""

from __future__ import annotations

import torch
from torch import Tensor

RANGES = (0.1, 0.3)
"""Durations, in crossings, at which a task counts 1/e of one at no distance."""
PROSPECT_COLUMNS = ("near", "far", "near_first", "far_first")


def prospects(travel: Tensor, work: Tensor, start: Tensor, left: Tensor, others: Tensor, rival: Tensor) -> Tensor:
    """How many tasks lie within reach after each of some candidates, the nearer the more they count.

    Those count that the robot could finish in time if it went there next: e^(−duration / range) each, with the
    durations of travel and work, for each range of `RANGES`; and once more only those where none of some peers can be
    earlier.

    Args:
        travel: (…, K, N) from each candidate to each task; all times in crossings.
        work: (…, N) what each task takes.
        start: (…, K) from now until each candidate would be done.
        left: (…, N) from now to each deadline.
        others: (…, K, N) bool, what else than the candidate may be chosen now.
        rival: (…, N) from now until the first of those peers could be at each task; infinite without peers.

    Returns:
        (…, K, len(PROSPECT_COLUMNS)) thirds of the logarithm of one more than these counts.
    """
    arrival = start[..., None] + travel
    possible = others & (arrival + work[..., None, :] <= left[..., None, :])
    first = possible & (arrival <= rival[..., None, :])
    duration = travel + work[..., None, :]
    weight = [torch.exp(duration / -scale) for scale in RANGES]
    counts = [(each * where).sum(-1) for where in (possible, first) for each in weight]
    return torch.stack(counts, -1).log1p() / 3
