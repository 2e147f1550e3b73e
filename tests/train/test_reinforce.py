"""REINFORCE: its gradient, its determinism, and that it learns."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import torch
from factories import hopeless_scenario
from torch import Tensor

from mrta_zoo import Scenario
from mrta_zoo.batch import BatchMission
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.rollout import roll_out
from mrta_zoo.policies.neural.sharing import build_network
from mrta_zoo.policies.neural.tensor_tree import select
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train import reinforce
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.gradients import accumulate_gradients
from mrta_zoo.train.reinforce import Reinforce, Validation

SMALL = NetworkConfig(embedding=32, heads=4)
TINY = TrainConfig(
    network=SMALL,
    tasks=(10,),
    reference_tasks=10,
    min_robots=1,
    max_robots=3,
    scenarios=4,
    samples=4,
    updates=4,
    epoch=2,
    validation_scenarios=8,
)


@pytest.mark.parametrize("sharing", ["shared", "independent", "by-capacity"])
@pytest.mark.parametrize("decoder", ["attention", "candidates"])
def test_accumulated_gradient_is_that_of_decisions_taken_one_by_one(sharing: str, decoder: str) -> None:
    config = replace(SMALL, decoder=decoder, decision_layers=2, candidates=15, peers=2)
    network = build_network(config, sharing, robots=4, seed=0)  # type: ignore[arg-type]
    rng = np.random.default_rng(0)
    # Missions of very different lengths, so that some are dropped on the way.
    scenarios = ScenarioBatch.of(
        [TaptcGenerator(tasks=n, robots=(1, 4))(rng) for n in (3, 40, 12)]  # type: ignore[arg-type]
    )
    rollout = roll_out(
        network,
        scenarios,
        samples=3,
        generator=torch.Generator().manual_seed(0),
        keep_segments=True,
        keep_plans=True,
    )
    advantage = torch.randn(3, 3, generator=torch.Generator().manual_seed(1))
    mean = accumulate_gradients(network, scenarios, rollout.segments, advantage)
    gradients = {name: p.grad.clone() for name, p in network.named_parameters() if p.grad is not None}

    network.zero_grad(set_to_none=True)
    repeated = scenarios.repeat(3)
    mission = BatchMission(repeated)
    position = [[0] * scenarios.num_robots for _ in range(9)]
    encoding = network.encode(Tasks.of_batch(repeated))
    log_prob = torch.zeros(9)
    while not mission.done.all():
        action = torch.zeros(9, dtype=torch.int64)
        for row, robot in enumerate(mission.actor.tolist()):
            if robot >= 0:
                action[row] = rollout.plans[row].routes[robot][position[row][robot]]
                position[row][robot] += 1
        scores = network(encoding, DecisionStates.of_batch(mission))[:, 0].gather(1, action[:, None])[:, 0]
        log_prob = log_prob + torch.where(mission.done, 0.0, scores)
        mission.step(action)
    torch.testing.assert_close(log_prob.detach(), rollout.log_prob, rtol=1e-4, atol=1e-4)
    surrogate = (advantage.flatten() * log_prob).mean()
    surrogate.backward()
    assert mean == pytest.approx(float(surrogate.detach()), rel=1e-4, abs=1e-5)
    assert gradients.keys() == {name for name, p in network.named_parameters() if p.grad is not None}
    for name, parameter in network.named_parameters():
        if parameter.grad is not None:
            torch.testing.assert_close(gradients[name], parameter.grad, rtol=1e-3, atol=1e-5, msg=name)


@pytest.mark.parametrize("sharing", ["shared", "independent", "by-capacity"])
@pytest.mark.parametrize("decoder", ["attention", "candidates"])
def test_accumulated_gradient_is_autograds_of_the_whole_surrogate(sharing: str, decoder: str) -> None:
    config = replace(SMALL, decoder=decoder, decision_layers=1, candidates=6, peers=2)
    network = build_network(config, sharing, robots=5, seed=0)  # type: ignore[arg-type]
    rng = np.random.default_rng(3)
    generator = TaptcGenerator(tasks=20, robots=(1, 3))  # type: ignore[arg-type]
    scenarios = ScenarioBatch.of([generator(rng) for _ in range(4)])
    sampling = torch.Generator().manual_seed(2)
    rollout = roll_out(network, scenarios, samples=3, generator=sampling, keep_segments=True)
    advantage = torch.randn(4, 3, generator=sampling)
    mean = accumulate_gradients(network, scenarios, rollout.segments, advantage, entropy=0.3)
    gradients = {name: p.grad.clone() for name, p in network.named_parameters() if p.grad is not None}

    network.zero_grad(set_to_none=True)
    encoding = network.encode(Tasks.of_batch(scenarios))
    surrogate = torch.zeros(())
    for segment in rollout.segments:
        log_probs = network(select(encoding, segment.scenarios), segment.states)  # type: ignore[arg-type]
        for row, q in segment.live.nonzero().tolist():
            chosen = log_probs[row, q, segment.actions[row, q]]
            likely = log_probs[row, q][torch.isfinite(log_probs[row, q])]
            entropy = -(likely.exp() * likely).sum()
            weight = advantage[segment.scenarios[row], segment.sample[q]]
            surrogate = surrogate + (weight * chosen - 0.3 * entropy) / 12  # missions
    surrogate.backward()
    assert mean == pytest.approx(float(surrogate.detach()), rel=1e-4, abs=1e-5)
    # Nothing was decided by the networks of robots 3 and 4, which no scenario has.
    wanted = {name: p.grad for name, p in network.named_parameters() if p.grad is not None}
    assert gradients.keys() == wanted.keys()
    for name, gradient in wanted.items():
        torch.testing.assert_close(gradients[name], gradient, rtol=1e-3, atol=1e-5, msg=name)


def test_without_any_decision_there_is_no_gradient() -> None:
    network = build_network(SMALL, "shared", 1, seed=0)
    scenarios = ScenarioBatch.of([hopeless_scenario()])
    assert accumulate_gradients(network, scenarios, [], torch.ones(1, 2)) == 0
    assert all(parameter.grad is None for parameter in network.parameters())


@pytest.mark.parametrize("baseline", ["samples", "rollout"])
@pytest.mark.parametrize("sharing", ["shared", "independent", "by-capacity"])
def test_a_seed_gives_the_same_run(baseline: str, sharing: str) -> None:
    config = replace(TINY, baseline=baseline, sharing=sharing)
    runs = [list(Reinforce(each).run()) for each in (config, config, replace(config, seed=1))]
    assert runs[0] == runs[1] != runs[2]
    assert [event.update for event in runs[0] if isinstance(event, Validation)] == [0, 2, 4]


def test_an_objective_of_your_own_is_what_is_minimised() -> None:
    # As many points as tasks were completed: the loss is their mean, and the fewer the better.
    run = Reinforce(TINY, objective=lambda rollout, scenarios: rollout.completed.double())
    first = run.step()
    assert 1 <= first.loss <= 10
    assert first.loss == pytest.approx(10 * (1 - Reinforce(TINY).step().loss))  # the same missions, seen otherwise


@pytest.mark.parametrize(
    ("given", "described"),
    [
        (lambda cost: None, "None"),
        (lambda cost: 0.5, "0.5"),
        (lambda cost: cost.numpy(), "array"),
        (lambda cost: cost.mean(), r"a tensor of torch.float\d\d and shape \(\)"),
        (lambda cost: cost[:, None], r"a tensor of torch.float\d\d and shape \(\d+, 1\)"),
        (lambda cost: cost.long(), r"a tensor of torch.int64 and shape \(\d+,\)"),
    ],
)
def test_an_objective_that_gives_no_losses_is_refused(given: Callable[[Tensor], Any], described: str) -> None:
    missions = TINY.scenarios * TINY.samples
    run = Reinforce(TINY, objective=lambda rollout, scenarios: given(rollout.cost))
    sentence = rf"the objective gave {described}.*; expected a floating-point tensor of shape \({missions},\)"
    with pytest.raises(ConfigError, match=sentence):
        run.step()
    with pytest.raises(ConfigError, match=f"the objective gave {described}"):
        list(run.run())


def test_a_generator_that_draws_no_scenario_is_refused() -> None:
    run = Reinforce(TINY, generator=lambda rng, name="": rng.random())  # type: ignore[arg-type, return-value]
    for use in (run.step, run.validate):
        with pytest.raises(ConfigError, match=r"the generator drew 0\.\d+; expected a mrta_zoo.Scenario"):
            use()


def test_without_temperature_samples_are_all_the_same_and_nothing_is_learned() -> None:
    """Near 0 all samples of a scenario are its greedy mission: none is better than the mean of the others."""
    cold, warm = (Reinforce(replace(TINY, temperature=temperature, normalise=False)) for temperature in (1e-6, 1.0))
    assert cold.step().gradient_norm == 0
    assert warm.step().gradient_norm > 0


def test_the_policy_that_samples_is_the_one_that_learns(monkeypatch: pytest.MonkeyPatch) -> None:
    policies = []

    def noted(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(policy: Any, *arguments: Any, **options: Any) -> Any:
            policies.append(policy)
            return function(policy, *arguments, **options)

        return call

    for name in ("roll_out", "accumulate_gradients"):
        monkeypatch.setattr(reinforce, name, noted(getattr(reinforce, name)))
    run = Reinforce(replace(TINY, temperature=0.5))
    run.step()
    sampling, learning = policies
    assert sampling is learning
    assert sampling is not run.network


class FirstThingsFirst:
    """One robot, two tasks: near (10 away) and far (20 away, the other side); work takes no time. What is due first
    must come first, which is either with probability 1/2, so that going by places alone completes 3/4 on average.

    The far one due at 20, the near one at 50. Far first: done at 20 and 20 + 30 = 50, both in time. Near first: 10,
    then 10 + 30 = 40 > 20, too late: half.
    The near one due at 10, the far one at 40. Near first: done at 10 and 10 + 30 = 40, both in time. Far first: 20,
    then 20 + 30 = 50 > 10, too late: half.
    """

    def __call__(self, rng: np.random.Generator, name: str = "first things first") -> Scenario:
        angle = rng.uniform(0, 2 * np.pi)
        step = np.array([np.cos(angle), np.sin(angle)])
        due = np.array([50.001, 20.001] if rng.random() < 0.5 else [10.001, 40.001])
        places = np.array([50 + 10 * step, 50 - 20 * step])
        order = rng.permutation(2)
        return Scenario(places[order], due[order], np.zeros(2), [[50, 50]], [1.0], name=name)


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"baseline": "rollout", "samples": 1, "scenarios": 64},
        {"sharing": "independent"},
        {"network": NetworkConfig(encoder="attention", embedding=32, heads=4, layers=2), "seed": 2},
        {
            "network": NetworkConfig(embedding=32, heads=4, decoder="candidates", decision_layers=2),
            "scenarios": 8,
            "samples": 8,
            "updates": 40,
            "learning_rate": 1e-2,
            "temperature": 4.0,  # at the start it prefers what is near: too much, at such distances, to try the far one
        },
        {"objective": "cost", "entropy": 0.01},
        {"objective": "relative", "temperature": 0.5},
    ],
    ids=[
        "capam",
        "rollout-baseline",
        "independent",
        "am",
        "candidates",
        "cost-and-entropy",
        "relative-and-temperature",
    ],
)
def test_learns_to_do_first_what_is_due_first(change: dict[str, object]) -> None:
    config = replace(TINY, max_robots=1, scenarios=16, updates=20, epoch=60, learning_rate=3e-3, clip_norm=10.0)
    run = Reinforce(replace(config, **change), generator=FirstThingsFirst())  # type: ignore[arg-type]
    first, *_, last = run.run()
    assert isinstance(first, Validation)
    assert isinstance(last, Validation)
    assert first.completion < 0.9
    assert last.completion > 0.95


def test_divergence_is_told_and_changes_no_weights() -> None:
    run = Reinforce(TINY)
    run.objective = lambda rollout, scenarios: rollout.cost * torch.nan
    before = {name: value.clone() for name, value in run.network.state_dict().items()}
    with pytest.raises(ConfigError, match="training diverged in update 1"):
        run.step()
    assert all(torch.equal(value, before[name]) for name, value in run.network.state_dict().items())


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"updates": 0}, "updates is 0; expected a whole number >= 1"),
        ({"learning_rate": 0.0}, "learning_rate is 0.0; expected a number > 0"),
        ({"learning_rate": float("nan")}, "learning_rate is nan; expected a number > 0"),
        ({"temperature": 0.0}, "temperature is 0.0; expected a number from 1e-6 to 1e6"),
        ({"temperature": 1e-300}, "temperature is 1e-300; expected a number from 1e-6 to 1e6"),
        ({"temperature": float("nan")}, "temperature is nan; expected a number from 1e-6 to 1e6"),
        ({"max_robots": 0}, "max_robots is 0; expected at least min_robots, 1"),
        ({"samples": 1}, "samples is 1, expected >= 2"),
        ({"baseline": "critic"}, "baseline is 'critic'; expected one of samples, rollout"),
        ({"mask_rule": "all"}, "mask_rule is 'all'; expected one of feasible, active, unvisited"),
        ({"significance": 1.0}, "significance is 1.0; expected a number between 0 and 1"),
        ({"seed": -1}, "seed is -1; expected a whole number from 0 to 9223372036854775807"),
        ({"seed": 10**30}, "expected a whole number from 0 to 9223372036854775807"),
        ({"entropy": float("nan")}, "entropy is nan; expected a number >= 0"),
        ({"learning_rate": float("inf")}, "learning_rate is inf; expected a number > 0"),
        ({"baseline": "rollout", "scenarios": 1, "samples": 1}, "scenarios x samples is 1, expected >= 2"),
        ({"tasks": ()}, r"tasks is \(\); expected one or more whole numbers >= 1"),
        ({"tasks": (10, 0)}, r"tasks is \(10, 0\); expected one or more whole numbers >= 1"),
        ({"task_weights": (1.0, 2.0)}, r"task_weights is \(1.0, 2.0\); expected a number > 0 for each of tasks"),
        ({"task_weights": (0.0,)}, r"task_weights is \(0.0,\); expected a number > 0"),
        ({"reference_tasks": 0}, "reference_tasks is 0; expected a whole number >= 1"),
        ({"imitation_updates": -1}, "imitation_updates is -1; expected a whole number >= 0"),
        ({"imitation_decisions": -1}, "imitation_decisions is -1; expected a whole number >= 0"),
        ({"imitation_decisions": 10**9}, "imitation_decisions is 1000000000; expected at most 10,000"),
        (
            {"imitation_updates": 1, "imitation_plans": 63},
            "imitation_plans is 63; expected at least imitation_batch, 64",
        ),
        ({"precision": "float16"}, "precision is 'float16'; expected one of float32, bfloat16"),
        ({"device": "tpu9"}, "device is 'tpu9'; expected cpu, cuda or auto"),
    ],
)
def test_bad_configurations_are_refused(change: dict[str, object], sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence):
        replace(TINY, **change)  # type: ignore[arg-type]
