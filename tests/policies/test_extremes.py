"""Networks at the edges of what a scenario may be, and when they are spoilt."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import torch

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.policies import stop
from mrta_zoo.policies.neural import decoding
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.inputs import Tasks
from mrta_zoo.policies.neural.capam.neighbourhood import Neighbourhood
from mrta_zoo.policies.neural.policy import NeuralPolicy, load_policy
from mrta_zoo.policies.neural.rollout import Rollout, roll_out
from mrta_zoo.policies.neural.sharing import build_network
from mrta_zoo.policies.neural.weights import PolicyInfo
from mrta_zoo.policies.pretrained import pretrained_names
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.suite import builtin_suite
from mrta_zoo.verify import verify

SMALL = NetworkConfig(embedding=32, heads=4)


@pytest.mark.parametrize("rule", ["feasible", "active", "unvisited"])
@pytest.mark.parametrize("name", pretrained_names())
def test_plans_are_legal_whatever_the_magnitudes(name: str, rule: MaskRule) -> None:
    policy, rng = load_policy(name), np.random.default_rng(0)
    for _ in range(40):
        n, m = rng.integers(1, 16), rng.integers(1, 4)
        side, due, work, rate, speed = 10.0 ** rng.uniform(-11, 11, 5)
        scenario = Scenario(
            rng.random((n, 2)) * side, due * rng.uniform(0.1, 10, n), work * rng.integers(0, 2, n),
            rng.random((m, 2)) * side, rate * rng.uniform(0.1, 10, m), speed * rng.uniform(0.1, 10, m), (side, side),
        )  # fmt: skip
        plan = policy.solve(scenario, mask_rule=rule)
        score = verify(scenario, plan)  # refuses a task taken twice
        if rule == "unvisited":
            assert sum(map(len, plan.routes)) == n
        if rule == "feasible":
            assert score.completed == sum(map(len, plan.routes))


def test_spoilt_weights_are_told_not_run_for_ever() -> None:
    network = build_network(SMALL, "shared", 1, seed=0)
    with torch.no_grad():
        next(network.parameters()).fill_(torch.nan)
    scenario = UniformGenerator(tasks=(8, 8))(np.random.default_rng(0))
    for sampler in (None, torch.Generator().manual_seed(0)):
        with pytest.raises(ConfigError, match="probabilities that are not finite"):
            roll_out(network, ScenarioBatch.of([scenario]), generator=sampler)
    env = mrta_v0.env(scenario=scenario)
    env.reset()
    with pytest.raises(ConfigError, match="probabilities that are not finite"):
        NeuralPolicy(network, PolicyInfo(network=SMALL)).act(env.last()[0])


def first_probabilities(policy: NeuralPolicy, scenario: Scenario, **room: int) -> np.ndarray:
    env = mrta_v0.env(scenario=scenario, **room)
    env.reset()
    return policy.decide(env.last()[0]).probabilities[: scenario.num_tasks]


@pytest.mark.parametrize("name", pretrained_names())
def test_neither_padding_nor_numbering_changes_the_probabilities(name: str) -> None:
    policy, rng = load_policy(name), np.random.default_rng(1)
    few_tasks = UniformGenerator(tasks=(2, 11), deadline=(200, 600))
    for scenario in [*builtin_suite()[::8], *(few_tasks(rng) for _ in range(30))]:
        order = rng.permutation(scenario.num_tasks)
        permuted = replace(
            scenario,
            task_xy=scenario.task_xy[order],
            deadline=scenario.deadline[order],
            workload=scenario.workload[order],
        )
        own = first_probabilities(policy, scenario)
        padded = first_probabilities(policy, scenario, max_tasks=scenario.num_tasks + 15, max_robots=9)
        np.testing.assert_allclose(padded, own, rtol=1e-3, atol=1e-5)
        np.testing.assert_allclose(first_probabilities(policy, permuted), own[order], rtol=1e-3, atol=1e-5)


def test_equally_near_neighbours_are_chosen_by_what_they_are() -> None:
    # 25 tasks on a grid: most distances are tied, and each task has more than 12 others.
    xy = np.array([[x, y] for x in range(5) for y in range(5)], dtype=float)
    deadline = np.linspace(10, 20, 25)
    order = np.random.default_rng(2).permutation(25)
    sets = []
    for each in (np.arange(25), order):
        scenario = Scenario(xy[each], deadline[each], np.ones(25), [[0, 0]], [1], map_size=(5, 5))  # type: ignore[arg-type]
        near = Neighbourhood.of(Tasks.of_batch(ScenarioBatch.of([scenario]))).index[0].numpy()
        sets.append({int(each[task]): frozenset(each[near[task]].tolist()) for task in range(25)})
    assert sets[0] == sets[1]


def test_a_policy_in_training_decides_by_its_present_weights() -> None:
    network = build_network(SMALL, "shared", 1, seed=0)
    env = mrta_v0.env()
    env.reset(seed=0)
    observation, policy = env.last()[0], NeuralPolicy(network, PolicyInfo(network=SMALL))
    before = policy.decide(observation).probabilities
    with torch.no_grad():
        for parameter in network.encoder.parameters():  # type: ignore[union-attr]
            parameter.mul_(3)
    after = policy.decide(observation).probabilities
    assert not np.allclose(before, after)
    np.testing.assert_array_equal(
        after, NeuralPolicy(network, PolicyInfo(network=SMALL)).decide(observation).probabilities
    )


@pytest.mark.parametrize(
    ("pace", "budget", "drawn"),
    [
        (1.0, 0.5, []),  # the greedy mission alone takes longer
        (1.0, 3.0, [4]),  # the first draws, which tell the pace, are past the end: not one more
        (1.0, 10.0, [4, 5]),  # 1 + 4 + 5: as many as there is time for
        (0.125, 20.0, [4, 64, 64, 27]),  # 160 in all, 64 at most in one go
    ],
)
def test_a_budget_is_kept(monkeypatch: pytest.MonkeyPatch, pace: float, budget: float, drawn: list[int]) -> None:
    # By a clock that a mission moves on by `pace` seconds, however fast this machine is.
    now, batches = 0.0, []

    def timed_roll_out(*arguments: Any, samples: int = 1, **options: Any) -> Rollout:
        nonlocal now
        now += pace * samples
        batches.append(samples)
        return roll_out(*arguments, samples=samples, **options)

    monkeypatch.setattr(decoding, "roll_out", timed_roll_out)
    monkeypatch.setattr(stop, "time", SimpleNamespace(perf_counter=lambda: now))
    scenario = UniformGenerator(tasks=(8, 8), robots=(2, 2))(np.random.default_rng(0))
    policy = NeuralPolicy(build_network(SMALL, "shared", 1, seed=0), PolicyInfo(network=SMALL))
    policy.solve(scenario, decode="sample", budget=budget)
    assert batches == [1, *drawn]
