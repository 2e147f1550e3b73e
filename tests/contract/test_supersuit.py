"""SuperSuit's wrappers on the environment: which form suits which is listed in the documentation."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from factories import mask_of, random_action, small_scenario

from mrta_zoo import mrta_v0

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    supersuit = pytest.importorskip("supersuit")

WRAPPERS = {
    "agent_indicator": lambda env: supersuit.agent_indicator_v0(env),
    "pad_action_space": lambda env: supersuit.pad_action_space_v0(env),
    "flatten": lambda env: supersuit.flatten_v0(env),
    "frame_stack": lambda env: supersuit.frame_stack_v1(env, 3),
    "dtype": lambda env: supersuit.dtype_v0(env, np.float64),
    "normalize": lambda env: supersuit.normalize_obs_v0(env),
    "pad_observations": lambda env: supersuit.pad_observations_v0(env),
}


def finish(env):
    env.reset(seed=0)
    rng = np.random.default_rng(0)
    total, turns = 0.0, 0
    for agent in env.agent_iter():
        observation, reward, terminated, truncated, info = env.last()
        assert env.observation_space(agent).contains(observation)
        total += reward
        turns += 1
        env.step(None if terminated or truncated else random_action(mask_of(observation, info), rng))
    return total, turns


@pytest.mark.parametrize("name", WRAPPERS)
def test_flat(name):
    options = {"scenario": small_scenario(0), "observation": "flat", "reward": "individual"}
    expected = finish(mrta_v0.env(**options))
    assert finish(WRAPPERS[name](mrta_v0.env(**options))) == expected


@pytest.mark.parametrize(
    "wrap",
    [
        lambda env: supersuit.pad_action_space_v0(env),
        lambda env: supersuit.reward_lambda_v0(env, lambda reward: reward * 1.0),
    ],
)
def test_dict(wrap):
    expected = finish(mrta_v0.env(scenario=small_scenario(0), reward="individual"))
    assert finish(wrap(mrta_v0.env(scenario=small_scenario(0), reward="individual"))) == expected


def test_vector_environment():
    generator_free = mrta_v0.parallel_env(scenario=small_scenario(0), observation="flat", on_illegal="terminate")
    vector = supersuit.pettingzoo_env_to_vec_env_v1(generator_free)
    observations, infos = vector.reset(seed=0)
    assert observations.shape == (3, *vector.observation_space.shape)
    rng = np.random.default_rng(0)
    ended = 0
    for _ in range(40):
        actions = [random_action(info["action_mask"], rng) for info in infos]
        observations, _, terminations, _, infos = vector.step(np.array(actions))
        ended += bool(all(terminations))
    assert ended >= 1
