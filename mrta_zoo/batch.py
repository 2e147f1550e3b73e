"""The batched simulator: the dynamics of `mission` for thousands of missions at once, on torch tensors.

Needs the `torch` extra. The rules are those of `rules`; `tests/property` checks that this simulator and `mission`
agree, decision by decision.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import torch
from torch import Tensor

from mrta_zoo.plan import Plan
from mrta_zoo.rules import MaskRule, check_mask_rule, may_choose, next_event, task_cost, travel_time, visit
from mrta_zoo.scenario_batch import ScenarioBatch


class BatchMission:
    """B missions under way, each advanced by one decision per `step`, which changes them in place.

    Attributes:
        scenarios: the scenarios.
        time: (B,) float64 mission clock; at the end, the makespan.
        actor: (B,) int64 robot to act, or -1 where the mission is over.
        ready: (B, M) float64 when each robot is (or will be) free.
        position: (B, M, 2) float64 where each robot is, or is heading for.
        retired: (B, M) bool; padding counts as retired.
        untaken: (B, N) bool; padding counts as taken.
        finish: (B, N) float64 when each taken task is finished, infinite for the others.
        taken_by: (B, N) int64 robot that took each task, or -1.
        order: (B, N) int64 the step of the batch, counted from 0, that took each task, or -1.
        finish_if: (B, M, N) float64 when each robot would finish each task if it took it next.
    """

    def __init__(self, scenarios: ScenarioBatch, mask_rule: MaskRule = "feasible") -> None:
        check_mask_rule(mask_rule)
        s = scenarios
        b, m, n, device = len(s), s.num_robots, s.num_tasks, s.device
        self.scenarios = s
        self.mask_rule: MaskRule = mask_rule
        self.ready = torch.zeros(b, m, dtype=torch.float64, device=device)
        self.position = s.robot_xy.clone()
        self.retired = ~s.robot_exists
        self.untaken = s.task_exists.clone()
        self.finish = torch.full((b, n), torch.inf, dtype=torch.float64, device=device)
        self.taken_by = torch.full((b, n), -1, dtype=torch.int64, device=device)
        self.order = torch.full((b, n), -1, dtype=torch.int64, device=device)
        self._decisions = 0
        self._x, self._y = (each.contiguous() for each in s.task_xy.unbind(2))
        self.finish_if, self._allowed = self._look_ahead(s.robot_xy, self.ready, s.speed, s.capacity)
        self._choices = (self._allowed & self.untaken[:, None]).sum(2)  # (B, M) how many tasks each could choose
        self._rows = torch.arange(b, device=device)
        self._advance()

    @property
    def done(self) -> Tensor:
        """(B,) bool, where every robot is retired."""
        return self.actor < 0

    def mask(self) -> Tensor:
        """(B, N) bool, what the acting robot may choose; all false where the mission is over."""
        allowed: Tensor = self._allowed[self._rows, self.actor.clamp(min=0)]
        return self.untaken & allowed & ~self.done[:, None]

    def step(self, task: Tensor, where: Tensor | None = None) -> None:
        """Let the acting robot of each mission take `task` (B,) int64; ignored where the mission is over.

        The choice must be legal under `mask`; for speed this is not checked here. Missions that are not marked in
        `where`, (B,) bool, stay as they are.
        """
        s, rows = self.scenarios, self._rows
        live = ~self.done if where is None else where & ~self.done
        robot = self.actor.clamp(min=0)
        task = torch.where(live, task, torch.zeros_like(task))

        old_ready = self.ready[rows, robot]
        finish = self.finish_if[rows, robot, task]
        ready = torch.where(live, finish, old_ready)
        place = torch.where(live[:, None], s.task_xy[rows, task], self.position[rows, robot])
        self.ready[rows, robot] = ready
        self.position[rows, robot] = place
        self.finish[rows, task] = torch.where(live, finish, self.finish[rows, task])
        self.taken_by[rows, task] = torch.where(live, robot, self.taken_by[rows, task])
        self.order[rows, task] = torch.where(live, self._decisions, self.order[rows, task])
        self._decisions += 1
        self.untaken[rows, task] = self.untaken[rows, task] & ~live
        self._choices -= (self._allowed[rows, :, task] & live[:, None]).to(torch.int64)

        of_robot = (each[:, None] for each in (place, ready, s.speed[rows, robot], s.capacity[rows, robot]))
        finish_if, allowed = self._look_ahead(*of_robot)
        self.finish_if[rows, robot], self._allowed[rows, robot] = finish_if[:, 0], allowed[:, 0]
        self._choices[rows, robot] = (allowed[:, 0] & self.untaken).sum(1)
        self._advance()

    def retire(self, where: Tensor) -> None:
        """Retire the acting robot, whatever it could choose, in the missions marked in `where`, (B,) bool.

        No policy may do this; it is for following plans whose routes end while there is still something to choose.
        """
        robot = self.actor.clamp(min=0)
        self._allowed[self._rows, robot] &= ~where[:, None]
        self._choices[self._rows, robot] *= ~where
        self._advance()

    def select(self, rows: Tensor) -> BatchMission:
        """A copy of some of the missions, by (R,) int64 row numbers, as they stand."""
        chosen = object.__new__(BatchMission)
        for name, value in vars(self).items():
            setattr(chosen, name, value[rows] if isinstance(value, Tensor) else value)
        chosen.scenarios = self.scenarios.select(rows)
        chosen._rows = torch.arange(len(rows), device=rows.device)
        return chosen

    def cost(self) -> Tensor:
        """(B,) float64, the objective (Eq. 1 of the paper); final where the mission is done."""
        s = self.scenarios
        terms = task_cost(self.finish, s.deadline, self.time[:, None], torch.where, torch.maximum)
        return torch.where(s.task_exists, terms, 0.0).sum(1)

    def completed(self) -> Tensor:
        """(B,) int64, number of taken tasks that finish by their deadline."""
        return (self.finish <= self.scenarios.deadline).sum(1)

    def plans(self, names: Sequence[str] | None = None, method: str = "") -> list[Plan]:
        """The routes taken so far, one plan per mission."""
        taken_by, order = self.taken_by.cpu().numpy(), self.order.cpu().numpy().argsort(1)
        plans = []
        for b, m in enumerate(self.scenarios.robot_exists.sum(1).tolist()):
            routes: list[list[int]] = [[] for _ in range(m)]
            for task in order[b]:
                if taken_by[b, task] >= 0:
                    routes[taken_by[b, task]].append(task)
            plans.append(Plan.of(routes, names[b] if names else "", method))
        return plans

    def _look_ahead(self, place: Tensor, ready: Tensor, speed: Tensor, capacity: Tensor) -> tuple[Tensor, Tensor]:
        """(B, R, N) when R robots of each mission would finish each task, and whether the rule allows them to take it.

        Args:
            place: (B, R, 2) where each is next free.
            ready: (B, R) when each is next free.
            speed: (B, R) speed of each.
            capacity: (B, R) capacity of each.
        """
        s, ready = self.scenarios, ready[..., None]
        dx, dy = self._x[:, None] - place[..., :1], self._y[:, None] - place[..., 1:]
        travel = travel_time(dx, dy, speed[..., None], _sqrt)
        finish = visit(ready, travel, s.workload[:, None] / capacity[..., None]).finishes
        return finish, may_choose(self.mask_rule, finish, ready, s.deadline[:, None])

    def _advance(self) -> None:
        """Retire robots that became free and have no choice, until each mission has an actor or is over."""
        choice = self._choices > 0
        alive = ~self.retired
        # The first free robot that has a choice acts; those that are free before it and have none retire.
        when, actor = next_event(self.ready, ~(alive & choice), torch.where, _least)
        over = torch.isinf(when)
        index = torch.arange(self.ready.shape[1], device=self.ready.device)
        before = (self.ready < when[:, None]) | ((self.ready == when[:, None]) & (index < actor[:, None]))
        self.retired |= alive & ~choice & before
        end = self.ready.masked_fill(~self.scenarios.robot_exists, 0.0).amax(1)
        self.time = torch.where(over, end, when)
        self.actor = torch.where(over, -1, actor)


def _sqrt(square: Tensor) -> Tensor:
    """The correctly rounded square root, as IEEE 754 requires and as CUDA, NumPy and Python compute it.

    On the CPU `torch.sqrt` is one bit off in about 1 % of values, enough to tip a tie with a deadline.
    """
    return torch.from_numpy(np.sqrt(square.numpy())) if square.device.type == "cpu" else torch.sqrt(square)


def _least(times: Tensor) -> tuple[Tensor, Tensor]:
    least, first = times.min(1)  # ties: the lowest index, checked by the property tests
    return least, first
