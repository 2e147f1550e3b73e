"""Pools of decisions from many plans, to draw gradient steps from."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.rollout import Segment
from mrta_zoo.policies.neural.tensor_tree import select, tree_map
from mrta_zoo.scenario_batch import ScenarioBatch


class DecisionPool:
    """The decisions behind plans, in one table, to draw from many times: following plans anew takes longer.

    Args:
        scenarios: S scenarios.
        segments: the decisions of `follow` on them.

    Raises:
        ConfigError: if there are no decisions.
    """

    def __init__(self, scenarios: ScenarioBatch, segments: Sequence[Segment]) -> None:
        taken = [segment.live.nonzero(as_tuple=True) for segment in segments]
        if not sum(len(row) for row, _ in taken):
            raise ConfigError("none of the plans to imitate has a task; were they made for other scenarios?")
        owner = torch.cat([segment.scenarios[row] for segment, (row, _) in zip(segments, taken, strict=True)])
        order = owner.argsort(stable=True)

        def flat(*tables: Tensor) -> Tensor:
            return torch.cat([table[at] for table, at in zip(tables, taken, strict=True)])[order]

        self.scenarios = scenarios
        self.actions = flat(*(segment.actions for segment in segments))
        self.states = tree_map(flat, *(segment.states for segment in segments))
        self.features = tree_map(flat, *(segment.features for segment in segments))
        self.count = owner.bincount(minlength=len(scenarios))
        """(S,) how many decisions each plan has."""
        self._first = self.count.cumsum(0) - self.count

    def draw(self, plans: int, decisions: int, generator: torch.Generator) -> tuple[ScenarioBatch, Segment]:
        """Some of the decisions of some of the plans, each drawn independently.

        Args:
            plans: how many plans, S'.
            decisions: how many of each, Q.
            generator: of the draws, on the CPU.

        Returns:
            the plans' scenarios, and the decisions, (S', Q).
        """
        device = self.actions.device
        rows = torch.randint(len(self.count), (plans,), generator=generator).to(device)
        count = self.count[rows, None]
        share = torch.rand(plans, decisions, generator=generator, dtype=torch.float64).to(device)
        # A plan without decisions gets another plan's, which are not live; the clamp is for the last plan.
        at = (self._first[rows, None] + (share * count).long()).clamp(max=len(self.actions) - 1)
        drawn = Segment(
            scenarios=torch.arange(plans, device=device),
            states=select(self.states, at),
            features=select(self.features, at),
            actions=self.actions[at],
            live=(count > 0).expand(-1, decisions),
            sample=torch.zeros(decisions, dtype=torch.int64, device=device),
        )
        return self.scenarios.select(rows), drawn
