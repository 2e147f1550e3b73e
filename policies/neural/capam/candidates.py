"""Decision-time features: the candidate tasks, the nearest peers and their times, as a good dispatcher sees them.

Ours, not the paper's. Times are in crossings (`mrta_zoo.policies.neural.capam.inputs`).
"""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from mrta_zoo.policies.neural.capam.inputs import USUAL_CROSSINGS, DecisionStates, Tasks
from mrta_zoo.policies.neural.capam.neighbourhood import Neighbourhood, distance, kind
from mrta_zoo.policies.neural.capam.prospects import PROSPECT_COLUMNS, prospects
from mrta_zoo.policies.neural.capam.robots import FAR, Robots
from mrta_zoo.policies.neural.tensor_tree import tree_map

TASK_COLUMNS = (
    "dx", "dy", "x", "y", "travel", "work", "slack", "tightness", "left", "head_start", "second_head_start", "rivals",
    "next_gap", "second_gap", "next_count", "rank", *PROSPECT_COLUMNS,
)  # fmt: skip
MISSION_COLUMNS = ("elapsed", "horizon", "work_unit", "free_share", "free_a_robot", "time_left")
PAIR_COLUMNS = 5


@dataclass(frozen=True, slots=True)
class Candidates:
    """K tasks that a robot may choose, and the R robots that matter: itself, then the peers nearest to it.

    Attributes:
        index: (S, G, K) int64 the tasks.
        valid: (S, G, K) bool, false where there are fewer than K.
        task: (S, G, K, len(TASK_COLUMNS)) what is known of each:
            where it lies from the robot, and on the map (dx, dy, x, y, in L);
            time to get there and to do it (travel, work); half the time from the finish to the deadline (slack;
            tightness is 1 / (1 + 10 times the whole)); a quarter of the time from now to the deadline (left);
            how much earlier the robot is there than the first and the second peer (head_start, second_head_start);
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
        """The candidates of G decisions in each of S scenarios: the quickest tasks that the mask allows."""
        robots = Robots.of(tasks, states, most_peers)
        every = _Durations.of(tasks, states, robots)
        # Slower tasks are seldom the right choice, and there are far more of them in large missions.
        key = (every.busy.double() + 1e-6 * kind(tasks)[:, None]).masked_fill(~states.mask, torch.inf)
        index = key.topk(min(most_tasks, key.shape[-1]), dim=-1, largest=False).indices
        valid = states.mask.gather(2, index)

        own = tree_map(lambda times: times.gather(2, index), every)
        xy = torch.stack([_of_tasks(column, index) for column in tasks.xy.unbind(-1)], -1)
        work = _of_tasks(tasks.workload, index)
        rank = torch.arange(index.shape[-1], device=index.device) / most_tasks
        columns = (
            *(xy - robots.xy[..., :1, :]).unbind(-1), *xy.unbind(-1),
            *own.columns(),
            *_rivalry(robots, own, xy, work),
            *_what_could_follow(near, states, robots, every, own, index),
            rank.expand_as(own.travel),
            *_prospects(tasks, states, robots, every, own, index, xy),
        )  # fmt: skip
        return cls(
            index=index,
            valid=valid,
            task=torch.stack(columns, -1) * valid[..., None],
            robot=robots.columns(),
            robot_valid=robots.valid,
            mission=_mission_columns(tasks, states, robots, every),
            place=torch.cat((robots.xy, xy), -2),
            after=torch.cat((robots.wait, own.busy), -1),
            pace=torch.cat((robots.pace, robots.pace[..., :1].expand_as(work)), -1),
            rate=torch.cat((robots.rate, robots.rate[..., :1].expand_as(work)), -1),
            work=work,
            left=own.left,
        )

    def pairs(self) -> Tensor:
        """(S, G, PAIR_COLUMNS, R + K, K): each candidate as the next task of a robot, or after another.

        The time that it would take (on three scales), the time to spare, and whether there is any.
        """
        robots = self.place.shape[-2] - self.index.shape[-1]
        way = distance(self.place[..., :, None, :], self.place[..., None, robots:, :])
        time = way * self.pace[..., None] + self.work[..., None, :] * self.rate[..., None]
        spare = self.left[..., None, :] - self.after[..., None] - time
        return torch.stack(
            (
                time.clamp(max=2 * FAR), torch.exp(-10 * time), torch.exp(-3 * time),
                spare.clamp(-FAR, FAR), (spare >= 0).to(time.dtype),
            ),
            2,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class _Durations:
    """How long tasks take the acting robot, all of them (S, G, N) or the candidates (S, G, K), in crossings.

    Attributes:
        travel: to get there.
        effort: to do it.
        busy: both together.
        left: from now to the deadline.
    """

    travel: Tensor
    effort: Tensor
    busy: Tensor
    left: Tensor

    @classmethod
    def of(cls, tasks: Tasks, states: DecisionStates, robots: Robots) -> _Durations:
        horizon = tasks.horizon[:, None, None]
        travel = distance(tasks.xy[:, None], robots.xy[..., :1, :]) * robots.pace[..., :1]
        effort = tasks.workload[:, None] * robots.rate[..., :1]
        left = tasks.deadline[:, None] * horizon - states.elapsed[..., None] * horizon
        return cls(travel, effort, travel + effort, left)

    def columns(self) -> tuple[Tensor, ...]:
        """Travel, work, slack, tightness, left."""
        slack = self.left - self.busy
        return (
            self.travel.clamp(max=FAR),
            self.effort.clamp(max=FAR),
            (slack / 2).clamp(-FAR, FAR),
            1 / (1 + 10 * slack.clamp(min=0)),
            (self.left / 4).clamp(-FAR, FAR),
        )


def _rivalry(robots: Robots, own: _Durations, xy: Tensor, work: Tensor) -> tuple[Tensor, ...]:
    """Head start on the first and the second peer, and the share of peers that could do each candidate in time."""
    way = distance(robots.xy[..., None, :], xy[..., None, :, :]) * robots.pace[..., None]
    arrival = robots.wait[..., None] + way
    in_time = arrival + work[..., None, :] * robots.rate[..., None] <= own.left[..., None, :]
    peers = robots.valid[..., 1:].sum(-1, keepdim=True).clamp(min=1)
    rivals = (in_time & robots.valid[..., None])[..., 1:, :].sum(-2) / peers
    first, second = _two_least(arrival.masked_fill(~robots.valid[..., None], torch.inf)[..., 1:, :], -2)
    return (first - own.travel).clamp(-FAR, FAR), (second - own.travel).clamp(-FAR, FAR), rivals


def _what_could_follow(
    near: Neighbourhood, states: DecisionStates, robots: Robots, every: _Durations, own: _Durations, index: Tensor
) -> tuple[Tensor, ...]:
    """Travel to the nearest and the second neighbour that could follow each candidate, and the share that could."""
    s, g, k = index.shape
    j = near.index.shape[-1]
    wide = index.reshape(s, g * k, 1).expand(-1, -1, j)
    neighbour = near.index.gather(1, wide).view(s, g, k, j)
    travel = near.distance.gather(1, wide).view(s, g, k, j) * robots.pace[..., :1, None]

    def of_neighbour(values: Tensor) -> Tensor:  # (S, G, N) -> (S, G, K, J)
        return values.gather(2, neighbour.flatten(2)).view(s, g, k, j)

    done = own.busy[..., None] + travel + of_neighbour(every.effort)
    possible = of_neighbour(states.mask) & (done <= of_neighbour(every.left))
    gap, second_gap = _two_least(travel.masked_fill(~possible, FAR), -1)
    neighbours = _of_tasks(torch.isfinite(near.distance).sum(-1), index)
    return gap.clamp(max=FAR), second_gap.clamp(max=FAR), possible.sum(-1) / neighbours.clamp(min=1)


def _prospects(
    tasks: Tasks, states: DecisionStates, robots: Robots, every: _Durations, own: _Durations, index: Tensor, xy: Tensor
) -> tuple[Tensor, ...]:
    """How much there is to do around each candidate, in the columns of `prospects`."""
    columns = prospects(
        travel=distance(xy[..., None, :], tasks.xy[:, None, None]) * robots.pace[..., :1, None],
        work=every.effort,
        start=own.busy,
        left=every.left,
        others=states.mask[..., None, :].expand(*index.shape, -1).scatter(3, index[..., None], False),
        rival=robots.first_peer(tasks.xy),
    )
    return columns.unbind(-1)


def _mission_columns(tasks: Tasks, states: DecisionStates, robots: Robots, every: _Durations) -> Tensor:
    """(S, G, len(MISSION_COLUMNS)) what is known of the mission as a whole."""
    horizon = tasks.horizon[:, None, None]
    elapsed = states.elapsed[..., None] * horizon
    free = states.mask.sum(-1, keepdim=True)
    time_left = every.left.masked_fill(~states.mask, 0.0).sum(-1, keepdim=True)
    columns = (
        elapsed / USUAL_CROSSINGS, horizon.expand_as(elapsed) / USUAL_CROSSINGS,
        tasks.work_unit[:, None, None].expand_as(elapsed), free / tasks.exists.sum(-1)[:, None, None],
        (free / (1 + robots.working) / 50).clamp(max=2.0), time_left / free.clamp(min=1) / 4,
    )  # fmt: skip
    return torch.cat(columns, -1).clamp(max=2.0)


def _of_tasks(values: Tensor, index: Tensor) -> Tensor:
    """(S, G, K) the values of the candidates, of (S, N) values of all tasks."""
    return values[:, None].expand(-1, index.shape[1], -1).gather(2, index)


def _two_least(values: Tensor, dim: int) -> tuple[Tensor, Tensor]:
    """The least and the second least along a dimension; infinite where there are none."""
    size = values.shape[dim]
    if size < 2:
        missing = torch.full_like(values.sum(dim), torch.inf)
        return (values.squeeze(dim) if size else missing), missing
    # Not topk, which on a GPU gives each of these many short rows a block of its own.
    least, where = values.min(dim, keepdim=True)
    return least.squeeze(dim), values.scatter(dim, where, torch.inf).amin(dim)
