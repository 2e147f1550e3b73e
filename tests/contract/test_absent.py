"""Teams of varying size with all possible agents there in every episode: ``absent="noop"``."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest
from factories import FORMS, GENERATOR, hopeless_scenario, mask_of, play, random_action, same, small_scenario, started

from mrta_zoo import mrta_v0
from mrta_zoo.env.gym_view import ActingRobotEnv
from mrta_zoo.errors import ActionError, ConfigError
from mrta_zoo.policies.classical.heuristics import NearestPolicy

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    from pettingzoo.test import api_test, parallel_api_test
    from pettingzoo.test.seed_test import parallel_seed_test

    supersuit = pytest.importorskip("supersuit")

ALL = [f"robot_{robot}" for robot in range(5)]
REWARDS = ["terminal", "completion", "individual"]


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("staggered", [False, True])
def test_contract_tests(form: str, staggered: bool) -> None:
    options: dict[str, Any] = {"observation": form, "staggered": staggered, "absent": "noop"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # what the kit says of all Dict observations
        api_test(mrta_v0.env(generator=GENERATOR, **options), num_cycles=100)
    fixed = mrta_v0.parallel_env(scenario=small_scenario(0, robots=2), max_robots=5, **options)
    parallel_api_test(fixed, num_cycles=100)
    if not staggered:
        parallel_api_test(mrta_v0.parallel_env(generator=GENERATOR, **options), num_cycles=100)
        parallel_seed_test(lambda: mrta_v0.parallel_env(generator=GENERATOR, **options), num_cycles=50)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("reward", REWARDS)
def test_the_parallel_form_plays_the_same_episodes(form: str, reward: str) -> None:
    options: dict[str, Any] = {"generator": GENERATOR, "observation": form, "reward": reward}
    env, usual = mrta_v0.parallel_env(absent="noop", **options), mrta_v0.parallel_env(**options)
    rng = np.random.default_rng(0)
    sizes = set()
    for seed in range(8):
        observations, infos = env.reset(seed=seed)
        expected, expected_infos = usual.reset(seed=seed)
        team = usual.agents
        sizes.add(len(team))
        while usual.agents:
            assert env.agents == env.possible_agents == list(observations) == ALL
            assert same({agent: observations[agent] for agent in team}, expected)
            assert same({agent: infos[agent] for agent in team}, expected_infos)
            actions = {agent: random_action(mask_of(observations[agent], infos[agent]), rng) for agent in ALL}
            assert all(actions[agent] == env.noop for agent in ALL if agent not in team)
            observations, rewards, terminations, truncations, infos = env.step(actions)
            expected, gained, over, _, expected_infos = usual.step({agent: actions[agent] for agent in team})
            assert rewards == gained | {agent: 0.0 for agent in ALL if agent not in team}
            assert terminations == dict.fromkeys(ALL, over[team[0]])
            assert not any(truncations.values())
            for agent in set(ALL) - set(team):
                assert env.observation_space(agent).contains(observations[agent])
                assert mask_of(observations[agent], infos[agent]).tolist() == [0] * 10 + [1]
                assert (infos[agent]["mask_reason"] == 4).all()
                assert infos[agent].keys() == infos["robot_0"].keys()
        assert env.agents == []
        assert env.mission.routes == usual.mission.routes
    assert len(sizes) > 2


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("staggered", [False, True])
def test_in_the_aec_form_they_get_no_turn(form: str, staggered: bool) -> None:
    options = {"generator": GENERATOR, "observation": form, "reward": "individual", "staggered": staggered}
    for seed in range(6):
        env, usual = started(seed, absent="noop", **options), started(seed, **options)
        team = list(usual.agents)
        assert env.agents == ALL
        assert env.infos.keys() == env.rewards.keys() == env.terminations.keys() == set(ALL)
        decisions, returns = play(env)
        expected, gained = play(usual)
        assert decisions == expected
        assert returns == gained | {agent: 0.0 for agent in ALL if agent not in team}
        assert env.agents == []


def test_staggered_robots_leave_and_absent_ones_stay_to_the_end() -> None:
    env = mrta_v0.parallel_env(scenario=small_scenario(0, robots=2), max_robots=3, staggered=True, absent="noop")
    env.reset()
    while env.agents:
        assert "robot_2" in env.agents
        _, _, terminations, _, _ = env.step({agent: int(env.mask(agent).argmax()) for agent in env.agents})
        assert terminations["robot_2"] == env.mission.done


def test_where_nothing_can_be_done_all_terminate_at_once() -> None:
    """Eq. 1: the one task counts as finished at its deadline: −1 for the two robots, nothing for the absent."""
    env = mrta_v0.parallel_env(scenario=hopeless_scenario(2), max_robots=3, absent="noop")
    env.reset()
    _, rewards, terminations, _, _ = env.step(dict.fromkeys(env.agents, env.noop))
    assert rewards == {"robot_0": -1.0, "robot_1": -1.0, "robot_2": 0.0}
    assert all(terminations.values())


def test_they_may_not_choose() -> None:
    scenario = small_scenario(0, robots=1)
    legal = int(started(scenario=scenario).infos["robot_0"]["action_mask"].argmax())
    env = mrta_v0.parallel_env(scenario=scenario, max_robots=2, absent="noop", on_illegal="raise")
    env.reset()
    with pytest.raises(ActionError, match=r"robot_1 sent action 3 .* 8 \(the no-op\): the scenario has no such robot"):
        env.step({"robot_0": legal, "robot_1": 3})
    env = mrta_v0.parallel_env(scenario=scenario, max_robots=2, absent="noop", on_illegal="replace")
    env.reset()
    env.step({"robot_0": legal, "robot_1": 3})
    assert env.mission.routes == [[legal]]


def test_a_reward_function_is_asked_for_the_robots_there_are() -> None:
    env = mrta_v0.parallel_env(
        scenario=small_scenario(0, robots=2), max_robots=4, absent="noop", reward=lambda mission, finished: [1.0, 2.0]
    )
    env.reset()
    _, rewards, _, _, _ = env.step({agent: int(env.mask(agent).argmax()) for agent in env.agents})
    assert list(rewards.values())[2:] == [0.0, 0.0]
    assert rewards["robot_1"] == 2 * rewards["robot_0"] > 0


def test_a_shared_policy_acts_for_all() -> None:
    policy = NearestPolicy()
    env = mrta_v0.parallel_env(scenario=small_scenario(0, robots=2), max_robots=4, absent="noop", on_illegal="raise")
    observations, _ = env.reset()
    while env.agents:
        observations, *_ = env.step({agent: policy.act(observations[agent], agent) for agent in env.agents})
    assert env.mission.completed() > 0


@pytest.mark.parametrize("scenario_of", ["the default", "a generator's"])
def test_supersuits_vector_environments(scenario_of: str) -> None:
    """The default environment has 2, 3, 5 or 7 robots; an episode's end resets it into the next."""
    options = {} if scenario_of == "the default" else {"generator": GENERATOR}
    env = mrta_v0.parallel_env(observation="flat", on_illegal="replace", absent="noop", **options)
    vector = supersuit.pettingzoo_env_to_vec_env_v1(env)
    robots = len(env.possible_agents)
    envs = supersuit.concat_vec_envs_v1(vector, 2, num_cpus=1)
    observations, _ = envs.reset(seed=0)
    assert observations.shape == (2 * robots, *envs.observation_space.shape[-1:])
    rng = np.random.default_rng(0)
    ended = 0
    for _ in range(300):
        observations, _, terminations, _, _ = envs.step(rng.integers(0, env.noop, 2 * robots))
        assert np.isfinite(observations).all()
        ended += int(np.sum(terminations))
    assert ended >= 2 * robots


def test_the_option_is_checked() -> None:
    for make in (mrta_v0.env, mrta_v0.raw_env, mrta_v0.parallel_env):
        with pytest.raises(ConfigError, match="absent is 'dead'; expected one of omit, noop"):
            make(absent="dead")
    with pytest.raises(ConfigError, match="absent is 'noop'; expected 'omit', as one agent acts for all"):
        ActingRobotEnv(absent="noop")
