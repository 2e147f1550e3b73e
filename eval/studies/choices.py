"""How differently networks choose when they are asked the same: the Jensen-Shannon divergence of their probabilities.

All are asked about the same moments, those that missions by the nearest-feasible rule pass through, which belong to
none of them; only those where there is something to choose count.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import combinations
from statistics import fmean

import pandas as pd
import torch
from torch import Tensor

from mrta_zoo.digits import share
from mrta_zoo.eval.report.parts import Section, Table
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


def unlikeness(study: Study) -> pd.DataFrame:
    """Of every arm: its networks against each other, and each against itself trained with other seeds, see `compared`.

    There is no row for what has no pairs, and none at all where there never was a choice.
    """
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
        found += [
            {"arm": arm, "compared": name, **compared(pairs)}
            for name, pairs in ((ACROSS, across), (AGAIN, again))
            if pairs and len(pairs[0][0])  # with one task per mission there never was a choice
        ]
    return pd.DataFrame(found)


def members(network: Network) -> Sequence[AllocationNetwork]:
    """The networks that there are."""
    return network.networks if isinstance(network, SeveralNetworks) else (network,)


def compared(pairs: Sequence[tuple[Tensor, Tensor]]) -> dict[str, float]:
    """How differently pairs of networks choose, from (D, N) probabilities.

    Returns:
        The number of pairs; D, the decisions that each network was asked about; the Jensen-Shannon divergence in bits,
        0 to 1, mean over pairs, and that of the most and the least alike; the share of the decisions where the
        likeliest tasks differ, 0 to 1.
    """
    each = [float(divergence(one, other).mean()) for one, other in pairs]
    return {
        "pairs": len(pairs),
        "decisions": len(pairs[0][0]),
        "divergence_bits": fmean(each),
        "least": min(each),
        "most": max(each),
        "disagreement": fmean(float((one.argmax(-1) != other.argmax(-1)).float().mean()) for one, other in pairs),
    }


def divergence(one: Tensor, other: Tensor) -> Tensor:
    """(D,) Jensen-Shannon divergence in bits of (D, N) probabilities: 0 if equal, 1 if nothing is in common."""
    return entropy((one + other) / 2) - (entropy(one) + entropy(other)) / 2


def entropy(probabilities: Tensor) -> Tensor:
    """(D,) entropy in bits of (D, N) probabilities."""
    bits: Tensor = torch.special.entr(probabilities).sum(-1) / math.log(2)
    return bits


def choices_section(found: pd.DataFrame) -> list[Section]:
    """A section on what `unlikeness` has found, if there is anything."""
    if found.empty:
        return []
    shown = pd.DataFrame(
        {
            "arm": found["arm"],
            "compared": found["compared"],
            "pairs": found["pairs"],
            "divergence, bits": found["divergence_bits"].map("{:.3f}".format),
            "least": found["least"].map("{:.3f}".format),
            "most": found["most"].map("{:.3f}".format),
            "other likeliest task, %": found["disagreement"].map(share),
        }
    )
    caption = (
        f"Jensen-Shannon divergence of two networks’ probabilities, 0 to 1 bit, mean over {found['decisions'][0]:,} "
        "decisions and over pairs, that of the most and the least alike pair, and how often their likeliest tasks "
        "differ. All networks were asked about the same moments, of missions that the nearest-feasible rule drives "
        f"through the first {SCENARIOS} held-out scenarios of each number of robots, if at least two tasks could be "
        "chosen."
    )
    text = (
        "If two robots trained together differ no more than one robot does from itself when trained with another seed, "
        "what sets them apart is chance, and no role that they have found.",
    )
    table = Table(name="choices", caption=caption, shown=shown, data=found)
    return [Section(title="How differently they choose", text=text, tables=(table,))]


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
