"""How differently networks choose when they are asked the same: the Jensen-Shannon divergence of their probabilities.

All are asked about the same moments, those that missions by the nearest-feasible rule pass through, which belong to
none of them; only those where there is something to choose count.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations
from statistics import fmean

import torch
from torch import Tensor

from mrta_zoo.eval.studies.study import Study
from mrta_zoo.policies.neural.capam.inputs import Tasks
from mrta_zoo.policies.neural.capam.network import AllocationNetwork
from mrta_zoo.policies.neural.rollout import Segment
from mrta_zoo.policies.neural.sharing import Network, SeveralNetworks
from mrta_zoo.policies.neural.tensor_tree import select
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.scenario import Scenario
from mrta_zoo.train.imitation.decisions import PlanBatch, follow
from mrta_zoo.train.imitation.experts import ExpertPlan

SCENARIOS = 16
"""Held-out scenarios of each number of robots whose moments the networks are asked about."""

ACROSS, AGAIN = "networks of one run", "one network, runs of other seeds"
"""What is compared: what training has made of different robots, and what it makes of the same ones by chance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Unlikeness:
    """How differently pairs of networks choose.

    Attributes:
        arm: they belong to.
        pairs: `ACROSS` or `AGAIN`.
        count: number of pairs.
        decisions: that each network was asked about.
        divergence: mean Jensen-Shannon divergence of the probabilities, in bits, 0 to 1.
        least: of the pair that is most alike.
        most: of the pair that is least alike.
        disagreement: share of the decisions where the likeliest tasks differ, 0 to 1.
    """

    arm: str
    pairs: str
    count: int
    decisions: int
    divergence: float
    least: float
    most: float
    disagreement: float


def unlikeness(study: Study) -> list[Unlikeness]:
    """Of every arm: its networks against each other, and each against itself trained with other seeds."""
    scenarios = [
        scenario
        for robots in study.design.compared
        for scenario in study.design.held_out.scenarios("taptc", robots)[:SCENARIOS]
    ]
    asked = Questionnaire(scenarios)
    found = []
    for arm in study.design.arms:
        answers = [
            [asked.answers(network) for network in members(study.policies[arm, seed].network)]
            for seed in range(study.design.seeds)
        ]
        across = [pair for of_run in answers for pair in combinations(of_run, 2)]
        again = [pair for of_network in zip(*answers, strict=True) for pair in combinations(of_network, 2)]
        for name, pairs in ((ACROSS, across), (AGAIN, again)):
            if pairs and len(pairs[0][0]):  # with a task a mission there never was a choice
                found.append(compared(arm, name, pairs))
    return found


def members(network: Network) -> Sequence[AllocationNetwork]:
    """The networks that there are."""
    return network.networks if isinstance(network, SeveralNetworks) else (network,)


def compared(arm: str, name: str, pairs: Sequence[tuple[Tensor, Tensor]]) -> Unlikeness:
    """Summary of pairs of (D, N) probabilities."""
    each = [float(divergence(one, other).mean()) for one, other in pairs]
    return Unlikeness(
        arm=arm,
        pairs=name,
        count=len(pairs),
        decisions=len(pairs[0][0]),
        divergence=fmean(each),
        least=min(each),
        most=max(each),
        disagreement=fmean(float((one.argmax(-1) != other.argmax(-1)).float().mean()) for one, other in pairs),
    )


def divergence(one: Tensor, other: Tensor) -> Tensor:
    """(D,) Jensen-Shannon divergence in bits of (D, N) probabilities: 0 if equal, 1 if nothing is in common."""
    return entropy((one + other) / 2) - (entropy(one) + entropy(other)) / 2


def entropy(probabilities: Tensor) -> Tensor:
    """(D,) entropy in bits of (D, N) probabilities."""
    bits: Tensor = torch.special.entr(probabilities).sum(-1) / math.log(2)
    return bits


class Questionnaire:
    """The moments that networks are asked about, in missions by the nearest-feasible rule.

    Args:
        scenarios: of these missions.
    """

    def __init__(self, scenarios: Iterable[Scenario]) -> None:
        nearest = make_solver("nearest")
        plans = [ExpertPlan(scenario, nearest.solve(scenario).routes) for scenario in scenarios]
        self._batch = PlanBatch(plans, torch.device("cpu"))

    @torch.no_grad()
    def answers(self, network: AllocationNetwork) -> Tensor:
        """(D, N) its probabilities at each moment where at least two tasks may be chosen, whoever is to act."""
        segments = follow(network, self._batch.scenarios, self._batch.routes)
        encoding = network.encode(Tasks.of_batch(self._batch.scenarios))

        def of(segment: Segment) -> Tensor:
            log_probs: Tensor = network(select(encoding, segment.scenarios), segment.states, segment.features)
            counts = segment.live & (segment.states.mask.sum(-1) >= 2)
            return log_probs[counts].exp()

        return torch.cat([of(segment) for segment in segments])
