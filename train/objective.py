"""Objectives, which training minimises, computed from the simulator's own records."""

from __future__ import annotations

import reprlib
from collections.abc import Callable

from torch import Tensor

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.rollout import Rollout
from mrta_zoo.scenario_batch import ScenarioBatch

Objective = Callable[[Rollout, ScenarioBatch], Tensor]
"""(B,) floating-point losses of a rollout of S scenarios, B = S · G; smaller is better."""


def cost_per_task(rollout: Rollout, scenarios: ScenarioBatch) -> Tensor:
    """Eq. 1 of the paper, divided by the number of tasks."""
    return rollout.cost / _tasks(rollout, scenarios)


def missed_share(rollout: Rollout, scenarios: ScenarioBatch) -> Tensor:
    """One minus the completion rate."""
    return 1 - rollout.completed / _tasks(rollout, scenarios)


def relative(rollout: Rollout, scenarios: ScenarioBatch) -> Tensor:
    """−ln(1 + number of completed tasks): one more task counts in proportion to those completed.

    So missions in which few tasks can be done, whose losses would otherwise hardly differ, teach as much as others.
    """
    del scenarios
    return -(1.0 + rollout.completed.double()).log()


OBJECTIVES: dict[str, Objective] = {"cost": cost_per_task, "completion": missed_share, "relative": relative}


def checked(objective: Objective) -> Objective:
    """A user's objective, made to raise `ConfigError` if it returns anything but (B,) floating-point losses."""

    def losses(rollout: Rollout, scenarios: ScenarioBatch) -> Tensor:
        given, missions = objective(rollout, scenarios), len(rollout.cost)
        if not isinstance(given, Tensor) or not given.is_floating_point() or given.shape != (missions,):
            raise ConfigError(
                f"the objective gave {_described(given)}; expected a floating-point tensor of shape ({missions},), a "
                "loss for each mission of the rollout"
            )
        return given

    return losses


def _described(given: object) -> str:
    if isinstance(given, Tensor):
        return f"a tensor of {given.dtype} and shape {tuple(given.shape)}"
    return reprlib.repr(given)


def _tasks(rollout: Rollout, scenarios: ScenarioBatch) -> Tensor:
    return scenarios.task_exists.sum(1).repeat_interleave(len(rollout.cost) // len(scenarios))
