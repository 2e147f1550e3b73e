"""PettingZoo's own contract tests, over combinations of options, and the registry."""

from __future__ import annotations

import subprocess
import sys
import warnings

import numpy as np
import pettingzoo
import pytest
from factories import small_scenario

from mrta_zoo import mrta_v0, registration
from mrta_zoo.generators import TaptcGenerator, UniformGenerator

with warnings.catch_warnings():
    # Where pygame is installed, the kit imports PettingZoo's games in a way that PettingZoo itself calls deprecated.
    warnings.simplefilter("ignore", DeprecationWarning)
    from pettingzoo.test import api_test, parallel_api_test, render_test, seed_test, state_test
    from pettingzoo.test.seed_test import parallel_seed_test

SMALL = UniformGenerator(tasks=(3, 9), robots=(2, 4), deadline=(20, 150))
KNOWN = {
    "Observation is not a NumPy array",
    "Observation space for each agent probably should be gymnasium.spaces.box or gymnasium.spaces.discrete",
}
"""What the kit says about every environment with Dict observations that is not one of PettingZoo's own."""


def check_api(env, observation):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        api_test(env, num_cycles=100)
    said = {str(warning.message) for warning in caught}
    assert said == (KNOWN if observation == "dict" else set())


@pytest.mark.parametrize("mask_rule", ["feasible", "active", "unvisited"])
@pytest.mark.parametrize("reward", ["terminal", "completion", "individual"])
@pytest.mark.parametrize("observation", ["dict", "flat"])
@pytest.mark.parametrize("staggered", [False, True])
@pytest.mark.parametrize("make", [mrta_v0.env, mrta_v0.raw_env])
def test_api(make, mask_rule, reward, observation, staggered):
    scenario = small_scenario(3, tasks=9, robots=4)
    env = make(scenario=scenario, mask_rule=mask_rule, reward=reward, observation=observation, staggered=staggered)
    check_api(env, observation)


@pytest.mark.parametrize("observation", ["dict", "flat"])
@pytest.mark.parametrize(("tasks", "robots"), [(1, 1), (2, 5), (30, 2)])
@pytest.mark.parametrize("room", [0, 3])
def test_api_at_other_sizes(observation, tasks, robots, room):
    env = mrta_v0.env(
        scenario=small_scenario(1, tasks, robots, latest=300), max_tasks=tasks + room, max_robots=robots + room,
        observation=observation, mask_rule="unvisited",
    )  # fmt: skip
    check_api(env, observation)


@pytest.mark.parametrize("observation", ["dict", "flat"])
def test_api_with_a_generator(observation):
    check_api(mrta_v0.env(generator=SMALL, observation=observation), observation)


@pytest.mark.parametrize("observation", ["dict", "flat"])
@pytest.mark.parametrize("staggered", [False, True])
def test_parallel_api(observation, staggered):
    generator = UniformGenerator(tasks=(3, 9), robots=(4, 4), deadline=(20, 150))
    env = mrta_v0.parallel_env(generator=generator, observation=observation, staggered=staggered)
    parallel_api_test(env, num_cycles=100)


@pytest.mark.parametrize("observation", ["dict", "flat"])
def test_seeds(observation):
    seed_test(lambda: mrta_v0.env(generator=SMALL, observation=observation), num_cycles=100)
    parallel_seed_test(lambda: mrta_v0.parallel_env(generator=SMALL, observation=observation), num_cycles=100)


def test_state():
    state_test(mrta_v0.env(generator=SMALL), mrta_v0.parallel_env(generator=SMALL))


def test_render():
    render_test(lambda render_mode: mrta_v0.env(generator=SMALL, render_mode=render_mode))


def test_metadata():
    metadata = mrta_v0.raw_env().metadata
    assert metadata["name"] == "mrta_v0"
    assert metadata["is_parallelizable"] is False
    assert set(metadata["render_modes"]) == {"ansi", "human", "rgb_array"}
    assert metadata["render_fps"] > 0
    assert str(mrta_v0.env()) == "mrta_v0"


@pytest.mark.skipif(not hasattr(pettingzoo, "make"), reason="this PettingZoo has no registry")
def test_the_registry_makes_both_forms():
    env = pettingzoo.make("aec", "mrta_zoo/mrta-v0", generator=SMALL)
    env.reset(seed=0)
    assert env.agents == ["robot_0", "robot_1", "robot_2", "robot_3"][: len(env.agents)]
    assert env.max_num_agents == 4
    parallel = pettingzoo.make("parallel", "mrta_zoo/mrta-v0", observation="flat")
    assert isinstance(parallel, pettingzoo.ParallelEnv)
    registration.register()  # once more: must not warn, and warnings are errors here


def test_import_is_light_and_registers():
    code = """
import sys
import mrta_zoo
assert not {"torch", "matplotlib", "scipy"} & set(sys.modules), "a heavy module was imported"
assert "mrta_zoo.mrta_v0" not in sys.modules
import importlib, warnings
warnings.simplefilter("error")
importlib.reload(mrta_zoo)
from mrta_zoo import mrta_v0
mrta_v0.env(); mrta_v0.parallel_env()
assert not {"torch", "matplotlib", "scipy"} & set(sys.modules), "a heavy module was imported"
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_default_sizes():
    env = mrta_v0.raw_env()
    assert (env.settings.max_tasks, env.settings.max_robots) == (100, 7)
    env = mrta_v0.raw_env(generator=TaptcGenerator(tasks=(5, 20), robots=(2, 3)))
    assert (env.settings.max_tasks, env.settings.max_robots) == (20, 3)
    env = mrta_v0.raw_env(scenario=small_scenario(0, tasks=6, robots=2))
    assert (env.settings.max_tasks, env.settings.max_robots) == (6, 2)
    env = mrta_v0.raw_env(generator=lambda rng: small_scenario(rng))
    assert (env.settings.max_tasks, env.settings.max_robots) == (100, 7)
    env.reset(seed=np.int64(3))
    assert env.num_agents == 3
