"""Each task's nearest tasks, found once per mission."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from mrta_zoo.policies.neural.capam.inputs import Tasks

NEIGHBOURS = 12


@dataclass(frozen=True, slots=True)
class Neighbourhood:
    """Each task's nearest tasks; fixed for a mission.

    Attributes:
        index: (S, N, J) int64 the nearest tasks, the nearest first.
        distance: (S, N, J) how far, in L; infinite for padding.
    """

    index: Tensor
    distance: Tensor

    @classmethod
    def of(cls, tasks: Tasks) -> Neighbourhood:
        """The `NEIGHBOURS` nearest tasks of each task, or as many as there are."""
        apart = distance(tasks.xy[:, :, None], tasks.xy[:, None, :])
        n = apart.shape[-1]
        blocked = ~tasks.exists[:, None, :] | torch.eye(n, dtype=torch.bool, device=apart.device)
        apart = apart.masked_fill(blocked, torch.inf)
        key = apart.double() + 1e-6 * kind(tasks)[:, None, :]
        index = key.topk(min(NEIGHBOURS, n), dim=-1, largest=False).indices
        return cls(index, apart.gather(2, index))


def kind(tasks: Tasks) -> Tensor:
    """(S, N) float64 numbers that break ties, frequent on whole coordinates, by the tasks' values, not their order."""
    return tasks.deadline.double() + 2.7 * tasks.xy[..., 0] + 1.9 * tasks.xy[..., 1] + 1.3 * tasks.workload


def distance(a: Tensor, b: Tensor) -> Tensor:
    """(…) distances between (…, 2) places."""
    return (a - b).square().sum(-1).sqrt()
