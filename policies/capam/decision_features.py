"""Decision-time features of each (robot to act, task) pair: what a good dispatcher looks at.

Ours, not the paper's; networks use them if their configuration says so.
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from mrta_zoo.policies.capam.inputs import Moments, Tasks

FEATURES = ("travel", "work", "slack", "left", "head_start", "next_gap", "next_count", "reach")
NEIGHBOURS = 12
FAR = 1.0
"""Where durations saturate, in crossings."""


@dataclass(frozen=True, slots=True)
class Neighbourhood:
    """Each task's nearest tasks; fixed for a mission.

    Attributes:
        index: (S, N, J) int64 the nearest tasks, the nearest first.
        distance: (S, N, J) how far, in L; infinite for padding.
    """

    index: Tensor
    distance: Tensor

    def select(self, index: Tensor) -> Neighbourhood:
        """The neighbourhoods of some of the scenarios."""
        return Neighbourhood(self.index[index], self.distance[index])

    @classmethod
    def of(cls, tasks: Tasks) -> Neighbourhood:
        """The `NEIGHBOURS` nearest tasks of each task, or as many as there are."""
        offset = tasks.xy[:, :, None] - tasks.xy[:, None, :]
        distance = offset.square().sum(-1).sqrt()
        n = distance.shape[-1]
        blocked = ~tasks.exists[:, None, :] | torch.eye(n, dtype=torch.bool, device=distance.device)
        distance = distance.masked_fill(blocked, torch.inf)
        # Ties, frequent on whole coordinates, are broken by what the tasks are, not by how they are numbered.
        kind = tasks.deadline.double() + 2.7 * tasks.xy[..., 0] + 1.9 * tasks.xy[..., 1] + 1.3 * tasks.workload
        key = distance.double() + 1e-6 * kind[:, None, :]
        index = key.topk(min(NEIGHBOURS, n), dim=-1, largest=False).indices
        return cls(index, distance.gather(2, index))


def decision_features(tasks: Tasks, near: Neighbourhood, moments: Moments) -> Tensor:
    """(S, G, N, 8) features, in crossings and saturating at `FAR`, in the order of `FEATURES`:

    - travel: time to get there; work: time to do it;
    - slack: from the finish to the deadline; left: from now to the deadline (half scale, saturating at 2 `FAR`);
    - head_start: by how much this robot would be there before the earliest peer could (−FAR to FAR; FAR if alone);
    - next_gap: time from the task to the nearest of its neighbours that could still be done after it;
    - next_count: which share of its neighbours could still be done after it;
    - reach: time to the farthest task to be chosen now, the same for all tasks (how spread the choices are).
    """
    horizon = tasks.horizon[:, None, None]
    task_xy = tasks.xy[:, None]
    deadline = tasks.deadline[:, None] * horizon
    elapsed = (moments.elapsed * tasks.horizon[:, None])[..., None]
    speed = moments.of_ego(moments.speed)[..., None]
    work_rate = (tasks.work_unit[:, None] / moments.of_ego(moments.capacity))[..., None]

    own_offset = task_xy - moments.of_ego(moments.xy)[..., None, :]
    travel = own_offset.square().sum(-1).sqrt() / speed
    work = tasks.workload[:, None] * work_rate
    finish = elapsed + travel + work

    peer_offset = task_xy[:, :, None] - moments.xy[..., None, :]
    peer_travel = peer_offset.square().sum(-1).sqrt() / moments.speed[..., None]
    peer_arrival = moments.ready[..., None] * horizon[..., None] + peer_travel
    peer_arrival = peer_arrival.masked_fill(~moments.peers[..., None], torch.inf).amin(-2)
    head_start = (peer_arrival - elapsed - travel).clamp(-FAR, FAR)

    # Of what this robot may choose, what could it still do after each task?
    s, g, n = travel.shape
    j = near.index.shape[-1]
    flat = near.index.reshape(s, 1, n * j).expand(s, g, n * j)
    next_travel = near.distance[:, None] / speed[..., None]
    next_finish = finish[..., None] + next_travel + work.gather(2, flat).view(s, g, n, j)
    next_deadline = deadline.expand(s, g, n).gather(2, flat).view(s, g, n, j)
    free = moments.mask.gather(2, flat).view(s, g, n, j)
    possible = free & (next_finish <= next_deadline)
    next_gap = next_travel.expand_as(possible).masked_fill(~possible, FAR).amin(-1).clamp(max=FAR)
    neighbours = torch.isfinite(near.distance).sum(-1)[:, None].clamp(min=1)
    next_count = possible.sum(-1) / neighbours

    reach = travel.masked_fill(~moments.mask, 0.0).amax(-1, keepdim=True).expand_as(travel)
    columns = (
        travel.clamp(max=FAR),
        work.clamp(max=FAR),
        (deadline - finish).clamp(-FAR, FAR),
        ((deadline - elapsed) / 2).clamp(-FAR, FAR),
        head_start,
        next_gap,
        next_count,
        reach.clamp(max=FAR),
    )
    return torch.stack(columns, -1)
