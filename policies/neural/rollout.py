"""Rollouts: a network runs missions in the batched simulator, greedily or by sampling."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import torch
from torch import Tensor

from mrta_zoo.batch import BatchMission
from mrta_zoo.errors import ConfigError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.neural.capam.candidates import Candidates
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks, Watch
from mrta_zoo.policies.neural.tensor_tree import select, tree_map
from mrta_zoo.policies.stop import TimeLimit
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario_batch import ScenarioBatch

SEGMENT = 12
"""Decisions between two checks for finished missions, which are then dropped to save work."""

NOT_FINITE = (
    "the network gives probabilities that are not finite: its weights are spoilt (did training diverge?), a feature or "
    "encoder of your own gives such numbers, or the scenario is beyond what float32 can hold"
)


class Scorer(Protocol):
    """Scores the tasks at each decision: a `sharing.Network`, or anything else with its methods."""

    def encode(self, tasks: Tasks) -> Any:
        """The encoding of S missions' tasks: a tree of tensors (`tensor_tree`) whose first dimension is S."""

    def features(self, encoding: Any, states: DecisionStates) -> Any:
        """What scoring these states needs besides, or None."""

    def __call__(self, encoding: Any, states: DecisionStates, features: Any = None) -> Any:
        """(S, G, N) log-probabilities of choosing each task, as `AllocationNetwork.forward` gives them."""


@dataclass(frozen=True, slots=True)
class Segment:
    """Consecutive decisions of the missions that were under way: Q = G · (number of decisions).

    Attributes:
        scenarios: (S',) int64 which scenarios they belong to.
        states: the states that they were taken in, (S', Q, …).
        features: what the network computed from those states, or None.
        actions: (S', Q) int64 the tasks chosen.
        live: (S', Q) bool, false where the mission was already over.
        sample: (Q,) int64 which of the G samples each belongs to.
    """

    scenarios: Tensor
    states: DecisionStates
    features: Candidates | None
    actions: Tensor
    live: Tensor
    sample: Tensor

    @classmethod
    def cat(cls, segments: Sequence[Segment]) -> Segment:
        """Decisions of the same missions, one segment after another."""

        def joined(*tensors: Tensor) -> Tensor:
            return torch.cat(tensors, 1)

        first = segments[0]
        return cls(
            scenarios=first.scenarios,
            states=tree_map(joined, *(each.states for each in segments)),
            features=tree_map(joined, *(each.features for each in segments)),
            actions=torch.cat([each.actions for each in segments], 1),
            live=torch.cat([each.live for each in segments], 1),
            sample=torch.cat([each.sample for each in segments]),
        )


@dataclass(frozen=True, slots=True)
class Rollout:
    """The outcome of B = S · G missions; row k·G + g is sample g of scenario k.

    Attributes:
        cost: (B,) float64, the objective, Eq. 1 of the paper.
        completed: (B,) int64 completed tasks.
        log_prob: (B,) float32, log-probability of all decisions together.
        plans: B plans, if asked for.
        segments: the decisions, if asked for.
    """

    cost: Tensor
    completed: Tensor
    log_prob: Tensor
    plans: list[Plan] = field(default_factory=list)
    segments: list[Segment] = field(default_factory=list)


def roll_out(
    network: Scorer,
    scenarios: ScenarioBatch,
    *,
    samples: int = 1,
    generator: torch.Generator | None = None,
    mask_rule: MaskRule = "feasible",
    keep_plans: bool = False,
    keep_segments: bool = False,
    limit: TimeLimit | None = None,
) -> Rollout:
    """Let `network` decide for all robots of all missions.

    Args:
        network: decides for each robot; its encoder runs once per scenario.
        scenarios: S scenarios.
        samples: G, how many missions to run of each.
        generator: draws the decisions from the network's probabilities; None takes the likeliest (greedy).
        mask_rule: what robots may choose.
        keep_plans: whether to return the plans.
        keep_segments: whether to return every decision, for learning.
        limit: when to give up; None never gives up.

    Raises:
        ConfigError: if the network gives probabilities that are not finite.
        OutOfTimeError: if the time is up before all missions are over.
    """
    # Inference mode is faster, but its tensors cannot take part in learning.
    with torch.no_grad() if keep_segments else torch.inference_mode():
        return _roll_out(network, scenarios, samples, generator, mask_rule, keep_plans, keep_segments, limit)


def _roll_out(
    network: Scorer,
    scenarios: ScenarioBatch,
    samples: int,
    generator: torch.Generator | None,
    mask_rule: MaskRule,
    keep_plans: bool,
    keep_segments: bool,
    limit: TimeLimit | None,
) -> Rollout:
    encoding = network.encode(Tasks.of_batch(scenarios))
    mission = BatchMission(scenarios.repeat(samples), mask_rule)
    total, device = len(scenarios) * samples, scenarios.device
    out = Rollout(
        cost=torch.zeros(total, dtype=torch.float64, device=device),
        completed=torch.zeros(total, dtype=torch.int64, device=device),
        log_prob=torch.zeros(total, device=device),
    )
    plans: list[Plan | None] = [None] * total
    under_way = torch.arange(len(scenarios), device=device)
    while True:
        live_scenarios = (~mission.done).unflatten(0, (-1, samples)).any(1)
        if not live_scenarios.all():
            rows = _rows(under_way, samples)
            out.cost[rows] = mission.cost()
            out.completed[rows] = mission.completed()
            if keep_plans:
                for row, plan in zip(rows.tolist(), mission.plans(), strict=True):
                    plans[row] = plan
            if not live_scenarios.any():
                break
            keep = live_scenarios.nonzero().squeeze(1)
            under_way = under_way[keep]
            mission = mission.select(_rows(keep, samples))
            encoding = select(encoding, keep)
        log_prob = _run_segment(
            network, encoding, mission, samples, generator, under_way, out.segments if keep_segments else None,
            limit,
        )  # fmt: skip
        # NaN would not only spoil the outcome: a mission that never takes a legal task would never end.
        if not torch.isfinite(log_prob).all():
            raise ConfigError(NOT_FINITE)
        out.log_prob[_rows(under_way, samples)] += log_prob
    out.plans.extend(plan for plan in plans if plan is not None)
    return out


def _run_segment(
    network: Scorer,
    encoding: Any,
    mission: BatchMission,
    samples: int,
    generator: torch.Generator | None,
    under_way: Tensor,
    segments: list[Segment] | None,
    limit: TimeLimit | None,
) -> Tensor:
    """Let the network take the next `SEGMENT` decisions of each mission.

    Args:
        network: decides.
        encoding: of the scenarios, by `network`.
        mission: B = S · G missions, which move on.
        samples: G.
        generator: draws the decisions; None takes the likeliest.
        under_way: (S,) int64 values for `Segment.scenarios`.
        segments: where the decisions go, or None.
        limit: no decision begins after it.

    Raises:
        OutOfTimeError: if the time is up.

    Returns:
        (B,) log-probability of the decisions together.
    """
    taken: list[Segment] = []
    sample = torch.arange(samples, device=mission.actor.device)
    log_prob = torch.zeros(len(mission.actor), device=mission.actor.device)
    watch = Watch(mission, samples)
    for _ in range(SEGMENT):
        if limit is not None:
            limit.check()
        states = watch.states()
        features = network.features(encoding, states)
        log_probs = network(encoding, states, features).flatten(0, 1)
        if generator is None:
            action = log_probs.argmax(-1)
        else:
            # Gumbel's trick: unlike torch.multinomial it never makes the CPU wait for the GPU.
            noise = torch.empty_like(log_probs).exponential_(generator=generator)
            action = (log_probs - noise.log()).argmax(-1)
        live = ~mission.done
        log_prob += torch.where(live, log_probs.gather(1, action[:, None]).squeeze(1), 0.0)
        if segments is not None:
            shape = (-1, samples)
            actions, lively = action.unflatten(0, shape), live.unflatten(0, shape)
            taken.append(Segment(under_way, states, features, actions, lively, sample))
        mission.step(action)
    if segments is not None:
        segments.append(Segment.cat(taken))
    return log_prob


def _rows(scenarios: Tensor, samples: int) -> Tensor:
    """The rows that the samples of some scenarios occupy."""
    return (scenarios[:, None] * samples + torch.arange(samples, device=scenarios.device)).flatten()
