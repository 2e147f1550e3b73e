"""Scenarios side by side, padded to one size, as torch tensors. Needs the `torch` extra."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import numpy as np
import torch
from torch import Tensor

from mrta_zoo.errors import ConfigError
from mrta_zoo.rules import MaskRule
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
        scales: what networks divide all this by; fields are (B,) or (B, 2).
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
            device: the tensors' device.
            max_tasks: room for tasks.
            max_robots: room for robots.
            mask_rule: of the missions to be simulated; the scales depend on it, see `scales.Scales.of`.

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
        """The tensors' device."""
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
