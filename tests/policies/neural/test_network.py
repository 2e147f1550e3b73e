"""What every network must be: indifferent to order, to batch-mates and to padding, and the same in both loops."""

from __future__ import annotations

import copy
import pickle
from dataclasses import fields, replace

import numpy as np
import pytest
import torch

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.batch import BatchMission
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import MixtureGenerator, TaptcGenerator, UniformGenerator
from mrta_zoo.policies.neural.capam.capsule_encoder import CapsuleEncoder, scaled_laplacian
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.encoders import ENCODERS
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.policy import NeuralPolicy
from mrta_zoo.policies.neural.rollout import roll_out
from mrta_zoo.policies.neural.sharing import IndependentNetworks, build_network
from mrta_zoo.policies.neural.weights import PolicyInfo
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.verify import verify

SMALL = NetworkConfig(embedding=32, heads=4)
CONFIGS = {
    **{name: replace(SMALL, encoder=name) for name in ENCODERS},
    "capam-p1-k3-2layers": replace(SMALL, moments=1, hops=3, layers=2),
    "am-2layers": replace(SMALL, encoder="attention", layers=2),
    "only-the-paper's-features": replace(SMALL, node_features=("x", "y", "deadline")),
    "capam-plus": replace(SMALL, decoder="candidates"),
    "am-plus": replace(SMALL, encoder="attention", decoder="candidates"),
    "none-plus": replace(SMALL, encoder="none", decoder="candidates", decision_layers=2),
    "capam-plus-without-layers": replace(SMALL, decoder="candidates", decision_layers=0),
    "capam-plus-few-candidates": replace(SMALL, decoder="candidates", candidates=5, peers=1, decision_layers=1),
}
GENERATOR = MixtureGenerator(
    (TaptcGenerator(tasks=(9, 20), robots=(1, 4)), UniformGenerator(tasks=(9, 20), robots=(1, 4)))
)


def draw(count: int, seed: int = 0) -> list[Scenario]:
    rng = np.random.default_rng(seed)
    return [GENERATOR(rng) for _ in range(count)]


def network_of(config: NetworkConfig, sharing: str = "shared", seed: int = 3) -> torch.nn.Module:
    network = build_network(config, sharing, robots=4, seed=seed)  # type: ignore[arg-type]
    with torch.no_grad():  # so that the candidate decoder, whose last layer starts at 0, counts too
        for parameter in network.parameters():
            if parameter.abs().max() == 0:
                parameter.normal_(std=0.3, generator=torch.Generator().manual_seed(seed))
    return network.eval()


def log_probs(network: torch.nn.Module, scenarios: list[Scenario], steps: int = 3, **room: int) -> torch.Tensor:
    """(B, N) log-probabilities after a few decisions, each the first legal one."""
    batch = ScenarioBatch.of(scenarios, **room)
    mission = BatchMission(batch)
    for _ in range(steps):
        mission.step(mission.mask().int().argmax(1))
    with torch.no_grad():
        return network(network.encode(Tasks.of_batch(batch)), DecisionStates.of_batch(mission))[:, 0]


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
def test_permuting_the_tasks_permutes_the_probabilities(config: NetworkConfig) -> None:
    network, (scenario,) = network_of(config), draw(1)
    order = np.random.default_rng(1).permutation(scenario.num_tasks)
    permuted = replace(
        scenario,
        task_xy=scenario.task_xy[order],
        deadline=scenario.deadline[order],
        workload=scenario.workload[order],
    )
    before = log_probs(network, [scenario], steps=0)[0]
    after = log_probs(network, [permuted], steps=0)[0]
    torch.testing.assert_close(after, before[torch.from_numpy(order)], rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
def test_permuting_the_peers_changes_nothing(config: NetworkConfig) -> None:
    network = network_of(config)
    rng = np.random.default_rng(5)
    scenario = UniformGenerator(tasks=12, robots=4)(rng)  # type: ignore[arg-type]
    order = [0, 3, 1, 2]
    permuted = replace(
        scenario,
        robot_xy=scenario.robot_xy[order],
        capacity=scenario.capacity[order],
        speed=scenario.speed[order],
    )
    before, after = (log_probs(network, [each], steps=0) for each in (scenario, permuted))
    torch.testing.assert_close(after, before, rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
def test_batch_mates_and_padding_change_nothing(config: NetworkConfig) -> None:
    network, scenarios = network_of(config), draw(5)
    together = log_probs(network, scenarios, max_tasks=27, max_robots=6)
    for row, scenario in zip(together, scenarios, strict=True):
        alone = log_probs(network, [scenario])[0]
        assert torch.isneginf(row[scenario.num_tasks :]).all() or torch.allclose(row, row[0])
        if torch.isneginf(alone).any() or torch.isneginf(row).any():  # otherwise the mission is over
            torch.testing.assert_close(row[: scenario.num_tasks], alone, rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
@pytest.mark.parametrize(("tasks", "robots"), [(1, 1), (2, 5), (150, 12)])
def test_the_same_weights_serve_any_number_of_tasks_and_robots(config: NetworkConfig, tasks: int, robots: int) -> None:
    scenario = UniformGenerator(tasks=tasks, robots=robots)(np.random.default_rng(0))  # type: ignore[arg-type]
    rollout = roll_out(network_of(config), ScenarioBatch.of([scenario]), keep_plans=True)
    assert verify(scenario, rollout.plans[0]).completed == rollout.completed[0] > 0


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
@pytest.mark.parametrize(
    ("sharing", "rule"),
    [("shared", "feasible"), ("shared", "active"), ("shared", "unvisited"), ("independent", "feasible")],
)
def test_the_environment_and_the_batch_take_the_same_decisions(
    config: NetworkConfig, sharing: str, rule: MaskRule
) -> None:
    network, scenarios = network_of(config, sharing), draw(4, seed=8)
    rollout = roll_out(network, ScenarioBatch.of(scenarios), mask_rule=rule, keep_plans=True)
    policy = NeuralPolicy(network, PolicyInfo(network=config, mask_rule=rule))
    env = mrta_v0.raw_env(max_tasks=25, max_robots=5, mask_rule=rule)
    for row, scenario in enumerate(scenarios):
        env.reset(options={"scenario": scenario})
        routes: list[list[int]] = [[] for _ in range(scenario.num_robots)]
        log_prob, total_reward = 0.0, 0.0
        for agent in env.agent_iter():
            observation, reward, termination, truncation, _ = env.last()
            if agent == "robot_0":
                total_reward += reward
            if termination or truncation:
                env.step(None)
                continue
            decision = policy.decide(observation)
            log_prob += decision.log_prob
            routes[int(agent.removeprefix("robot_"))].append(decision.action)
            env.step(decision.action)
        assert tuple(map(tuple, routes)) == rollout.plans[row].routes
        assert log_prob == pytest.approx(float(rollout.log_prob[row]), abs=1e-3)
        assert total_reward == pytest.approx(-float(rollout.cost[row]) / scenario.num_tasks, rel=1e-9)


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
def test_observations_and_simulator_give_the_network_the_same_numbers(config: NetworkConfig) -> None:
    (scenario,) = draw(1, seed=4)
    env = mrta_v0.raw_env(scenario=scenario)
    env.reset()
    mission = BatchMission(ScenarioBatch.of([scenario]))
    for _ in range(4):
        observation = env.last()[0]
        for of_env, of_batch in (
            (Tasks.of_observations([observation]), Tasks.of_batch(mission.scenarios)),
            (DecisionStates.of_observations([observation]), DecisionStates.of_batch(mission)),
        ):
            for each in fields(of_env):
                torch.testing.assert_close(getattr(of_env, each.name), getattr(of_batch, each.name), rtol=0, atol=0)
        action = int(observation["action_mask"].argmax())
        env.step(action)
        mission.step(torch.tensor([action]))
        if mission.done:
            break


@pytest.mark.parametrize("sharing", ["shared", "independent"])
@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
def test_who_only_watches_sees_what_who_decides_sees(config: NetworkConfig, sharing: str) -> None:
    network, batch = network_of(config, sharing), ScenarioBatch.of(draw(3))
    tasks, states = Tasks.of_batch(batch), DecisionStates.of_batch(BatchMission(batch))
    seen = network.features(network.surroundings(tasks), states)  # type: ignore[operator]
    expected = network.features(network.encode(tasks), states)  # type: ignore[operator]
    assert (seen is None) == (config.decoder == "attention")
    if seen is not None:
        for each in fields(seen):
            assert torch.equal(getattr(seen, each.name), getattr(expected, each.name))


def test_the_encoder_runs_once_a_mission() -> None:
    network = network_of(SMALL)
    calls = []
    network.encoder.register_forward_hook(lambda *_: calls.append(1))  # type: ignore[union-attr]
    policy = NeuralPolicy(network, PolicyInfo(network=SMALL))
    env = mrta_v0.env(generator=GENERATOR, max_tasks=20, max_robots=4)
    for mission in range(3):
        env.reset(seed=mission)
        for agent in env.agent_iter():
            observation, _, termination, truncation, _ = env.last()
            env.step(None if termination or truncation else policy.act(observation, agent))
    assert len(calls) == 3
    roll_out(network, ScenarioBatch.of(draw(3)), samples=4, generator=torch.Generator().manual_seed(0))
    assert len(calls) == 4


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
def test_a_network_that_has_decided_can_be_trained_copied_and_pickled(config: NetworkConfig) -> None:
    policy = NeuralPolicy(network_of(config), PolicyInfo(network=config))
    env = mrta_v0.env(generator=GENERATOR, max_tasks=20, max_robots=4)
    env.reset(seed=0)
    observation = env.last()[0]
    chosen = policy.decide(observation)
    batch = ScenarioBatch.of(draw(2))
    scores = policy.network(policy.network.encode(Tasks.of_batch(batch)), DecisionStates.of_batch(BatchMission(batch)))
    scores.max().backward()
    assert any(parameter.grad is not None for parameter in policy.network.parameters())
    for twin in (copy.deepcopy(policy), pickle.loads(pickle.dumps(policy))):
        assert twin.decide(observation).action == chosen.action


@pytest.mark.parametrize("encoder", ENCODERS)
def test_embeddings_of_padding_are_zero(encoder: str) -> None:
    module = ENCODERS[encoder](3, SMALL)
    exists = torch.tensor([[True, True, False]])
    embedded = module(torch.rand(1, 3, 3), exists, torch.rand(1, 3, 3))
    assert embedded.shape == (1, 3, SMALL.embedding)
    assert (embedded[~exists] == 0).all()
    assert (embedded[exists] != 0).any()


def test_unknown_node_feature_is_told() -> None:
    with pytest.raises(
        ConfigError, match=r"node_features has 'priority'; expected x, y, deadline.* or one of your own"
    ):
        build_network(replace(SMALL, node_features=("x", "priority")), "shared", 1, seed=0)


def test_a_policy_serves_the_parallel_form_too() -> None:
    policy = NeuralPolicy(network_of(SMALL), PolicyInfo(network=SMALL))
    env = mrta_v0.parallel_env(generator=GENERATOR, max_tasks=20, max_robots=4, on_illegal="raise")
    observations, _ = env.reset(seed=0)
    while env.agents:
        observations, *_ = env.step({agent: policy.act(observations[agent]) for agent in env.agents})
    assert env.mission.done
    assert env.mission.completed() > 0


def test_a_flat_observation_is_refused_in_a_sentence() -> None:
    env = mrta_v0.env(observation="flat")
    env.reset(seed=0)
    with pytest.raises(ConfigError, match='observation="dict"'):
        NeuralPolicy(network_of(SMALL), PolicyInfo(network=SMALL)).act(env.last()[0])


def test_laplacian_of_two_tasks_by_hand() -> None:
    # δ = (0, 0, 0) and (0.6, 0.8, 0): distance 1, so A_01 = 1/(1 + 1) = 0.5, both degrees are 0.5;
    # D − A = [[0.5, −0.5], [−0.5, 0.5]], over the largest degree 0.5: [[1, −1], [−1, 1]]. The third is padding.
    graph = torch.tensor([[[0.0, 0, 0], [0.6, 0.8, 0], [0.3, 0.3, 0.3]]])
    laplacian = scaled_laplacian(graph, torch.tensor([[True, True, False]]))
    expected = torch.tensor([[[1.0, -1, 0], [-1, 1, 0], [0, 0, 0]]])
    torch.testing.assert_close(laplacian, expected)


def test_capsule_layer_is_equation_3() -> None:
    encoder = CapsuleEncoder(features=3, embedding=8, layers=1, hops=2, moments=3)
    nodes, exists = torch.rand(1, 6, 3), torch.ones(1, 6, dtype=torch.bool)
    lap = scaled_laplacian(nodes, exists)[0]
    hidden = encoder.embed(nodes)[0]
    outputs = []
    for p, capsule in enumerate(encoder.capsules[0], start=1):  # type: ignore[arg-type]
        weights = capsule.weight.T.split(8)  # W_p0, W_p1, W_p2 one below the other
        total = sum(torch.linalg.matrix_power(lap, k) @ hidden**p @ weights[k] for k in range(3))
        outputs.append(torch.relu(total + capsule.bias))
    by_hand = encoder.norm(encoder.project(torch.cat(outputs, -1)))
    torch.testing.assert_close(encoder(nodes, exists, nodes)[0], by_hand, rtol=1e-4, atol=1e-5)


def test_sampling_follows_the_probabilities_and_its_seed() -> None:
    network, scenarios = network_of(SMALL), ScenarioBatch.of(draw(2))
    first, again, other = (
        roll_out(network, scenarios, samples=8, generator=torch.Generator().manual_seed(seed), keep_plans=True).plans
        for seed in (1, 1, 2)
    )
    assert first == again != other
    assert len(set(first[:8])) > 1


def test_best_of_samples_is_no_worse_than_greedy() -> None:
    policy = NeuralPolicy(network_of(SMALL), PolicyInfo(network=SMALL))
    for scenario in draw(5):
        greedy, best = policy.solve(scenario), policy.solve(scenario, decode="sample", samples=32, seed=1)
        assert verify(scenario, best).completed >= verify(scenario, greedy).completed
        assert best == policy.solve(scenario, decode="sample", samples=32, seed=1)
    assert policy.solve_batch(draw(5)) == [policy.solve(each) for each in draw(5)]


def test_independent_networks_refuse_robots_they_have_no_network_for() -> None:
    network = build_network(SMALL, "independent", robots=2, seed=0)
    assert isinstance(network, IndependentNetworks)
    scenario = UniformGenerator(tasks=6, robots=3)(np.random.default_rng(0))  # type: ignore[arg-type]
    with pytest.raises(ConfigError, match=r"robot 2 has no network.*trained for 2 robots"):
        roll_out(network, ScenarioBatch.of([scenario]))


def test_initial_weights_come_from_the_seed_alone() -> None:
    torch.manual_seed(5)
    before = torch.get_rng_state()
    one, same, other = (build_network(SMALL, "shared", 1, seed).state_dict() for seed in (1, 1, 2))
    assert torch.equal(torch.get_rng_state(), before)
    assert all(torch.equal(one[name], same[name]) for name in one)
    assert not all(torch.equal(one[name], other[name]) for name in one)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"encoder": "graph"}, r"encoder has 'graph'; expected capsule, attention, none, or one of your own"),
        ({"embedding": 30}, r"embedding is 30; expected a multiple of heads, 8"),
        ({"node_features": ()}, r"node_features is empty; expected at least one feature"),
        ({"moments": 0}, r"moments is 0; expected a whole number from 1 to 16"),
        ({"hops": -1}, r"hops is -1; expected a whole number from 0 to 16"),
        ({"tanh_clip": 0.0}, r"tanh_clip is 0.0; expected a number > 0"),
        ({"decoder": "features"}, r"decoder is 'features'; expected attention or candidates"),
        ({"candidates": 0}, r"candidates is 0; expected a whole number from 1 to 10000"),
        ({"peers": -1}, r"peers is -1; expected a whole number from 0 to 10000"),
        ({"decision_layers": -1}, r"decision_layers is -1; expected a whole number from 0 to 64"),
    ],
)
def test_bad_architectures_are_refused(change: dict[str, object], sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence):
        build_network(NetworkConfig(**change), "shared", 1, seed=0)  # type: ignore[arg-type]
