"""Rewards and termination of the AEC environment, over whole episodes."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from factories import (
    FORMS,
    GENERATOR,
    completion_rate,
    hopeless_scenario,
    play,
    small_scenario,
    started,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import scenarios

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.errors import ConfigError


@settings(max_examples=150)
@given(scenarios(6, 3), st.sampled_from(["feasible", "active", "unvisited"]), st.integers(0, 99))
def test_rewards_sum_to_what_they_promise(scenario, rule, seed):
    n = scenario.num_tasks
    shown = {}
    for reward in ("terminal", "completion", "individual"):
        env = mrta_v0.env(scenario=scenario, mask_rule=rule, reward=reward)
        env.reset()
        decisions, shown[reward] = play(env, seed)
        mission = env.unwrapped.mission
    taken = mission.taken_by >= 0
    late = taken & (mission.finish > scenario.deadline)
    end = np.maximum(mission.time, scenario.deadline)
    cost = (mission.finish / scenario.deadline)[late].sum() + (end / scenario.deadline)[~taken].sum()
    rate = (taken & ~late).sum() / n
    assert len(decisions) == taken.sum()
    for agent in shown["terminal"]:
        assert shown["terminal"][agent] == pytest.approx(-cost / n)
        assert shown["completion"][agent] == pytest.approx(rate)
        route = mission.routes[int(agent.split("_")[1])]
        assert shown["individual"][agent] == pytest.approx((~late[route]).sum() / n)
    assert sum(shown["individual"].values()) == pytest.approx(rate)


@settings(max_examples=100)
@given(scenarios(6, 3), st.integers(0, 99))
def test_staggered_robots_leave_with_all_they_earned(scenario, seed):
    env = mrta_v0.env(scenario=scenario, reward="individual", staggered=True)
    env.reset()
    together = mrta_v0.env(scenario=scenario, reward="individual")
    together.reset()
    decisions, returns = play(env, seed)
    assert (decisions, returns) == play(together, seed)
    assert sum(returns.values()) == pytest.approx(completion_rate(env))


def test_staggered_terminates_one_by_one():
    # robot_1 is too slow for anything, robot_0 does both tasks.
    scenario = Scenario(
        task_xy=[[1, 0], [2, 0]], deadline=[5, 5], workload=[0, 0],
        robot_xy=[[0, 0], [0, 0]], capacity=[1, 1], speed=[1, 0.1], map_size=(10, 10),
    )  # fmt: skip
    env = started(scenario=scenario, staggered=True, reward="completion")
    assert env.agent_selection == "robot_0"
    assert not any(env.terminations.values())
    env.step(0)
    assert env.terminations == {"robot_0": False, "robot_1": True}
    assert env.agent_selection == "robot_1"
    env.step(None)
    assert env.agents == ["robot_0"]
    assert env.agent_selection == "robot_0"
    assert env.last()[1] == 0.5  # the first of two tasks, not lost in the step of the dead
    env.step(1)
    assert env.last()[1:3] == (0.5, True)
    env.step(None)
    assert env.agents == []


@pytest.mark.parametrize("staggered", [False, True])
@pytest.mark.parametrize("form", FORMS)
def test_where_nothing_can_be_done_all_end_at_the_reset(form, staggered):
    env = started(scenario=hopeless_scenario(3), observation=form, staggered=staggered)
    for _ in range(2):
        env.reset()
        assert env.agents == ["robot_0", "robot_1", "robot_2"]
        assert all(env.terminations.values())
        decisions, returns = play(env)
        assert decisions == []
        assert returns == {"robot_0": -1.0, "robot_1": -1.0, "robot_2": -1.0}  # never done: costs 1 of 1 task
    assert not env.agents


def test_all_terminate_in_the_same_step():
    env = started(seed=1, generator=GENERATOR)
    for _ in env.agent_iter():
        observation, _, terminated, truncated, _ = env.last()
        assert len({*env.terminations.values()}) == 1
        assert not any(env.truncations.values())
        env.step(None if terminated or truncated else int(observation["action_mask"].argmax()))


def idle_penalty(mission, finished):
    return [-1.0 if mission.done else float(len(finished))] * mission.scenario.num_robots


def test_own_reward_function():
    scenario = small_scenario(5, tasks=5, robots=2)
    env = started(scenario=scenario, reward=idle_penalty)
    _, returns = play(pickle.loads(pickle.dumps(env)))
    assert set(returns) == {"robot_0", "robot_1"}
    assert returns["robot_0"] == returns["robot_1"]
    with pytest.raises(ConfigError, match="gave 1 number; expected 2, one for each robot"):
        started(scenario=scenario, reward=lambda mission, finished: [0.0])


@pytest.mark.parametrize("make", [mrta_v0.env, mrta_v0.parallel_env])
@pytest.mark.parametrize(
    ("given", "message"),
    [
        (1.5, "gave 1.5; expected a list of 3 numbers, one for each robot"),
        (None, "gave None; expected a list of 3 numbers"),
        (["a", 0, 0], r"gave \['a', 0, 0\]; expected a list of 3 numbers"),
        ("123", "gave '123'; expected a list of 3 numbers"),
        ({0: 1.0, 1: 1.0, 2: 1.0}, "gave {0: 1.0, 1: 1.0, 2: 1.0}; expected a list of 3 numbers"),
        ([0.0, float("nan"), 0.0], "gave nan to robot 1; expected a finite number"),
        (np.array([0.0, 0.0, -np.inf]), "gave -inf to robot 2; expected a finite number"),
        ([10**400, 0, 0], "gave .*; expected a list of 3 numbers"),
    ],
)  # fmt: skip
def test_a_reward_that_is_none_is_refused(make, given, message):
    env = make(scenario=small_scenario(0), reward=lambda mission, finished: given)
    with pytest.raises(ConfigError, match=f"the reward function {message}"):
        env.reset()


def test_rewards_may_be_numbers_of_numpy():
    env = mrta_v0.env(scenario=small_scenario(0), reward=lambda mission, finished: np.array([1, 2, 3], np.float32))
    env.reset()
    assert env.rewards == {"robot_0": 1.0, "robot_1": 2.0, "robot_2": 3.0}
