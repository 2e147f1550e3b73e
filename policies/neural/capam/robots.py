"""The robots that matter to a decision: the acting one and its nearest peers, with their times."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.capam.neighbourhood import distance

ROBOT_COLUMNS = ("dx", "dy", "x", "y", "wait", "capacity", "speed", "is_ego")
FAR = 1.0
"""Where durations saturate, in crossings."""


@dataclass(frozen=True, slots=True)
class Robots:
    """The R robots that matter to a decision: the acting one, then the peers that could be at its place first.

    Attributes:
        xy: (S, G, R, 2) where each is, or is heading for, in L.
        wait: (S, G, R) from now until it is free, in crossings.
        pace: (S, G, R) crossings it takes to travel L.
        rate: (S, G, R) crossings it takes for workload W.
        capacity: (S, G, R) as a share of the largest capacity.
        speed: (S, G, R) as a share of the largest speed.
        valid: (S, G, R) bool, false where there are fewer peers at work.
        working: (S, G, 1) number of peers at work, near or not.
    """

    xy: Tensor
    wait: Tensor
    pace: Tensor
    rate: Tensor
    capacity: Tensor
    speed: Tensor
    valid: Tensor
    working: Tensor

    @classmethod
    def of(cls, tasks: Tasks, states: DecisionStates, most_peers: int) -> Robots:
        """The acting robot and at most `most_peers` peers, in each of (S, G) states."""
        horizon = tasks.horizon[:, None, None]
        wait = (states.ready * horizon - states.elapsed[..., None] * horizon).clamp(min=0)
        peers, ego_xy = states.peers, states.of_ego(states.xy)
        reach = wait + distance(states.xy, ego_xy[..., None, :]) / states.speed
        # Ties, frequent on whole coordinates, are broken by the robots' values, not their order.
        kind = 2.7 * states.xy[..., 0] + 1.9 * states.xy[..., 1] + states.capacity + 1.3 * states.speed
        key = (reach.double() + 1e-6 * kind).masked_fill(~peers, torch.inf)
        count = min(most_peers, key.shape[-1] - 1)
        nearest = key.topk(count, dim=-1, largest=False).indices
        chosen = torch.cat((states.ego[..., None], nearest), -1)

        def of_robot(values: Tensor) -> Tensor:
            return values.gather(2, chosen)

        valid = torch.cat((torch.ones_like(peers[..., :1]), peers.gather(2, nearest)), -1)
        # Padding has speed and capacity 0 in observations; quotients by them would not be finite.
        capacity, speed = (of_robot(of).masked_fill(~valid, 1.0) for of in (states.capacity, states.speed))
        xy = torch.stack((of_robot(states.xy[..., 0]), of_robot(states.xy[..., 1])), -1)
        return cls(
            xy=xy,
            wait=of_robot(wait),
            pace=1.0 / speed,
            rate=tasks.work_unit[:, None, None] / capacity,
            capacity=capacity,
            speed=speed,
            valid=valid,
            working=peers.sum(-1, keepdim=True),
        )

    def first_peer(self, places: Tensor) -> Tensor:
        """(S, G, N) from now until the first of these peers could be at each of (S, N, 2) places, else infinite."""
        if self.wait.shape[-1] == 1:
            return torch.full((*self.wait.shape[:2], places.shape[1]), torch.inf, device=places.device)
        way = distance(self.xy[..., 1:, None, :], places[:, None, None]) * self.pace[..., 1:, None]
        arrival = self.wait[..., 1:, None] + way
        return arrival.masked_fill(~self.valid[..., 1:, None], torch.inf).amin(-2)

    def columns(self) -> Tensor:
        """(S, G, R, len(ROBOT_COLUMNS)), 0 where there is no robot."""
        is_ego = torch.zeros_like(self.wait)
        is_ego[..., 0] = 1.0
        columns = (
            *(self.xy - self.xy[..., :1, :]).unbind(-1), *self.xy.unbind(-1),
            self.wait.clamp(max=FAR), self.capacity, self.speed, is_ego,
        )  # fmt: skip
        return torch.stack(columns, -1) * self.valid[..., None]
