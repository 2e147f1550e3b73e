"""From a network's probabilities to a plan: greedy, sampling, symmetric augmentation, beam search."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import torch

from mrta_zoo.batch import BatchMission
from mrta_zoo.plan import Plan
from mrta_zoo.policies.neural.beam_search import beam_search
from mrta_zoo.policies.neural.rollout import Rollout, Scorer, roll_out
from mrta_zoo.policies.neural.symmetry import SYMMETRIES, SymmetricNetwork
from mrta_zoo.policies.options import DEFAULT_SAMPLES, MAX_SAMPLES, Decode
from mrta_zoo.policies.stop import OutOfTimeError, TimeLimit
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import Scenario
from mrta_zoo.scenario_batch import ScenarioBatch

FIRST_SAMPLES = 4
"""Missions drawn at first when there is a budget, to see how long they take."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Decoding:
    """How to plan a mission with a network.

    Attributes:
        decode: see `options.Decode`.
        samples: missions drawn in one go, or the width of the beam; None is `DEFAULT_SAMPLES`.
        limit: when to stop searching; None makes one pass.
        must_plan: whether to finish the greedy mission even if that takes longer; otherwise there may be no plan.
        mask_rule: what robots may choose.
        seed: seeds the draws.
    """

    decode: Decode = "greedy"
    samples: int | None = None
    limit: TimeLimit | None = None
    must_plan: bool = True
    mask_rule: MaskRule = "feasible"
    seed: int = 0


def best_plan(network: Scorer, scenario: Scenario, how: Decoding) -> Plan:
    """The best plan found: most tasks completed, then least cost, then first found.

    Every way begins with the greedy mission or contains it, so that none completes fewer tasks.

    Raises:
        ConfigError: if the network gives probabilities that are not finite.
        OutOfTimeError: if the time is up before there is a plan, unless `how.must_plan`.
    """
    batch, best = ScenarioBatch.of([scenario], mask_rule=how.mask_rule), _Best()
    if not (how.decode == "augment" and how.limit is None):  # whose first mission is the greedy one
        limit = None if how.must_plan else how.limit
        best.offer(roll_out(network, batch, mask_rule=how.mask_rule, keep_plans=True, limit=limit))
    samples = how.samples or DEFAULT_SAMPLES.get(how.decode, 1)
    try:
        if how.decode == "sample":
            _sample(network, batch, samples, how, best)
        elif how.decode == "augment":
            eight = batch.repeat(SYMMETRIES)
            symmetric = SymmetricNetwork(network, eight)
            best.offer(roll_out(symmetric, eight, mask_rule=how.mask_rule, keep_plans=True, limit=how.limit))
            if how.limit is not None:
                _sample(symmetric, eight, math.ceil(samples / SYMMETRIES), how, best)
        elif how.decode == "beam":
            _beams(network, batch, samples, how, best)
    except OutOfTimeError:
        pass
    return best.plan


def _sample(network: Scorer, batch: ScenarioBatch, samples: int, how: Decoding, best: _Best) -> None:
    """Draw `samples` missions of each scenario of the batch, once or, with a budget, until the time is up.

    Raises:
        OutOfTimeError: if it is up before a draw is finished.
    """
    generator = torch.Generator().manual_seed(how.seed)

    def draw(count: int) -> None:
        best.offer(
            roll_out(
                network, batch, samples=count, generator=generator, mask_rule=how.mask_rule, keep_plans=True,
                limit=how.limit,
            )
        )  # fmt: skip

    if how.limit is None:
        draw(samples)
        return
    draws = min(samples, max(1, FIRST_SAMPLES // len(batch)))
    while draws > 0 and (before := how.limit.left()) > 0:
        draw(draws)
        left = how.limit.left()
        draws = min(samples, int(draws * left / (before - left)))


def _beams(network: Scorer, batch: ScenarioBatch, width: int, how: Decoding, best: _Best) -> None:
    """A beam of that width; with a budget, then one of twice the width, and so on until the time is up."""
    while True:
        for missions in beam_search(network, batch, width, mask_rule=how.mask_rule, limit=how.limit):
            best.offer_missions(missions)
        width *= 2
        if how.limit is None or how.limit.over or width > MAX_SAMPLES:
            return


class _Best:
    """The best plan so far: most tasks completed, then least cost, then first found."""

    def __init__(self) -> None:
        self.plan = Plan(())
        self._key = (-1, -math.inf)

    def offer(self, rollout: Rollout) -> None:
        """Compare with the missions of a rollout."""
        self._offer(rollout.completed, rollout.cost, lambda row: rollout.plans[row])

    def offer_missions(self, missions: BatchMission) -> None:
        """Compare with finished missions."""
        plans = missions.plans()
        self._offer(missions.completed(), missions.cost(), lambda row: plans[row])

    def _offer(self, completed: torch.Tensor, cost: torch.Tensor, plan: Callable[[int], Plan]) -> None:
        for row, key in enumerate(zip(completed.tolist(), (-cost).tolist(), strict=True)):
            if key > self._key:
                self._key, self.plan = key, plan(row)
