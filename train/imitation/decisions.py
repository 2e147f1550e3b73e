"""The decisions behind plans, as the simulator would have put them to the robots."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import torch
from torch import Tensor

from mrta_zoo.batch import BatchMission
from mrta_zoo.policies.neural.capam.inputs import Tasks, Watch
from mrta_zoo.policies.neural.rollout import SEGMENT, Segment
from mrta_zoo.policies.neural.sharing import Network
from mrta_zoo.policies.neural.symmetry import View
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.imitation.experts import ExpertPlan


def turned(scenarios: ScenarioBatch, symmetry: Tensor) -> ScenarioBatch:
    """The scenarios, each seen in one of its frame's eight symmetries, or of four if the frame is not square.

    Args:
        scenarios: S scenarios.
        symmetry: (S,) int64 in 0 to 7; bit 0 flips x, bit 1 flips y, bit 2 swaps the axes.
    """
    extent, origin = scenarios.scales.extent, scenarios.scales.origin[:, None]
    square = extent[:, 0] == extent[:, 1]
    view = View.numbered(torch.where(square, symmetry, symmetry & 3), extent)
    task_xy, robot_xy = (view.of_places(xy - origin) + origin for xy in (scenarios.task_xy, scenarios.robot_xy))
    return replace(scenarios, task_xy=task_xy, robot_xy=robot_xy)


class PlanBatch:
    """Plans of scenarios of one size, on a device.

    Attributes:
        scenarios: the S scenarios.
        routes: (S, M, T) int64 the tasks of each robot in order, then −1.
    """

    def __init__(self, plans: Sequence[ExpertPlan], device: torch.device) -> None:
        self.scenarios = ScenarioBatch.of([plan.scenario for plan in plans], device)
        longest = max(len(route) for plan in plans for route in plan.routes)
        routes = torch.full((len(plans), self.scenarios.num_robots, longest + 1), -1, dtype=torch.int64)
        for row, plan in zip(routes, plans, strict=True):
            for robot, route in enumerate(plan.routes):
                row[robot, : len(route)] = torch.tensor(route, dtype=torch.int64)
        self.routes = routes.to(device)

    def __len__(self) -> int:
        return len(self.routes)


@torch.no_grad()
def follow(network: Network, scenarios: ScenarioBatch, routes: Tensor) -> list[Segment]:
    """The decisions (G = 1) by which robots follow plans under the mask rule "feasible".

    A robot at the end of its route retires, even if it could choose more: the plan has no label for that.

    Args:
        network: computes the features of each state.
        scenarios: S scenarios.
        routes: (S, M, T) int64 the tasks of each robot in order, then at least one −1; each task finishes in time.
    """
    mission = BatchMission(scenarios, "feasible")
    encoding: Any = network.surroundings(Tasks.of_batch(scenarios))
    rows = torch.arange(len(scenarios), device=scenarios.device)
    position = torch.zeros(routes.shape[:2], dtype=torch.int64, device=routes.device)
    sample = torch.zeros(1, dtype=torch.int64, device=routes.device)
    segments: list[Segment] = []
    while not bool(mission.done.all()):
        taken, watch = [], Watch(mission)
        for _ in range(SEGMENT):
            robot = mission.actor.clamp(min=0)
            task = routes[rows, robot, position[rows, robot]]
            at_end = (task < 0) & ~mission.done
            mission.retire(at_end)
            live = ~mission.done & ~at_end  # where a robot has retired, the next one gets its turn in the next round
            states = watch.states()
            task = torch.where(live, task, 0)
            taken.append(
                Segment(rows, states, network.features(encoding, states), task[:, None], live[:, None], sample)
            )
            robot = mission.actor.clamp(min=0)
            position[rows, robot] += live.long()
            mission.step(task, where=live)
        segments.append(Segment.cat(taken))
    return segments
