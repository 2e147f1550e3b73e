"""Imitation before REINFORCE: it learns, the switch, step sizes, and scenarios drawn by other processes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
import torch

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.classical.local_search.eils import EilsConfig, EilsSolver
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.inputs import Tasks
from mrta_zoo.policies.neural.rollout import Segment
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train import reinforce
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.distribution import draw_size, most_robots, team
from mrta_zoo.train.imitation import imitator
from mrta_zoo.train.imitation.decisions import PlanBatch, follow
from mrta_zoo.train.imitation.experts import ExpertPlan, expert_scenario
from mrta_zoo.train.reinforce import Reinforce, Update, Validation

ATTENTION = NetworkConfig(embedding=32, heads=4)
CANDIDATES = replace(ATTENTION, decoder="candidates", decision_layers=1, candidates=10, peers=2)
TINY = TrainConfig(
    network=ATTENTION, tasks=(10,), reference_tasks=10, min_robots=2, max_robots=3, generator="mixture",
    imitation_updates=3, imitation_plans=16, imitation_batch=4, scenarios=2, samples=2, updates=2, epoch=5,
    validation_scenarios=4, device="cpu",
)  # fmt: skip


def plans_of(config: TrainConfig, first: int, count: int) -> list[ExpertPlan]:
    solver = EilsSolver(config=EilsConfig(iterations_per_task=3, least_iterations=30))
    scenarios = [expert_scenario(config, number) for number in range(first, first + count)]
    return [ExpertPlan(scenario, solver.solve(scenario).routes) for scenario in scenarios]


def cross_entropy(run: Reinforce, plans: list[ExpertPlan]) -> float:
    """Minus the mean log-probability of the plans' decisions, in nats."""
    batch, total, count = PlanBatch(plans, run.device), 0.0, 0
    with torch.no_grad():
        encoding = run.network.encode(Tasks.of_batch(batch.scenarios))
        for segment in follow(run.network, batch.scenarios, batch.routes):
            log_probs = run.network(encoding, segment.states, segment.features)  # type: ignore[arg-type]
            chosen = log_probs.gather(2, segment.actions[..., None]).squeeze(2)[segment.live]
            total, count = total - float(chosen.sum()), count + len(chosen)
    return total / count


@pytest.mark.parametrize("decisions", [0, 8], ids=["all-decisions", "pool"])
@pytest.mark.parametrize("network", [ATTENTION, CANDIDATES], ids=["attention", "candidates"])
def test_imitation_alone_prefers_what_experts_do(
    network: NetworkConfig, decisions: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(imitator, "POOL_PLANS", 200)
    monkeypatch.setattr(imitator, "POOL_STEPS", 25)
    config = replace(
        TINY, network=network, imitation_updates=60, imitation_plans=128, imitation_batch=32,
        imitation_decisions=decisions, imitation_learning_rate=5e-3,
    )  # fmt: skip
    run = Reinforce(config)
    run.set_plans(plans_of(config, 0, 128))
    held_out = plans_of(config, 1000, 64)
    before = cross_entropy(run, held_out)
    losses = [run.step().loss for _ in range(60)]
    after = cross_entropy(run, held_out)
    assert after < before - 0.2  # some 1.53 to 1.21, and 0.94 to 0.61
    assert sum(losses[-10:]) / 10 == pytest.approx(after, abs=0.3)  # the loss is that cross-entropy


def steps(run: Reinforce) -> set[float]:
    """How many steps Adam has made of each parameter."""
    return {float(state["step"]) for state in run.optimizer.state.values()}


def test_adam_starts_afresh_when_reinforce_begins() -> None:
    run = Reinforce(TINY)
    run.set_plans(plans_of(TINY, 0, 16))
    seen = []
    for _ in range(5):
        run.step()
        seen.append(steps(run))
    assert seen == [{1}, {2}, {3}, {1}, {2}]


def test_events_of_both_phases() -> None:
    run = Reinforce(replace(TINY, epoch=2))
    run.set_plans(plans_of(TINY, 0, 16))
    events = list(run.run())
    assert [each.update for each in events if isinstance(each, Update)] == [1, 2, 3, 4, 5]
    validations = [each for each in events if isinstance(each, Validation)]
    assert [each.update for each in validations] == [0, 2, 4, 5]
    # Imitation samples no missions; each update of REINFORCE samples 2 x 2.
    assert [each.episodes for each in validations] == [0, 0, 4, 8]


def test_imitation_without_plans_is_told() -> None:
    with pytest.raises(ConfigError, match="there are no plans to imitate"):
        Reinforce(TINY).step()
    with pytest.raises(ConfigError, match="there are no plans with 10 tasks to imitate"):
        Reinforce(TINY).set_plans(plans_of(replace(TINY, tasks=(7,)), 0, 2))


def test_step_sizes_of_both_phases() -> None:
    config = replace(
        TINY, imitation_updates=40, updates=60, imitation_learning_rate=1e-3, learning_rate=3e-4,
        final_learning_rate=3e-5, epoch=100,
    )  # fmt: skip
    run = Reinforce(config)
    run._imitator.accumulate = lambda update: (0.0, 1)  # type: ignore[method-assign]
    run._reinforce = lambda: (0.0, 1)  # type: ignore[method-assign]
    rates = [run.step().learning_rate for _ in range(100)]
    # Imitation: a cosine from 1e-3 to 1e-4 over 40 updates, whose start is damped by (update + 1)/20 at first.
    assert rates[0] == pytest.approx(1e-4 + (5e-5 - 1e-4))  # 1e-3 · 1/20 = 5e-5, cos 0 = 1
    assert rates[9] == pytest.approx(1e-4 + (5e-4 - 1e-4) * (1 + math.cos(math.pi * 9 / 40)) / 2)
    assert rates[20] == pytest.approx(1e-4 + 9e-4 / 2)  # half-way, cos(π/2) = 0
    assert rates[39] == pytest.approx(1e-4 + 9e-4 * (1 + math.cos(math.pi * 39 / 40)) / 2)
    # REINFORCE: from 3e-4 to 3e-5 over 60 updates, damped again.
    assert rates[40] == pytest.approx(3e-5 + (1.5e-5 - 3e-5))  # 3e-4/20 = 1.5e-5
    assert rates[70] == pytest.approx(3e-5 + 2.7e-4 / 2)
    assert rates[99] == pytest.approx(3e-5 + 2.7e-4 * (1 + math.cos(math.pi * 59 / 60)) / 2)
    assert max(rates[:40]) < 1e-3
    assert max(rates[40:]) < 3e-4


def test_a_pool_serves_some_steps_and_holds_plans_of_each_size_by_its_weight(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(imitator, "POOL_PLANS", 60)
    monkeypatch.setattr(imitator, "POOL_STEPS", 4)
    config = replace(TINY, tasks=(8, 10), task_weights=(1.0, 3.0), imitation_updates=12, imitation_decisions=3)
    run = Reinforce(config)
    run.set_plans(plans_of(config, 0, 16))
    made: list[tuple[int, int, int]] = []
    places: list[float] = []

    class Noted(imitator.DecisionPool):
        def __init__(self, scenarios: ScenarioBatch, segments: Sequence[Segment]) -> None:
            made.append((run.update // 4, scenarios.num_tasks, len(scenarios)))
            places.append(float(scenarios.task_xy.sum()))
            super().__init__(scenarios, segments)

    monkeypatch.setattr(imitator, "DecisionPool", Noted)
    decisions = [run.step().decisions for _ in range(12)]
    assert len(set(made)) == len(made), "one of each size, while it serves"
    assert {number for number, *_ in made} == {0, 1, 2}
    assert {size: count for _, size, count in made} == {8: 4, 10: 12}  # 4 steps of 4 plans, 1/4 and 3/4 of these
    assert len(set(places)) == len(places), "each time of other plans, seen otherwise"
    assert set(decisions) <= {3 * plans for plans in range(1, 5)}  # 4 plans, 3 decisions of each that has any
    assert run._imitator._pools[1]
    run.step()
    assert not run._imitator._pools[1]  # they take memory
    assert not run._imitator._plans


def test_the_entropy_bonus_falls_to_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    weights: list[float] = []

    def noted(
        network: object, scenarios: object, segments: object, advantage: object, entropy: float, *_: str
    ) -> float:
        weights.append(entropy)
        return 0.0

    monkeypatch.setattr(reinforce, "accumulate_gradients", noted)
    run = Reinforce(replace(TINY, imitation_updates=0, updates=10, entropy=0.3))
    monkeypatch.setattr(torch.nn.utils, "clip_grad_norm_", lambda *_: torch.zeros(()))
    for _ in range(10):
        run.step()
    assert weights == pytest.approx([0.3 * (1 + math.cos(math.pi * k / 10)) / 2 for k in range(10)])
    assert weights[0] == 0.3
    assert weights[5] == pytest.approx(0.15)


def test_sizes_are_drawn_by_their_weights() -> None:
    config = replace(TINY, tasks=(10, 20, 50), task_weights=(1.0, 2.0, 5.0))
    rng = np.random.default_rng(0)
    drawn = [draw_size(config, rng) for _ in range(4000)]
    # 1/8, 2/8 and 5/8; three standard deviations are at most 0.023.
    assert [drawn.count(size) / 4000 for size in config.tasks] == pytest.approx([0.125, 0.25, 0.625], abs=0.023)
    # 2 to 3 robots for 10 tasks: 4 to 6 for 20, 10 to 15 for 50.
    assert [team(config, size) for size in config.tasks] == [(2, 3), (4, 6), (10, 15)]
    assert team(replace(config, reference_tasks=100), 10) == (1, 1)  # 0.2 and 0.3, but at least one
    assert most_robots(config) == 15


def test_independent_networks_are_as_many_as_the_largest_team() -> None:
    run = Reinforce(
        replace(TINY, sharing="independent", imitation_updates=0, tasks=(10, 20), min_robots=3, updates=4, epoch=4)
    )
    sizes = {run.step().decisions > 0 for _ in range(4)}
    assert sizes == {True}
