"""Gradient steps that imitate plans, before REINFORCE takes over."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import torch

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.rollout import Segment
from mrta_zoo.policies.neural.sharing import Network
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.distribution import draw_size
from mrta_zoo.train.gradients import accumulate_gradients
from mrta_zoo.train.imitation.decision_pool import DecisionPool
from mrta_zoo.train.imitation.decisions import PlanBatch, follow, turned
from mrta_zoo.train.imitation.experts import ExpertPlan
from mrta_zoo.train.random_streams import Stream, random_numbers
from mrta_zoo.wording import counted

POOL_STEPS, POOL_PLANS = 96, 8192
"""Steps that a pool of decisions serves, and the most plans that it holds over all sizes of scenarios. One decision
takes some 3 kB."""


class Imitator:
    """Learns from plans. All its randomness derives from (seed, number of the update).

    Args:
        config: the run.
        network: the one that learns.
        device: where the network is.
    """

    def __init__(self, config: TrainConfig, network: Network, device: torch.device) -> None:
        self._config, self._network, self._device = config, network, device
        self._plans: dict[int, PlanBatch] = {}
        self._pools: tuple[int, dict[int, DecisionPool]] = (-1, {})

    def set_plans(self, plans: Sequence[ExpertPlan]) -> None:
        """Set the plans to imitate.

        Raises:
            ConfigError: if there are no plans for one of the sizes.
        """
        for size in self._config.tasks:
            of_size = [plan for plan in plans if plan.scenario.num_tasks == size]
            if not of_size:
                raise ConfigError(f"there are no plans with {counted(size, 'task')} to imitate; make more of them")
            self._plans[size] = PlanBatch(of_size, self._device)

    def release(self) -> None:
        """Free the memory of the plans, once imitation is over."""
        self._plans, self._pools = {}, (-1, {})

    def accumulate(self, update: int) -> tuple[float, int]:
        """Accumulate the gradients of the negative mean log-probability of the decisions behind some plans.

        Args:
            update: number of the step.

        Returns:
            The negative mean log-probability, and the number of decisions.

        Raises:
            ConfigError: if there are no plans to imitate.
        """
        config = self._config
        if not self._plans:
            raise ConfigError("there are no plans to imitate; give them (set_plans), or set imitation_updates to 0")
        rng = random_numbers(config.seed, Stream.UPDATES, update)
        tasks = draw_size(config, rng)
        if config.imitation_decisions:
            drawing = torch.Generator().manual_seed(int(rng.integers(2**63)))
            pool = self._pool(update // POOL_STEPS, tasks)
            scenarios, drawn = pool.draw(config.imitation_batch, config.imitation_decisions, drawing)
            segments = [drawn]
        else:
            rows = self._some(tasks, config.imitation_batch, rng)
            scenarios, segments = self._followed(tasks, rows, np.full(len(rows), rng.integers(8)))
        decisions = sum(int(segment.live.sum()) for segment in segments)
        wanted = torch.full((len(scenarios), 1), -len(scenarios) / max(1, decisions), device=self._device)
        loss = accumulate_gradients(self._network, scenarios, segments, wanted, precision=config.precision)
        return loss, decisions

    def _some(self, tasks: int, count: int, rng: np.random.Generator) -> npt.NDArray[np.int64]:
        """Numbers of plans, drawn with replacement."""
        return rng.integers(len(self._plans[tasks]), size=count)

    def _followed(
        self, tasks: int, rows: npt.NDArray[np.int64], symmetry: npt.NDArray[np.int64]
    ) -> tuple[ScenarioBatch, list[Segment]]:
        """The decisions behind plans, each seen in one of the map's symmetries."""
        plans, chosen = self._plans[tasks], torch.from_numpy(rows).to(self._device)
        scenarios = turned(plans.scenarios.select(chosen), torch.from_numpy(symmetry).to(self._device))
        return scenarios, follow(self._network, scenarios, plans.routes[chosen])

    def _pool(self, number: int, tasks: int) -> DecisionPool:
        """Pool `number`, of scenarios with this many tasks."""
        config = self._config
        if self._pools[0] != number:
            self._pools = (number, {})
        pools = self._pools[1]
        if tasks not in pools:
            weights = dict(zip(config.tasks, config.task_weights or [1.0] * len(config.tasks), strict=True))
            plans = min(POOL_PLANS, POOL_STEPS * config.imitation_batch)  # no more than are drawn
            count = max(config.imitation_batch, round(plans * weights[tasks] / sum(weights.values())))
            rng = random_numbers(config.seed, Stream.POOLS, number, tasks)
            rows = self._some(tasks, count, rng)
            pools[tasks] = DecisionPool(*self._followed(tasks, rows, rng.integers(8, size=count)))
        return pools[tasks]
