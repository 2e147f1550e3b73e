"""Prospects of each candidate: how many tasks would be within reach after it."""

from __future__ import annotations

import torch
from torch import Tensor

RANGES = (0.1, 0.3)
"""Durations, in crossings, at which a task counts 1/e as much as one that takes no time."""
PROSPECT_COLUMNS = ("near", "far", "near_first", "far_first")


def prospects(travel: Tensor, work: Tensor, start: Tensor, left: Tensor, others: Tensor, rival: Tensor) -> Tensor:
    """How many tasks lie within reach after each of some candidates, the nearer the more they count.

    A task counts e^(−duration / range), its duration being travel and work, if the robot could finish it in time by
    going there next; for each range of `RANGES`. The same counts follow without tasks that a peer could reach earlier.

    Args:
        travel: (…, K, N) from each candidate to each task; all times in crossings.
        work: (…, N) what each task takes.
        start: (…, K) from now until each candidate would be done.
        left: (…, N) from now to each deadline.
        others: (…, K, N) bool, the tasks other than the candidate that may be chosen now.
        rival: (…, N) from now until the first of the peers could be at each task; infinite without peers.

    Returns:
        (…, K, len(PROSPECT_COLUMNS)) ln(1 + count) / 3 for each of these counts.
    """
    arrival = start[..., None] + travel
    possible = others & (arrival + work[..., None, :] <= left[..., None, :])
    first = possible & (arrival <= rival[..., None, :])
    duration = travel + work[..., None, :]
    weight = [torch.exp(duration / -scale) for scale in RANGES]
    counts = [(each * where).sum(-1) for where in (possible, first) for each in weight]
    return torch.stack(counts, -1).log1p() / 3
