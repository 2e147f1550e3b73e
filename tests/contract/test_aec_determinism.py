"""Seeds, pickles and copies: an AEC episode can be had again."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from factories import (
    FORMS,
    GENERATOR,
    mask_of,
    play,
    random_action,
    record,
    same,
    small_scenario,
    started,
)

from mrta_zoo import mrta_v0


@pytest.mark.parametrize("form", FORMS)
def test_the_same_seed_gives_the_same_episodes(form):
    first, second = (mrta_v0.env(generator=GENERATOR, observation=form, reward="completion") for _ in range(2))
    scenarios_seen = set()
    for seed in (7, None, None, 7):
        first.reset(seed=seed)
        second.reset(seed=seed)
        scenarios_seen.add(first.unwrapped.mission.scenario)
        a, b = record(first, 1), record(second, 1)
        assert len(a) == len(b) > 5
        assert all(same(x, y) for x, y in zip(a, b, strict=True))
    assert len(scenarios_seen) == 3  # without a seed the generator goes on; the seed brings the first one back


def test_without_a_seed_environments_differ():
    scenarios_seen = set()
    for _ in range(3):
        env = mrta_v0.env(generator=GENERATOR)
        env.reset()
        scenarios_seen.add(env.unwrapped.mission.scenario)
    assert len(scenarios_seen) == 3


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("staggered", [False, True])
@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_a_copy_goes_on_as_the_original(form, staggered, duplicate):
    scenario = small_scenario(2, tasks=7, robots=3)
    length = len(record(started(scenario=scenario, observation=form, staggered=staggered), 5))
    assert length > 7
    for stop in range(length):
        env = started(scenario=scenario, observation=form, staggered=staggered, reward="individual")
        rng = np.random.default_rng(5)
        for _ in range(stop):
            observation, _, terminated, truncated, info = env.last()
            env.step(None if terminated or truncated else random_action(mask_of(observation, info), rng))
        twin = duplicate(env)
        mine, its = record(env, 6), record(twin, 6)
        assert len(mine) == len(its)
        assert all(same(a, b) for a, b in zip(mine, its, strict=True))


def test_a_copy_is_independent():
    env = started(seed=0, generator=GENERATOR)
    twin = copy.deepcopy(env)
    before = copy.deepcopy(env.observe("robot_0"))
    play(twin)
    assert same(env.observe("robot_0"), before)
    env.reset()
    twin.reset()  # their random generators are at the same place
    assert env.unwrapped.mission.scenario == twin.unwrapped.mission.scenario


def test_unstarted_environments_can_be_copied_too():
    for env in (mrta_v0.env(generator=GENERATOR), mrta_v0.raw_env(), mrta_v0.parallel_env()):
        pickle.loads(pickle.dumps(copy.deepcopy(env))).reset(seed=0)
