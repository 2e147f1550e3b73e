"""Network inputs: observations as tensors, from the AEC environment or from the batched simulator.

Shapes: S scenarios, G decisions of each (several samples of a mission, or several states), N tasks, M robots.
Places are in lengths L of the frame (`mrta_zoo.scales`); times either as shares of T, the latest deadline that can
bind, or in *crossings*, the time L/V that the fastest robot takes to cross the frame. Crossings make travel and
deadlines comparable across scenarios.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mrta_zoo.batch import BatchMission
from mrta_zoo.env.observation import MISSION_FEATURES, ROBOT_FEATURES, TASK_FEATURES, Observation
from mrta_zoo.scenario_batch import ScenarioBatch

MOST_CROSSINGS = 1000.0
"""Where `Tasks.horizon` (above, and below at its inverse) and `Tasks.work_unit` saturate: beyond it deadlines either
hardly bind or hardly leave room to move, and float32 would run out of digits."""
MOST_SHARE = MOST_CROSSINGS / (1 + MOST_CROSSINGS)
USUAL_CROSSINGS = 4.0
"""Deadlines lie some 2 to 6 crossings ahead; divided by this they are about as large as the other features."""

_TASK = {name: column for column, name in enumerate(TASK_FEATURES)}
_ROBOT = {name: column for column, name in enumerate(ROBOT_FEATURES)}
_MISSION = {name: column for column, name in enumerate(MISSION_FEATURES)}


@dataclass(frozen=True, slots=True)
class Tasks:
    """What doesn't change during a mission; float32.

    Attributes:
        xy: (S, N, 2) places, in L.
        deadline: (S, N) as a share of T.
        workload: (S, N) as a share of the largest workload W.
        exists: (S, N) bool, false for padding.
        horizon: (S,) T in crossings.
        work_unit: (S,) the time that the strongest robot takes for workload W, in crossings.
    """

    xy: Tensor
    deadline: Tensor
    workload: Tensor
    exists: Tensor
    horizon: Tensor
    work_unit: Tensor

    @classmethod
    def of_batch(cls, scenarios: ScenarioBatch) -> Tasks:
        """The tasks of a batch of scenarios."""
        s, scales = scenarios, scenarios.scales
        return _tasks(
            ((s.task_xy - scales.origin[:, None]) / scales.length[:, None, None]).clamp(0, 1).float(),
            (s.deadline / scales.time[:, None]).clamp(max=1).float(),
            (s.workload / scales.work[:, None]).clamp(max=1).float(),
            s.task_exists,
            scales.crossing_ratio.float(),
            scales.work_ratio.float(),
        )

    @classmethod
    def of_observations(cls, observations: Sequence[Observation], device: torch.device | str = "cpu") -> Tasks:
        """The tasks that each of S observers sees."""
        return cls.of_tables(_stacked(observations, ("tasks", "mission"), device))

    @classmethod
    def of_tables(cls, tables: Mapping[str, Tensor]) -> Tasks:
        """The same from observations' tables already stacked: ``tasks`` (S, N, 8) and ``mission`` (S, 3)."""
        tasks, mission = tables["tasks"], tables["mission"]
        return _tasks(
            tasks[..., [_TASK["x"], _TASK["y"]]],
            tasks[..., _TASK["deadline"]],
            tasks[..., _TASK["workload"]],
            tasks[..., [_TASK[status] for status in ("active", "assigned", "completed", "missed")]].any(-1),
            mission[:, _MISSION["crossing_ratio"]],
            mission[:, _MISSION["work_ratio"]],
        )


@dataclass(frozen=True, slots=True)
class DecisionStates:
    """What decisions depend on besides the tasks; float32 unless said otherwise.

    Attributes:
        xy: (S, G, M, 2) where each robot is, or is heading for, in L.
        capacity: (S, G, M) as a share of the largest capacity.
        speed: (S, G, M) as a share of the largest speed.
        ready: (S, G, M) when each robot is free next, as a share of T, at most 1.
        working: (S, G, M) bool, neither retired nor padding.
        ego: (S, G) int64, the acting robot.
        elapsed: (S, G) as a share of T, at most 1.
        mask: (S, G, N) bool, what the acting robot may choose.
    """

    xy: Tensor
    capacity: Tensor
    speed: Tensor
    ready: Tensor
    working: Tensor
    ego: Tensor
    elapsed: Tensor
    mask: Tensor

    @classmethod
    def of_batch(cls, mission: BatchMission, groups: int = 1) -> DecisionStates:
        """The present states of B = S·G missions, of which each `groups` in a row share their scenario."""
        return Watch(mission, groups).states()

    @classmethod
    def of_observations(cls, observations: Sequence[Observation], device: torch.device | str = "cpu") -> DecisionStates:
        """The states of S observers (G = 1)."""
        mask = torch.from_numpy(np.stack([o["action_mask"] for o in observations])).to(device)
        return cls.of_tables(_stacked(observations, ("robots", "mission"), device), mask)

    @classmethod
    def of_tables(cls, tables: Mapping[str, Tensor], mask: Tensor) -> DecisionStates:
        """The same from tables already stacked: ``robots`` (S, M, 7) and ``mission`` (S, 3), with the mask (S, N)."""
        robots = tables["robots"][:, None]
        return cls(
            xy=robots[..., [_ROBOT["x"], _ROBOT["y"]]],
            capacity=robots[..., _ROBOT["capacity"]],
            speed=robots[..., _ROBOT["speed"]],
            ready=robots[..., _ROBOT["ready"]],
            working=robots[..., _ROBOT["working"]] > 0,
            ego=robots[..., _ROBOT["is_ego"]].argmax(-1),
            elapsed=tables["mission"][:, [_MISSION["elapsed"]]],
            mask=mask[:, None].bool(),
        )

    @property
    def peers(self) -> Tensor:
        """(S, G, M) bool, the working robots other than the acting one."""
        index = torch.arange(self.working.shape[-1], device=self.working.device)
        return self.working & (index != self.ego[..., None])

    def of_ego(self, table: Tensor) -> Tensor:
        """The row of a (S, G, M, …) table that belongs to the acting robot: (S, G, …)."""
        index = self.ego.reshape(*self.ego.shape, *[1] * (table.dim() - 2))
        return table.gather(2, index.expand(*self.ego.shape, 1, *table.shape[3:])).squeeze(2)


class Watch:
    """Reads the states of the same B missions again and again, with what doesn't change computed once.

    Args:
        mission: B = S·G missions.
        groups: G, how many in a row share their scenario.
    """

    def __init__(self, mission: BatchMission, groups: int = 1) -> None:
        s, scales = mission.scenarios, mission.scenarios.scales
        self.mission = mission
        self._groups = (-1, groups)
        self._origin = scales.origin[:, None]
        self._length = scales.length[:, None, None]
        self._time = scales.time
        self._capacity = (s.capacity / scales.capacity[:, None]).clamp(max=1).float().unflatten(0, self._groups)
        self._speed = (s.speed / scales.speed[:, None]).clamp(max=1).float().unflatten(0, self._groups)

    def states(self) -> DecisionStates:
        """The present states."""
        mission, groups = self.mission, self._groups
        return DecisionStates(
            xy=((mission.position - self._origin) / self._length).clamp(0, 1).float().unflatten(0, groups),
            capacity=self._capacity,
            speed=self._speed,
            ready=(mission.ready / self._time[:, None]).clamp(max=1).float().unflatten(0, groups),
            working=(~mission.retired).unflatten(0, groups),
            ego=mission.actor.clamp(min=0).unflatten(0, groups),
            elapsed=(mission.time / self._time).clamp(max=1).float().unflatten(0, groups),
            mask=mission.mask().unflatten(0, groups),
        )


def _stacked(
    observations: Sequence[Observation], names: tuple[str, ...], device: torch.device | str
) -> dict[str, Tensor]:
    seen = [observation["observation"] for observation in observations]
    return {name: torch.from_numpy(np.stack([each[name] for each in seen])).to(device) for name in names}


def _tasks(xy: Tensor, deadline: Tensor, workload: Tensor, exists: Tensor, crossing: Tensor, work: Tensor) -> Tasks:
    crossing = crossing.clamp(1 - MOST_SHARE, MOST_SHARE)
    work = work.clamp(max=MOST_SHARE)
    crossing_share, work_share = crossing / (1 - crossing), work / (1 - work)
    work_unit = (work_share / crossing_share).clamp(max=MOST_CROSSINGS)
    return Tasks(xy, deadline, workload, exists, 1 / crossing_share, work_unit)
