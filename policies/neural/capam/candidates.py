"""What a good dispatcher looks at when a robot is to choose: the tasks within reach, the peers near by, and times.

Ours, not the paper's. Times are in crossings (`mrta_zoo.policies.neural.capam.inputs`).
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from mrta_zoo.policies.neural.capam.inputs import USUAL_CROSSINGS, DecisionStates, Tasks
from mrta_zoo.policies.neural.capam.neighbourhood import Neighbourhood, kind
from mrta_zoo.policies.neural.capam.prospects import PROSPECT_COLUMNS, prospects

TASK_COLUMNS = (
    "dx", "dy", "x", "y", "travel", "work", "slack", "tightness", "left", "head_start", "second_head_start", "rivals",
    "next_gap", "second_gap", "next_count", "rank", *PROSPECT_COLUMNS,
)  # fmt: skip
ROBOT_COLUMNS = ("dx", "dy", "x", "y", "wait", "capacity", "speed", "is_ego")
MISSION_COLUMNS = ("elapsed", "horizon", "work_unit", "free_share", "free_a_robot", "time_left")
PAIR_COLUMNS = 5
FAR = 1.0
"""Where durations saturate, in crossings."""


@dataclass(frozen=True, slots=True)
class Candidates:
    """K tasks that a robot may choose, and the R robots that matter: itself, then the peers nearest to it.

    Attributes:
        index: (S, G, K) int64 the tasks.
        valid: (S, G, K) bool, false where there are fewer than K.
        task: (S, G, K, len(TASK_COLUMNS)) what is known of each:
            where it lies from the robot, and on the map (dx, dy, x, y, in L);
            time to get there and to do it (travel, work); half of that from the finish to the deadline (slack;
            tightness is 1 / (1 + 10 times the whole)); a quarter of that from now to the deadline (left);
            by how much the robot is there before the earliest, and the second peer (head_start, second_head_start);
            the share of the peers that could do it in time (rivals);
            time from it to the nearest and the second of its neighbours that could still be done after it (next_gap,
            second_gap), and the share of its neighbours that could (next_count);
            its place among the candidates, by travel and work, as a share of K (rank);
            how much there is to do around it (`mrta_zoo.policies.neural.capam.prospects`).
        robot: (S, G, R, len(ROBOT_COLUMNS)) likewise; wait is the time until it is free.
        robot_valid: (S, G, R) bool.
        mission: (S, G, len(MISSION_COLUMNS)) elapsed time, the scales, what may be chosen as a share of the tasks and
            per working robot, and the mean time left for it.
        place: (S, G, R + K, 2) where robots and tasks are, in L.
        after: (S, G, R + K) from now until each robot is free, or the acting one would be, had it chosen the task.
        pace: (S, G, R + K) crossings a robot takes to travel L; that of the acting one for the tasks.
        rate: (S, G, R + K) crossings a robot takes for workload W, likewise.
        work: (S, G, K) workloads, as a share of W.
        left: (S, G, K) from now to the deadline.
    """

    index: Tensor
    valid: Tensor
    task: Tensor
    robot: Tensor
    robot_valid: Tensor
    mission: Tensor
    place: Tensor
    after: Tensor
    pace: Tensor
    rate: Tensor
    work: Tensor
    left: Tensor

    @classmethod
    def of(
        cls, tasks: Tasks, near: Neighbourhood, states: DecisionStates, most_tasks: int, most_peers: int
    ) -> Candidates:
        """The candidates of G decisions in each of S scenarios: of what the mask allows the quickest to be done."""
        horizon = tasks.horizon[:, None, None]
        elapsed = states.elapsed[..., None] * horizon
        ego_xy = states.of_ego(states.xy)
        ego_pace = 1.0 / states.of_ego(states.speed)[..., None]
        ego_rate = tasks.work_unit[:, None, None] / states.of_ego(states.capacity)[..., None]

        # The quickest tasks. What lies beyond is seldom the right choice, and far more of it in large missions.
        travel_all = _distance(tasks.xy[:, None], ego_xy[..., None, :]) * ego_pace
        duration = travel_all + tasks.workload[:, None] * ego_rate
        key = (duration.double() + 1e-6 * kind(tasks)[:, None]).masked_fill(~states.mask, torch.inf)
        index = key.topk(min(most_tasks, key.shape[-1]), dim=-1, largest=False).indices
        valid = states.mask.gather(2, index)

        def of_task(values: Tensor) -> Tensor:  # (S, N) -> (S, G, K)
            return values[:, None].expand(-1, index.shape[1], -1).gather(2, index)

        xy = torch.stack((of_task(tasks.xy[..., 0]), of_task(tasks.xy[..., 1])), -1)
        work, left = of_task(tasks.workload), of_task(tasks.deadline) * horizon - elapsed
        travel = travel_all.gather(2, index)
        busy = travel + work * ego_rate
        slack = left - busy

        robots = _Robots.of(tasks, states, ego_xy, elapsed, most_peers)
        arrival = (
            robots.wait[..., None] + _distance(robots.xy[..., None, :], xy[..., None, :, :]) * robots.pace[..., None]
        )
        in_time = arrival + work[..., None, :] * robots.rate[..., None] <= left[..., None, :]
        rival = arrival.masked_fill(~robots.valid[..., None], torch.inf)[..., 1:, :]
        peers = robots.valid[..., 1:].sum(-1, keepdim=True).clamp(min=1)
        rivals = (in_time & robots.valid[..., None])[..., 1:, :].sum(-2) / peers
        first, second = _two_least(rival, -2)

        possible, next_travel = _what_could_follow(tasks, near, states, index, left, busy, elapsed, ego_pace, ego_rate)
        gaps = next_travel.masked_fill(~possible, FAR)
        gap, second_gap = _two_least(gaps, -1)
        neighbours = torch.isfinite(near.distance).sum(-1)
        count = possible.sum(-1) / of_task(neighbours).clamp(min=1)

        others = states.mask[..., None, :].expand(*index.shape, -1).scatter(3, index[..., None], False)
        outlook = prospects(
            travel=_distance(xy[..., None, :], tasks.xy[:, None, None]) * ego_pace[..., None],
            work=tasks.workload[:, None] * ego_rate,
            start=busy,
            left=tasks.deadline[:, None] * horizon - elapsed,
            others=others,
            rival=robots.first_peer(tasks.xy),
        )
        rank = torch.arange(index.shape[-1], device=index.device) / most_tasks
        task = torch.stack(
            (
                *(xy - ego_xy[..., None, :]).unbind(-1), *xy.unbind(-1),
                travel.clamp(max=FAR), (work * ego_rate).clamp(max=FAR),
                (slack / 2).clamp(-FAR, FAR), 1 / (1 + 10 * slack.clamp(min=0)), (left / 4).clamp(-FAR, FAR),
                (first - travel).clamp(-FAR, FAR), (second - travel).clamp(-FAR, FAR), rivals,
                gap.clamp(max=FAR), second_gap.clamp(max=FAR), count, rank.expand_as(travel),
                *outlook.unbind(-1),
            ),
            -1,
        )  # fmt: skip
        free = states.mask.sum(-1, keepdim=True)
        exist = tasks.exists.sum(-1)[:, None, None]
        time_left = (tasks.deadline[:, None] * horizon - elapsed).masked_fill(~states.mask, 0.0)
        mission = torch.cat(
            (
                elapsed / USUAL_CROSSINGS, horizon.expand_as(elapsed) / USUAL_CROSSINGS,
                tasks.work_unit[:, None, None].expand_as(elapsed), free / exist,
                (free / (1 + robots.working) / 50).clamp(max=2.0),
                time_left.sum(-1, keepdim=True) / free.clamp(min=1) / 4,
            ),
            -1,
        ).clamp(max=2.0)  # fmt: skip
        tasks_wide = travel.shape
        return cls(
            index=index,
            valid=valid,
            task=task * valid[..., None],
            robot=robots.columns(ego_xy),
            robot_valid=robots.valid,
            mission=mission,
            place=torch.cat((robots.xy, xy), -2),
            after=torch.cat((robots.wait, busy), -1),
            pace=torch.cat((robots.pace, ego_pace.expand(tasks_wide)), -1),
            rate=torch.cat((robots.rate, ego_rate.expand(tasks_wide)), -1),
            work=work,
            left=left,
        )

    def pairs(self) -> Tensor:
        """(S, G, PAIR_COLUMNS, R + K, K): how each task would follow where a robot, or a task, ends.

        The time that it would take (in three scales), the time to spare, and whether there is any.
        """
        robots = self.place.shape[-2] - self.index.shape[-1]
        distance = _distance(self.place[..., :, None, :], self.place[..., None, robots:, :])
        time = distance * self.pace[..., None] + self.work[..., None, :] * self.rate[..., None]
        spare = self.left[..., None, :] - self.after[..., None] - time
        return torch.stack(
            (
                time.clamp(max=2 * FAR), torch.exp(-10 * time), torch.exp(-3 * time),
                spare.clamp(-FAR, FAR), (spare >= 0).to(time.dtype),
            ),
            2,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Robots:
    """The acting robot and its nearest peers: (S, G, R, …)."""

    xy: Tensor
    wait: Tensor
    pace: Tensor
    rate: Tensor
    capacity: Tensor
    speed: Tensor
    valid: Tensor
    working: Tensor
    """(S, G, 1) number of peers at work, near or not."""

    @classmethod
    def of(cls, tasks: Tasks, states: DecisionStates, ego_xy: Tensor, elapsed: Tensor, most_peers: int) -> _Robots:
        wait = (states.ready * tasks.horizon[:, None, None] - elapsed).clamp(min=0)
        peers = states.peers
        reach = wait + _distance(states.xy, ego_xy[..., None, :]) / states.speed
        # Ties, frequent on whole coordinates, are broken by what robots are, not how numbered.
        kind = 2.7 * states.xy[..., 0] + 1.9 * states.xy[..., 1] + states.capacity + 1.3 * states.speed
        key = (reach.double() + 1e-6 * kind).masked_fill(~peers, torch.inf)
        count = min(most_peers, key.shape[-1] - 1)
        nearest = key.topk(count, dim=-1, largest=False).indices
        chosen = torch.cat((states.ego[..., None], nearest), -1)

        def of_robot(values: Tensor) -> Tensor:
            return values.gather(2, chosen)

        valid = torch.cat((torch.ones_like(peers[..., :1]), peers.gather(2, nearest)), -1)
        # Padding has speed and capacity 0 in observations; what is divided by them would not be finite.
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
        """(S, G, N) from now until the first of these peers could be at each of (S, N, 2) places; infinite without."""
        if self.wait.shape[-1] == 1:
            return torch.full((*self.wait.shape[:2], places.shape[1]), torch.inf, device=places.device)
        way = _distance(self.xy[..., 1:, None, :], places[:, None, None]) * self.pace[..., 1:, None]
        arrival = self.wait[..., 1:, None] + way
        return arrival.masked_fill(~self.valid[..., 1:, None], torch.inf).amin(-2)

    def columns(self, ego_xy: Tensor) -> Tensor:
        is_ego = torch.zeros_like(self.wait)
        is_ego[..., 0] = 1.0
        columns = (
            *(self.xy - ego_xy[..., None, :]).unbind(-1), *self.xy.unbind(-1),
            self.wait.clamp(max=FAR), self.capacity, self.speed, is_ego,
        )  # fmt: skip
        return torch.stack(columns, -1) * self.valid[..., None]


def _what_could_follow(
    tasks: Tasks,
    near: Neighbourhood,
    states: DecisionStates,
    index: Tensor,
    left: Tensor,
    busy: Tensor,
    elapsed: Tensor,
    pace: Tensor,
    rate: Tensor,
) -> tuple[Tensor, Tensor]:
    """Of each candidate's neighbours: whether the robot could do them after it, and the way, both (S, G, K, J)."""
    s, g, k = index.shape
    j = near.index.shape[-1]
    wide = index.reshape(s, g * k, 1).expand(-1, -1, j)
    neighbour = near.index.gather(1, wide).view(s, g, k, j)
    travel = near.distance.gather(1, wide).view(s, g, k, j) * pace[..., None]

    def of_neighbour(values: Tensor) -> Tensor:  # (S, G, N) -> (S, G, K, J)
        return values.gather(2, neighbour.flatten(2)).view(s, g, k, j)

    deadline = of_neighbour((tasks.deadline * tasks.horizon[:, None])[:, None].expand(s, g, -1)) - elapsed[..., None]
    work = of_neighbour(tasks.workload[:, None].expand(s, g, -1)) * rate[..., None]
    possible = of_neighbour(states.mask) & (busy[..., None] + travel + work <= deadline)
    return possible, travel


def _distance(a: Tensor, b: Tensor) -> Tensor:
    return (a - b).square().sum(-1).sqrt()


def _two_least(values: Tensor, dim: int) -> tuple[Tensor, Tensor]:
    """The least and the second least along a dimension; infinite where there are none."""
    size = values.shape[dim]
    if size < 2:
        missing = torch.full_like(values.sum(dim), torch.inf)
        return (values.squeeze(dim) if size else missing), missing
    # Not topk, which on a GPU gives each of these many short rows a block of its own.
    least, where = values.min(dim, keepdim=True)
    return least.squeeze(dim), values.scatter(dim, where, torch.inf).amin(dim)
