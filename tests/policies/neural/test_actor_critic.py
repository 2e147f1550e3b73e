"""The policy network on batches of observations, as other libraries train it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from factories import GENERATOR, random_action, small_scenario, started

from mrta_zoo import mrta_v0
from mrta_zoo.env.observation import split
from mrta_zoo.policies.neural.actor_critic import ActorCritic
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.policy import NeuralPolicy, load_policy
from mrta_zoo.policies.neural.sharing import Sharing, build_network
from mrta_zoo.policies.neural.weights import PolicyInfo, save_policy

SMALL = NetworkConfig(embedding=16, heads=2)
LEAST = torch.finfo(torch.float32).min


def batched(observations: list[Any]) -> dict[str, Any]:
    """Observations as one Dict of tensors with a leading dimension."""
    tables = {
        name: torch.as_tensor(np.stack([each["observation"][name] for each in observations]))
        for name in observations[0]["observation"]
    }
    return {
        "observation": tables,
        "action_mask": torch.as_tensor(np.stack([each["action_mask"] for each in observations])),
    }


def decisions(count: int) -> list[Any]:
    """What robots see at decisions of missions of several sizes, padded to 10 tasks and 5 robots."""
    env, rng, seen = mrta_v0.env(generator=GENERATOR), np.random.default_rng(0), []
    while len(seen) < count:
        env.reset(seed=len(seen))
        for _ in env.agent_iter():
            observation, _, over, *_ = env.last()
            if not over:
                seen.append(observation)
            env.step(None if over else random_action(observation["action_mask"], rng))
    return seen[:count]


@pytest.mark.parametrize("name", ["capam", "capam-plus"])
def test_probabilities_are_those_of_the_policy(name: str) -> None:
    policy, seen = load_policy(name), decisions(60)
    with torch.no_grad():
        probabilities = ActorCritic(policy.network).logits(batched(seen)).softmax(-1).numpy()
    expected = np.stack([policy.decide(each).probabilities for each in seen])
    np.testing.assert_allclose(probabilities, expected, atol=2e-5)
    assert (probabilities[np.stack([each["action_mask"] for each in seen]) == 0] == 0).all()


@pytest.mark.parametrize("sharing", ["shared", "independent"])
def test_logits_are_masked_and_finite(sharing: Sharing) -> None:
    module, seen = ActorCritic(build_network(SMALL, sharing, robots=5, seed=0)), batched(decisions(20))
    logits, value = module(seen)
    assert logits.shape == (20, 10)
    assert value.shape == (20,)
    assert torch.equal(logits == LEAST, seen["action_mask"] == 0)
    torch.distributions.Categorical(logits=logits).entropy().sum().backward()  # as in PPO's loss
    assert all(torch.isfinite(each.grad).all() for each in module.network.parameters() if each.grad is not None)


def test_any_leading_dimensions() -> None:
    module, seen = ActorCritic(build_network(SMALL, "shared", robots=1, seed=0)), batched(decisions(12))

    def shaped(*leading: int) -> Mapping[str, Any]:
        tables = {name: table.reshape(*leading, *table.shape[1:]) for name, table in seen["observation"].items()}
        return {"observation": tables, "action_mask": seen["action_mask"].reshape(*leading, 10)}

    logits, value = module(seen)
    in_rows = module(shaped(3, 2, 2))
    torch.testing.assert_close(in_rows[0], logits.reshape(3, 2, 2, 10))
    torch.testing.assert_close(in_rows[1], value.reshape(3, 2, 2))
    alone = module(
        {
            **seen,
            "observation": {k: v[5] for k, v in seen["observation"].items()},
            "action_mask": seen["action_mask"][5],
        }
    )
    torch.testing.assert_close(alone[0], logits[5])
    torch.testing.assert_close(alone[1], value[5])


def test_flat_observations_in_batches() -> None:
    """`split` gives the tables of tensors, too: for libraries that want one vector."""
    env = started(scenario=small_scenario(0))
    tables = batched([env.observe("robot_0"), env.observe("robot_1")])["observation"]
    flat = torch.cat([table.flatten(1) for table in tables.values()], -1)
    for name, table in split(flat, 8, 3).items():
        assert torch.equal(table, tables[name])


def test_the_parallel_form_has_its_noop() -> None:
    env = mrta_v0.parallel_env(scenario=small_scenario(0))
    observations, _ = env.reset()
    observations, *_ = env.step({agent: number for number, agent in enumerate(env.agents)})
    module = ActorCritic(build_network(SMALL, "shared", robots=1, seed=0))
    free = next(agent for agent in env.agents if observations[agent]["action_mask"][:8].any())
    busy = next(agent for agent in env.agents if observations[agent]["action_mask"][8])
    probabilities = module.logits(batched([observations[busy], observations[free]])).softmax(-1)
    assert probabilities[0].tolist() == [0.0] * 8 + [1.0]
    expected = NeuralPolicy(module.network, PolicyInfo(network=SMALL)).decide(observations[free]).probabilities
    np.testing.assert_allclose(probabilities[1, :8].detach().numpy(), expected, atol=1e-6)
    assert probabilities[1, 8] == 0


def test_nothing_to_choose_and_nothing_there_are_finite() -> None:
    """Libraries show a policy observations of robots whose turn it is not, and zeros."""
    module, seen = ActorCritic(build_network(SMALL, "shared", robots=1, seed=0)), batched(decisions(2))
    zeros = {"observation": {k: torch.zeros_like(v) for k, v in seen["observation"].items()}}
    for each in ({**seen, "action_mask": torch.zeros(2, 10)}, {**zeros, "action_mask": torch.zeros(2, 10)}):
        logits, value = module(each)
        assert torch.equal(logits.softmax(-1), torch.full((2, 10), 0.1))
        assert torch.isfinite(value).all()


def test_what_was_trained_here_is_loaded_as_a_policy(tmp_path: Path) -> None:
    module, seen = ActorCritic(build_network(SMALL, "shared", robots=1, seed=0)), decisions(5)
    optimizer = torch.optim.SGD(module.parameters(), lr=0.1)
    module.logits(batched(seen)).clamp(min=-10).square().sum().backward()
    optimizer.step()
    save_policy(tmp_path / "mine.safetensors", module.network, PolicyInfo(network=SMALL))
    loaded = load_policy(tmp_path / "mine.safetensors")
    expected = module.logits(batched(seen)).softmax(-1).detach().numpy()
    np.testing.assert_allclose(np.stack([loaded.decide(each).probabilities for each in seen]), expected, atol=1e-6)
