"""The decisions of many missions on a GPU, a segment at a launch; what they are is the same as without graphs."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import Any

import torch
from torch import Tensor
from torch.nn.attention import SDPBackend, sdpa_kernel

from mrta_zoo.batch import BatchMission, ScenarioBatch
from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.capam.inputs import Tasks
from mrta_zoo.policies.neural.rollout import NOT_FINITE, Rollout, Segment, run_segment
from mrta_zoo.policies.neural.sharing import Network
from mrta_zoo.policies.neural.temperature import tempered
from mrta_zoo.rules import MaskRule
from mrta_zoo.train.cuda_graph import Graph
from mrta_zoo.train.imitation.decisions import follow_segment
from mrta_zoo.train.precision import Precision, autocast

ATTENTION = [SDPBackend.EFFICIENT_ATTENTION, SDPBackend.MATH]
"""cuDNN's, which PyTorch would choose without gradients, took four times as long for so few tokens (H200)."""


@dataclass(slots=True)
class _Missions:
    encoding: Any
    mission: BatchMission
    rows: Tensor
    routes: Tensor | None = None
    position: Tensor | None = None


class GraphedRollout:
    """`roll_out` and `follow` with graphs, one for each size of scenarios.

    Args:
        network: decides; its weights may change, its shapes may not.
        samples: missions sampled of each scenario.
        mask_rule: what robots may choose.
        precision: of matrix products.
        device: the GPU.
        temperature: of the policy that samples.
    """

    def __init__(
        self,
        network: Network,
        samples: int,
        mask_rule: MaskRule,
        precision: Precision,
        device: torch.device,
        temperature: float = 1.0,
    ) -> None:
        self._network, self._samples, self._mask_rule = network, samples, mask_rule
        self._policy = tempered(network, temperature)
        self._precision: Precision = precision
        self._generator = torch.Generator(device)
        self._graphs: dict[tuple[int, ...], Graph[_Missions, Any]] = {}

    @torch.no_grad()
    def sample(self, scenarios: ScenarioBatch, seed: int) -> Rollout:
        """Sampled missions with their segments, as `roll_out` would give them.

        Args:
            scenarios: S scenarios.
            seed: of the draws.

        Raises:
            ConfigError: if the network gives probabilities that are not finite.
        """
        samples = self._samples
        with autocast(scenarios.device, self._precision):
            encoding = self._network.encode(Tasks.of_batch(scenarios))
        mission = BatchMission(scenarios.repeat(samples), self._mask_rule)
        rows = torch.arange(len(scenarios), device=scenarios.device)
        key = (0, len(scenarios), scenarios.num_tasks, scenarios.num_robots)
        graph = self._graph(key, self._decide, _Missions(encoding, mission, rows))
        self._generator.manual_seed(seed)
        segments, log_prob = [], torch.zeros(len(mission.actor), device=scenarios.device)
        while True:
            segment, gained = graph.run()
            # Now, not at the end: a mission that never takes a legal task might go on for very long.
            if not torch.isfinite(gained).all():
                raise ConfigError(NOT_FINITE)
            segments.append(copy.deepcopy(segment.lively()))
            log_prob += gained
            mission = graph.state.mission
            if bool(mission.done.all()):
                break
        return Rollout(mission.cost(), mission.completed(), log_prob, segments=segments)

    @torch.no_grad()
    def follow(self, scenarios: ScenarioBatch, routes: Tensor) -> list[Segment]:
        """The decisions behind plans, as `imitation.follow` would give them."""
        encoding = self._network.surroundings(Tasks.of_batch(scenarios))
        mission = BatchMission(scenarios, "feasible")
        rows = torch.arange(len(scenarios), device=scenarios.device)
        position = torch.zeros(routes.shape[:2], dtype=torch.int64, device=routes.device)
        key = (1, len(scenarios), scenarios.num_tasks, scenarios.num_robots, routes.shape[2])
        graph = self._graph(key, self._follow, _Missions(encoding, mission, rows, routes, position))
        segments = []
        while True:
            segments.append(copy.deepcopy(graph.run().lively()))
            if bool(graph.state.mission.done.all()):
                return segments

    def _graph(self, key: tuple[int, ...], function: Any, state: _Missions) -> Graph[_Missions, Any]:
        if key not in self._graphs:
            self._graphs[key] = Graph(function, state, self._generator)
        self._graphs[key].load(state)
        return self._graphs[key]

    def _decide(self, state: _Missions) -> tuple[Segment, Tensor]:
        segments: list[Segment] = []
        # Without autocast's cache, which would keep weights as they were when the graph was recorded.
        with autocast(state.rows.device, self._precision, cache=False), sdpa_kernel(ATTENTION):
            log_prob = run_segment(
                self._policy, state.encoding, state.mission, self._samples, self._generator, state.rows, segments
            )
        return segments[0], log_prob

    def _follow(self, state: _Missions) -> Segment:
        assert state.routes is not None
        assert state.position is not None
        return follow_segment(self._network, state.encoding, state.mission, state.routes, state.position, state.rows)
