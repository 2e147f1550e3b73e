"""What the AEC environment refuses, and how it says so."""

from __future__ import annotations

import copy
import re

import numpy as np
import pytest
from factories import (
    FORMS,
    GENERATOR,
    play,
    same,
    small_scenario,
    started,
)

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.errors import ActionError, ConfigError
from mrta_zoo.generators import UniformGenerator


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("reward", ["terminal", "completion"])
def test_an_illegal_action_ends_the_episode(form, reward):
    env = mrta_v0.env(scenario=small_scenario(0, robots=3), observation=form, reward=reward, illegal_reward=-5)
    for _ in range(2):
        env.reset()
        env.step(0)
        assert env.agent_selection == "robot_1"
        env.step(0)  # taken
        assert all(env.terminations.values())
        _, returns = play(env)
        assert returns == {"robot_0": 0.0, "robot_1": -5.0, "robot_2": 0.0}
        assert not env.agents


@pytest.mark.parametrize("form", FORMS)
def test_the_raw_environment_explains_an_illegal_action(form):
    # Task 1 is 9 away and due at 1; the others can be done.
    scenario = Scenario(
        task_xy=[[1, 0], [9, 0], [2, 0], [3, 0]], deadline=[50, 1, 50, 50], workload=[1, 1, 1, 1],
        robot_xy=[[0, 0], [0, 0]], capacity=[1, 1], map_size=(10, 10),
    )  # fmt: skip
    env = started(make=mrta_v0.raw_env, scenario=scenario, max_tasks=6, observation=form)
    before = copy.deepcopy(env.infos)
    legal = np.flatnonzero(before["robot_0"]["action_mask"]).tolist()
    assert legal == [0, 2, 3]
    for action, message in (
        (1, "robot_0 sent action 1: .*too late; its choices are 0, 2, 3"),
        (5, "robot_0 sent action 5: .*tasks are numbered 0 to 3"),
        (6, "robot_0 sent action 6; expected a whole number from 0 to 5"),
        (-1, "robot_0 sent action -1; expected a whole number from 0 to 5"),
        (None, "robot_0 sent action None; expected a whole number"),
        (1.0, "robot_0 sent action 1.0; expected a whole number"),
        (True, "robot_0 sent action True; expected a whole number"),
        ("0", "robot_0 sent action '0'; expected a whole number"),
    ):
        with pytest.raises(ActionError, match=message):
            env.step(action)
        assert same(env.infos, before)  # nothing has changed
        assert env.agent_selection == "robot_0"
    env.step(np.int64(0))
    with pytest.raises(ActionError, match=r"robot_1 sent action 0: .*: taken; its choices are"):
        env.step(0)


@pytest.mark.parametrize("action", [99, -1, 1.5, 1.0, np.float64(1.0), "a", None])
def test_an_action_outside_the_space_is_refused(action):
    env = started(scenario=small_scenario(0, tasks=4))
    for error in (ActionError, AssertionError):
        with pytest.raises(error, match=f"robot_0 sent action {re.escape(repr(action))}; expected a whole number"):
            env.step(action)
    play(env)
    env.reset()
    while not env.terminations[env.agent_selection]:
        env.step(int(env.last()[4]["action_mask"].argmax()))
    with pytest.raises(ActionError, match="has terminated and sent action 0; expected None"):
        env.step(0)


def test_nothing_can_be_asked_before_the_first_reset():
    env = mrta_v0.env()
    for name in ("rewards", "terminations", "truncations", "infos", "agent_selection", "num_agents", "agents"):
        with pytest.raises(AttributeError, match="cannot be accessed before reset"):
            getattr(env, name)
    for ask in (env.state, env.render, lambda: env.step(0), lambda: env.observe("robot_0")):
        with pytest.raises(AssertionError, match="reset"):
            ask()
    raw = mrta_v0.raw_env()
    for ask in (raw.state, lambda: raw.step(0), lambda: raw.observe("robot_0")):
        with pytest.raises(ActionError, match=r"call reset\(\) first"):
            ask()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"mask_rule": "none"}, "mask_rule is 'none'; expected one of feasible, active, unvisited"),
        ({"mask_rule": None}, "mask_rule is None"),
        ({"reward": "sparse"}, "reward is 'sparse'; expected one of terminal, completion, individual, or a function"),
        ({"reward": ["terminal"]}, "reward is"),
        ({"observation": "box"}, "observation is 'box'; expected one of dict, masked, flat"),
        ({"observation": ["dict"]}, "observation is"),
        ({"render_mode": "window"}, "render_mode is 'window'; expected one of ansi, human, rgb_array"),
        ({"max_tasks": 0}, "max_tasks is 0; expected a whole number >= 1"),
        ({"max_robots": 2.5}, "max_robots is 2.5; expected a whole number >= 1"),
        ({"max_robots": True}, "max_robots is True"),
        ({"staggered": "yes"}, "staggered is 'yes'; expected True or False"),
        ({"scenario": "case.txt"}, "scenario is 'case.txt'; expected a mrta_zoo.Scenario"),
        ({"generator": "taptcc"}, "there is no generator 'taptcc'"),
        ({"generator": 3}, "generator is 3; expected a function"),
        ({"generator": UniformGenerator}, "generator is <class"),
        ({"generator": GENERATOR, "scenario": small_scenario()}, "both a scenario and a generator"),
        ({"scenario": small_scenario(), "max_tasks": 7}, "has 8 tasks, but this environment has room for 7"),
        ({"scenario": small_scenario(), "max_robots": 2}, "has 3 robots, but .* room for 2; make it with max_robots=3"),
        ({"mask_rul": "active"}, "there is no option 'mask_rul'; the environment has scenario, generator, max_tasks"),
    ],
)  # fmt: skip
def test_options_are_checked_when_made(options, message):
    for make in (mrta_v0.env, mrta_v0.raw_env, mrta_v0.parallel_env):
        with pytest.raises(ConfigError, match=message):
            make(**options)


@pytest.mark.parametrize("make", [mrta_v0.env, mrta_v0.parallel_env])
def test_what_reset_is_given_is_checked(make):
    env = make(max_tasks=8, max_robots=3)
    scenario = small_scenario(0)
    env.reset(options={"scenario": scenario})
    assert env.unwrapped.mission.scenario is scenario
    for arguments, message in (
        ({"options": 5}, "reset's options is 5; expected a dictionary"),
        ({"options": ["scenario"]}, "reset's options is .'scenario'.; expected a dictionary"),
        ({"options": {"scenari": scenario}}, "reset has no option 'scenari'; it has 'scenario'"),
        ({"options": {"scenario": "small"}}, "option 'scenario' is 'small'; expected a mrta_zoo.Scenario"),
        ({"options": {"scenario": small_scenario(0, tasks=9)}}, "has 9 tasks, but this environment has room for 8"),
        ({"seed": -1}, "seed is -1; expected a whole number >= 0"),
        ({"seed": "a"}, "seed is 'a'"),
        ({}, "the generator draws up to 100 tasks, but this environment has room for 8"),
    ):
        with pytest.raises(ConfigError, match=message):
            env.reset(**arguments)
    assert env.unwrapped.mission.scenario is scenario  # a refused reset leaves the episode as it was
    wrong = make(generator=lambda rng: rng.random())
    with pytest.raises(ConfigError, match=r"the generator drew 0\.\d+; expected a mrta_zoo.Scenario"):
        wrong.reset(seed=0)
    big = make(generator=lambda rng: small_scenario(rng, robots=9))
    with pytest.raises(ConfigError, match="has 9 robots, but this environment has room for 7"):
        big.reset(seed=0)


@pytest.mark.parametrize("make", [mrta_v0.env, mrta_v0.parallel_env])
@pytest.mark.parametrize("value", ["x", None, float("nan"), float("inf"), True, [1.0]])
def test_the_illegal_reward_is_a_number(make, value):
    with pytest.raises(ConfigError, match=r"illegal_reward is .*; expected a finite number"):
        make(illegal_reward=value)


def test_true_is_no_action():
    for make in (mrta_v0.env, mrta_v0.raw_env):
        env = started(make=make)
        with pytest.raises(ActionError, match=r"robot_. sent action True; expected a whole number from 0 to 99"):
            env.step(True)
