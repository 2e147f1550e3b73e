"""Thousands of missions at once on torch tensors: the dynamics of `mission`, for training and evaluation.

Needs the `torch` extra. The rules are those of `rules`; `tests/property` holds this simulator and `mission`
equal, decision by decision.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import numpy as np
import torch
from torch import Tensor

from mrta_zoo.errors import ConfigError
from mrta_zoo.plan import Plan
from mrta_zoo.rules import MaskRule, check_mask_rule, may_choose, next_event, task_cost, travel_time, visit
from mrta_zoo.scales import Scales
from mrta_zoo.scenario import ARRAYS, QUANTITIES, Scenario
from mrta_zoo.wording import counted


@dataclass(frozen=True, slots=True)
class ScenarioBatch:
    """B scenarios side by side, padded to N tasks and M robots. Float64 unless said otherwise.

    Attributes:
        task_xy: (B, N, 2) task places; padding is 0.
        deadline: (B, N) deadlines; padding is 1.
        workload: (B, N) workloads; padding is 0.
        task_exists: (B, N) bool.
        robot_xy: (B, M, 2) starts; padding is 0.
        capacity: (B, M) capacities; padding is 1.
        speed: (B, M) speeds; padding is 1.
        robot_exists: (B, M) bool.
        scales: by what networks have them divided; (B,) or (B, 2).
    """

    task_xy: Tensor
    deadline: Tensor
    workload: Tensor
    task_exists: Tensor
    robot_xy: Tensor
    capacity: Tensor
    speed: Tensor
    robot_exists: Tensor
    scales: Scales

    @classmethod
    def of(
        cls,
        scenarios: Sequence[Scenario],
        device: torch.device | str = "cpu",
        max_tasks: int | None = None,
        max_robots: int | None = None,
        mask_rule: MaskRule = "feasible",
    ) -> ScenarioBatch:
        """Stack scenarios, padded to the largest of them or to the given sizes.

        Args:
            scenarios: B of them.
            device: where the tensors shall be.
            max_tasks: room for tasks.
            max_robots: room for robots.
            mask_rule: that of the missions to come, for networks that look at them: see `scales.Scales.of`.

        Raises:
            ConfigError: if there is no scenario, or one does not fit.
        """
        if not scenarios:
            raise ConfigError("a batch needs at least one scenario; got 0")
        n = max(s.num_tasks for s in scenarios)
        m = max(s.num_robots for s in scenarios)
        room_n = n if max_tasks is None else max_tasks
        room_m = m if max_robots is None else max_robots
        if room_n < n or room_m < m:
            raise ConfigError(
                f"the largest scenario has {counted(n, 'task')} and {counted(m, 'robot')}; the batch was given room "
                f"for {room_n} and {room_m}"
            )
        n, m = room_n, room_m

        def stack(attribute: str, fill: float = 0.0) -> Tensor:
            first: np.ndarray = getattr(scenarios[0], attribute)
            out = np.full((len(scenarios), n if ARRAYS[attribute] == "task" else m, *first.shape[1:]), fill)
            for row, scenario in zip(out, scenarios, strict=True):
                values = getattr(scenario, attribute)
                row[: len(values)] = values
            return torch.from_numpy(out).to(device)

        def exists(counts: list[int], size: int) -> Tensor:
            return (torch.arange(size) < torch.tensor(counts)[:, None]).to(device)

        return cls(
            task_xy=stack("task_xy"),
            task_exists=exists([s.num_tasks for s in scenarios], n),
            robot_xy=stack("robot_xy"),
            robot_exists=exists([s.num_robots for s in scenarios], m),
            **{quantity.name: stack(quantity.name, quantity.padding) for quantity in QUANTITIES},
            scales=_stacked_scales(scenarios, mask_rule, device),
        )

    def __len__(self) -> int:
        return len(self.deadline)

    @property
    def num_tasks(self) -> int:
        """N, the room for tasks."""
        return self.deadline.shape[1]

    @property
    def num_robots(self) -> int:
        """M, the room for robots."""
        return self.capacity.shape[1]

    @property
    def device(self) -> torch.device:
        """Where the tensors are."""
        return self.deadline.device

    def to(self, device: torch.device | str) -> ScenarioBatch:
        """The same scenarios on another device."""
        return self._each(lambda rows: rows.to(device))

    def repeat(self, times: int) -> ScenarioBatch:
        """Each scenario `times` times in a row: rows k·times … (k+1)·times − 1 are scenario k."""
        return self._each(lambda rows: rows.repeat_interleave(times, 0))

    def select(self, rows: Tensor) -> ScenarioBatch:
        """Some of the scenarios, by (R,) int64 row numbers."""
        return self._each(lambda every: every[rows])

    def _each(self, change: Callable[[Tensor], Tensor]) -> ScenarioBatch:
        rows = {field.name: change(getattr(self, field.name)) for field in fields(self) if field.name != "scales"}
        return ScenarioBatch(**rows, scales=self.scales.each(change))


def _stacked_scales(scenarios: Sequence[Scenario], mask_rule: MaskRule, device: torch.device | str) -> Scales:
    scales = [Scales.of(scenario, mask_rule) for scenario in scenarios]

    def stack(name: str) -> Tensor:
        return torch.from_numpy(np.array([getattr(each, name) for each in scales])).to(device)

    return Scales(*(stack(field.name) for field in fields(Scales)))


class BatchMission:
    """B missions under way, one decision of each at a time. Mutable: `step` changes it in place.

    Attributes:
        scenarios: the scenarios.
        time: (B,) float64 mission clock; at the end, the makespan.
        actor: (B,) int64 robot to act, or -1 where the mission is over.
        ready: (B, M) float64 when each robot is (or will be) free.
        position: (B, M, 2) float64 where each robot is, or is heading for.
        retired: (B, M) bool; padding counts as retired.
        untaken: (B, N) bool; padding counts as taken.
        finish: (B, N) float64 finish of each taken task, infinite for the others.
        taken_by: (B, N) int64 robot that took each task, or -1.
        order: (B, N) int64 how many steps of the batch came before a task was taken, or -1.
        finish_if: (B, M, N) float64 when each robot would finish each task, were it its next.
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
        offset = s.task_xy[:, None] - s.robot_xy[:, :, None]
        travel = travel_time(offset[..., 0], offset[..., 1], s.speed[..., None], _sqrt)
        work = s.workload[:, None] / s.capacity[..., None]
        ready = self.ready[..., None]
        self.finish_if = visit(ready, travel, work).finishes
        self._allowed = may_choose(mask_rule, self.finish_if, ready, s.deadline[:, None])
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

        offset = s.task_xy - place[:, None]
        speed = s.speed[rows, robot][:, None]
        work = s.workload / s.capacity[rows, robot][:, None]
        travel = travel_time(offset[..., 0], offset[..., 1], speed, _sqrt)
        finish_if = visit(ready[:, None], travel, work).finishes
        self.finish_if[rows, robot] = finish_if
        self._allowed[rows, robot] = may_choose(self.mask_rule, finish_if, ready[:, None], s.deadline)
        self._advance()

    def retire(self, where: Tensor) -> None:
        """Let the acting robot retire, whatever it could choose, in the missions marked in (B,) bool.

        No policy may do so; plans that end before the choices do can be followed this way.
        """
        robot = self.actor.clamp(min=0)
        self._allowed[self._rows, robot] &= ~where[:, None]
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
        """The routes taken so far, one plan a mission."""
        taken_by, order = self.taken_by.cpu().numpy(), self.order.cpu().numpy().argsort(1)
        plans = []
        for b, m in enumerate(self.scenarios.robot_exists.sum(1).tolist()):
            routes: list[list[int]] = [[] for _ in range(m)]
            for task in order[b]:
                if taken_by[b, task] >= 0:
                    routes[taken_by[b, task]].append(task)
            plans.append(Plan.of(routes, names[b] if names else "", method))
        return plans

    def _advance(self) -> None:
        """Retire robots that became free and have no choice, until each mission has an actor or is over."""
        choice = (self._allowed & self.untaken[:, None]).any(2)
        alive = ~self.retired
        # Whoever becomes free next with a choice acts; whoever becomes free before that without one retires.
        when, actor = next_event(self.ready, ~(alive & choice), torch.where, _least)
        over = torch.isinf(when)
        index = torch.arange(self.ready.shape[1], device=self.ready.device)
        before = (self.ready < when[:, None]) | ((self.ready == when[:, None]) & (index < actor[:, None]))
        self.retired |= alive & ~choice & before
        end = self.ready.masked_fill(~self.scenarios.robot_exists, 0.0).amax(1)
        self.time = torch.where(over, end, when)
        self.actor = torch.where(over, -1, actor)


def _sqrt(square: Tensor) -> Tensor:
    """The correctly rounded square root, as IEEE 754 asks and as CUDA, NumPy and Python compute it.

    On the CPU `torch.sqrt` is one bit off in about 1 % of values, enough to tip a tie with a deadline.
    """
    return torch.from_numpy(np.sqrt(square.numpy())) if square.device.type == "cpu" else torch.sqrt(square)


def _least(times: Tensor) -> tuple[Tensor, Tensor]:
    least, first = times.min(1)  # ties: the lowest index, checked by the property tests
    return least, first
