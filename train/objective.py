"""What training minimises, computed from the simulator's books and nowhere else."""

from __future__ import annotations

from collections.abc import Callable

from torch import Tensor

from mrta_zoo.batch import ScenarioBatch
from mrta_zoo.policies.rollout import Rollout

Objective = Callable[[Rollout, ScenarioBatch], Tensor]
"""(B,) losses of a rollout of S scenarios, B = S · G; smaller is better."""


def cost_per_task(rollout: Rollout, scenarios: ScenarioBatch) -> Tensor:
    """Eq. 1 of the paper, divided by the number of tasks."""
    return rollout.cost / _tasks(rollout, scenarios)


def missed_share(rollout: Rollout, scenarios: ScenarioBatch) -> Tensor:
    """One minus the completion rate."""
    return 1 - rollout.completed / _tasks(rollout, scenarios)


OBJECTIVES: dict[str, Objective] = {"cost": cost_per_task, "completion": missed_share}


def _tasks(rollout: Rollout, scenarios: ScenarioBatch) -> Tensor:
    return scenarios.task_exists.sum(1).repeat_interleave(len(rollout.cost) // len(scenarios))
