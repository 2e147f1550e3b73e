"""Each library's policy gets well beyond random choices; CapAM trained by RLlib or TorchRL is one of our policies."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import torch
from torch.utils.data import default_collate

from mrta_zoo import mrta_v0
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.policies.classical.heuristics import RandomPolicy
from mrta_zoo.policies.neural.actor_critic import ActorCritic
from mrta_zoo.policies.neural.policy import load_policy
from mrta_zoo.policies.neural.weights import save_policy
from mrta_zoo.train.integrations import rllib_ppo, sb3_ppo, supersuit_ppo, tianshou_ppo, torchrl_ppo
from mrta_zoo.train.integrations.networks import FORM, Kind, build
from mrta_zoo.train.integrations.problem import UNSEEN, Planner, completions, in_aec_loop, options

pytestmark = [pytest.mark.integrations, pytest.mark.filterwarnings("ignore")]  # theirs, not ours to mend


def with_ray(test: Callable[..., None]) -> Callable[..., None]:
    """One process, so one cluster, for all of them."""
    return pytest.mark.usefixtures("cluster")(pytest.mark.xdist_group("ray")(test))


@cache
def by_chance() -> npt.NDArray[np.float64]:
    """Of 200 scenarios random legal choices complete 53 %."""
    return completions(in_aec_loop(RandomPolicy(seed=0)))


def assert_learned(plan: Planner, stated: float) -> None:
    """At least the stated share, and beyond chance by 5 points and three standard errors of the difference."""
    shares = completions(plan)
    gain = shares - by_chance()
    error = gain.std(ddof=1) / len(gain) ** 0.5
    assert shares.mean() >= stated
    assert gain.mean() - 3 * error > 0.05


def test_chance() -> None:
    assert 0.50 < by_chance().mean() < 0.56
    with pytest.raises(AssertionError):
        assert_learned(in_aec_loop(RandomPolicy(seed=1)), stated=0.5)


def test_sb3() -> None:
    assert_learned(in_aec_loop(sb3_ppo.train(seed=0)), stated=0.68)


def test_sb3_with_processes() -> None:
    """Masks are asked for across processes: the same decisions, so the same policy."""
    policies = [sb3_ppo.train(seed=0, steps=256, copies=2, processes=processes) for processes in (False, True)]
    first, second = (list(policy.model.policy.parameters()) for policy in policies)
    assert all(torch.equal(a, b) for a, b in zip(first, second, strict=True))


def test_supersuit() -> None:
    assert_learned(supersuit_ppo.train(seed=0).plan, stated=0.60)


def test_supersuit_with_every_wrapper() -> None:
    """Two steps of (10 x 8 + 2 x 7 + 5 + 3) = 102 numbers, each with the robot's number as 2 more: 2 x 102 + 2."""
    envs = supersuit_ppo.vectorised(supersuit_ppo.wrapped(), count=2)
    assert envs.observation_space.shape == (206,)
    model = supersuit_ppo.learn(envs, steps=256)
    assert model.num_timesteps >= 256


def test_tianshou() -> None:
    assert_learned(in_aec_loop(tianshou_ppo.train(seed=0)), stated=0.65)


@with_ray
@pytest.mark.parametrize("sharing", ["shared", "independent"])
def test_rllib(sharing: Any) -> None:
    assert_learned(in_aec_loop(rllib_ppo.train(seed=0, sharing=sharing)), stated=0.60)


def test_torchrl() -> None:
    assert_learned(in_aec_loop(torchrl_ppo.train(seed=0)), stated=0.63)


@with_ray
def test_capam_in_rllib(tmp_path: Path) -> None:
    assert_capam_is_updated(rllib_ppo.train, tmp_path / "mine.safetensors")


def test_capam_in_torchrl(tmp_path: Path) -> None:
    assert_capam_is_updated(torchrl_ppo.train, tmp_path / "mine.safetensors")


def assert_capam_is_updated(train: Callable[..., Any], path: Path) -> None:
    """Two rounds of PPO move its weights; what is saved, and loaded again, gives the same probabilities."""
    policy = train(seed=0, network="capam", iterations=2)
    untrained = build("capam", 0, 0, seed=0).network.state_dict()
    moved = [not torch.equal(each, untrained[name]) for name, each in policy.network.state_dict().items()]
    assert sum(moved) > 0.9 * len(moved)
    save_policy(path, policy.network, policy.info)
    loaded = load_policy(path)
    env = mrta_v0.env(**options("dict"))
    env.reset(seed=UNSEEN)
    seen = env.observe("robot_0")
    with torch.no_grad():
        expected = ActorCritic(policy.network).logits(default_collate([seen]))[0].softmax(-1).numpy()
    np.testing.assert_allclose(loaded.decide(seen).probabilities, expected, atol=1e-5)
    assert completions(in_aec_loop(loaded), episodes=50).mean() > 0.45


@with_ray
def test_rllib_with_other_numbers_of_robots() -> None:
    """Of the robots that there may be the first episode need not have all."""
    generator = UniformGenerator(tasks=(5, 8), robots=(1, 4), deadline=(100, 300))
    env = {"generator": generator, "reward": "completion", "observation": "masked"}
    algorithm = rllib_ppo.configure(env, seed=0).build_algo()
    assert algorithm.train()["env_runners"]["num_env_steps_sampled"] >= 1000
    algorithm.stop()


def test_torchrl_with_other_numbers_of_robots() -> None:
    """All four that there may be are there in every episode, and of these the scenario's have turns."""
    generator = UniformGenerator(tasks=(5, 8), robots=(1, 4), deadline=(100, 300))
    env = torchrl_ppo.make_env(0, generator=generator, absent="noop")
    completed = []
    for _ in range(10):
        rollout = env.rollout(20)
        assert rollout[torchrl_ppo.MASK].shape[1:] == (4, 8)
        assert (rollout[torchrl_ppo.TURN].sum(1) == 1).all()
        completed.append(float(rollout["next", "agents", "reward"].sum(0).max()))
    assert 0.2 < np.mean(completed) <= 1.0


@pytest.mark.parametrize("kind", ["mlp", "capam"])
def test_rllib_module_is_masked(kind: Kind) -> None:
    env = rllib_ppo.RllibEnv(options(FORM[kind]))
    assert list(env.observation_spaces) == ["robot_0", "robot_1"]
    module = rllib_ppo.MaskedModule(
        observation_space=env.observation_spaces["robot_0"],
        action_space=env.action_spaces["robot_0"],
        model_config={"kind": kind, "seed": 0},
    )
    observation, _ = env.reset(seed=0)
    batch = {"obs": default_collate([observation["robot_0"], observation["robot_0"]])}
    probabilities = module.forward_train(batch)["action_dist_inputs"].softmax(-1)
    assert torch.equal(probabilities > 0, batch["obs"]["action_mask"] > 0)
    assert module.compute_values(batch).shape == (2,)


def test_command_line() -> None:
    command = [sys.executable, "-W", "ignore", "-m", "mrta_zoo.train.integrations.sb3_ppo", "--seed", "3"]
    shown = subprocess.run([*command, "--steps", "1024"], capture_output=True, text=True, check=True).stdout
    assert re.search(r"random +5\d\.\d % completed.*\nnearest +7\d\.\d %.*\ntrained +\d\d\.\d %", shown)
