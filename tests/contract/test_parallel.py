"""The parallel form: who may act, conflicts, illegal actions, and that its plans are the AEC form's."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from factories import hopeless_scenario, mask_of, random_action, small_scenario
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import scenarios

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.errors import ActionError, ConfigError
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.mission import Mission


def play_parallel(env: Any, choose: Any) -> tuple[dict[str, float], int, list[int]]:
    """Play an episode to its end; gives each agent's return, the number of conflicts, and times of the steps."""
    observations, infos = env.reset()
    returns = dict.fromkeys(env.agents, 0.0)
    conflicts, times = 0, [0.0]
    while env.agents:
        before = set(env.agents)
        actions = {agent: choose(mask_of(observations[agent], infos[agent]), agent) for agent in env.agents}
        observations, rewards, terminations, truncations, infos = env.step(actions)
        assert set(observations) == set(rewards) == set(terminations) == set(truncations) == set(infos) == before
        assert not any(truncations.values())
        for agent in before:
            assert env.observation_space(agent).contains(observations[agent])
            mask = mask_of(observations[agent], infos[agent])
            assert mask.dtype == np.int8
            assert mask.shape == (env.action_space(agent).n,)
            assert mask.any()
            assert np.array_equal(mask, infos[agent]["action_mask"])
            if env.agents:  # a task, or the no-op, never both
                assert mask[:-1].any() != mask[-1]
            returns[agent] += rewards[agent]
            conflicts += infos[agent]["conflict"]
        times.append(max(info["time"] for info in infos.values()))
    assert times == sorted(times)
    return returns, conflicts, times


@settings(max_examples=150)
@given(
    scenario=scenarios(7, 4),
    rule=st.sampled_from(["feasible", "active", "unvisited"]),
    form=st.sampled_from(["dict", "flat"]),
    staggered=st.booleans(),
    seed=st.integers(0, 99),
)
def test_plans_are_plans_of_the_mission(scenario, rule, form, staggered, seed):
    env = mrta_v0.parallel_env(
        scenario=scenario, max_tasks=8, mask_rule=rule, observation=form, staggered=staggered, reward="individual"
    )
    rng = np.random.default_rng(seed)
    returns, _, times = play_parallel(env, lambda mask, agent: random_action(mask, rng))
    mission = env.mission
    assert mission.done
    taken = [task for route in mission.routes for task in route]
    assert len(taken) == len(set(taken))
    # The same routes, one decision at a time; at the same moment in any order, as long as each robot's own is kept.
    replay = Mission(scenario, rule)
    position = [0] * scenario.num_robots
    while not replay.done:
        ready = [robot for robot in replay.free() if position[robot] < len(mission.routes[robot])]
        if not ready:  # robots that found the rest taken by those that chose at the same moment
            break
        for robot in ready:
            replay.take(robot, mission.routes[robot][position[robot]])
            position[robot] += 1
        replay.advance()
    assert replay.routes == mission.routes
    assert np.array_equal(replay.finish, mission.finish)
    # And once more by hand.
    for robot, route in enumerate(mission.routes):
        time, place = 0.0, scenario.robot_xy[robot]
        for task in route:
            distance = np.hypot(*(scenario.task_xy[task] - place))
            time += distance / scenario.speed[robot] + scenario.workload[task] / scenario.capacity[robot]
            assert mission.finish[task] == pytest.approx(time)
            place = scenario.task_xy[task]
    assert times[-1] == mission.time
    rate = np.count_nonzero(mission.finish <= scenario.deadline) / scenario.num_tasks
    assert sum(returns.values()) == pytest.approx(rate)


@pytest.mark.parametrize("reward", ["terminal", "completion", "individual"])
def test_the_nearest_policy_makes_the_same_plan_in_both_forms(reward):
    compared = 0
    for seed in range(12):
        scenario = small_scenario(seed, tasks=12, robots=3)
        aec = mrta_v0.env(scenario=scenario, reward=reward)
        aec.reset()
        expected = dict.fromkeys(aec.agents, 0.0)
        for agent in aec.agent_iter():
            _, value, terminated, truncated, info = aec.last()
            expected[agent] += value
            over = terminated or truncated
            aec.step(None if over else nearest(aec.unwrapped.mission, agent, info["action_mask"]))
        env = mrta_v0.parallel_env(scenario=scenario, reward=reward)
        env.reset()

        def choose(mask, agent, env=env):
            return nearest(env.mission, agent, mask[:-1]) if mask[:-1].any() else env.noop

        returns, conflicts, _ = play_parallel(env, choose)
        if conflicts == 0:
            compared += 1
            assert env.mission.routes == aec.unwrapped.mission.routes
            assert returns == pytest.approx(expected)
    assert compared >= 3


def nearest(mission: Mission, agent: str, mask: np.ndarray) -> int:
    robot = int(agent.split("_")[1])
    offset = mission.scenario.task_xy - mission.position[robot]
    return int(np.where(mask[: len(offset)], np.hypot(*offset.T), np.inf).argmin())


def square() -> Scenario:
    """Three robots at the origin, tasks at 1, 2, 3 and 4 along x without work and with late deadlines."""
    return Scenario(
        task_xy=[[1, 0], [2, 0], [3, 0], [4, 0]], deadline=[50] * 4, workload=[0] * 4,
        robot_xy=[[0, 0]] * 3, capacity=[1] * 3, map_size=(10, 10),
    )  # fmt: skip


def test_an_illegal_action_may_stand_for_the_next_legal_one():
    """Tasks 0 to 3, padding 4 and the no-op 5: from 4 the next legal one is 0 at first, then, with 0 taken, 1."""
    env = mrta_v0.parallel_env(scenario=square(), max_tasks=5, on_illegal="replace")
    env.reset()
    env.step({"robot_0": 4, "robot_1": 4, "robot_2": 2})  # both are given task 0; robot_0 gets it, robot_1 none
    assert env.mission.routes == [[0], [], [2]]
    env.step({"robot_0": 3, "robot_1": 5, "robot_2": 0})  # those under way have only their no-op
    assert env.mission.routes == [[0], [1], [2]]
    _, _, terminations, _, _ = env.step({"robot_0": 0})  # back at time 1; from 0 the next is 3
    assert env.mission.routes == [[0, 3], [1], [2]]
    assert all(terminations.values())


def test_of_those_who_choose_the_same_task_the_lowest_index_gets_it():
    env = mrta_v0.parallel_env(scenario=square(), max_tasks=5)
    env.reset()
    _, _, _, _, infos = env.step({"robot_0": 1, "robot_1": 0, "robot_2": 1})
    assert [infos[agent]["conflict"] for agent in env.agents] == [0, 0, 1]
    assert [infos[agent]["time"] for agent in env.agents] == [0.0, 0.0, 0.0]  # the clock waits for robot_2
    assert infos["robot_2"]["action_mask"].tolist() == [0, 0, 1, 1, 0, 0]
    assert infos["robot_0"]["action_mask"].tolist() == [0, 0, 0, 0, 0, 1]  # under way: only the no-op
    _, _, _, _, infos = env.step({"robot_2": 3})  # the others need not send their no-op
    assert [infos[agent]["conflict"] for agent in env.agents] == [0, 0, 0]
    assert infos["robot_1"]["time"] == 1.0  # robot_1 has come to the task at 1
    assert infos["robot_1"]["action_mask"].tolist() == [0, 0, 1, 0, 0, 0]
    _, rewards, terminations, _, infos = env.step({"robot_0": 5, "robot_1": 2, "robot_2": 5})
    assert all(terminations.values())
    assert rewards == {"robot_0": 0.0, "robot_1": 0.0, "robot_2": 0.0}  # nothing late: no cost
    assert env.mission.routes == [[1], [0, 2], [3]]
    assert env.agents == []
    assert env.step({}) == ({}, {}, {}, {}, {})


@pytest.mark.parametrize(
    ("actions", "message"),
    [
        ({"robot_0": 4, "robot_1": 0, "robot_2": 1}, r"robot_0 sent action 4 \(the no-op\) at time 0; its valid"),
        ({"robot_0": 2, "robot_1": 0}, r"robot_2 sent action 4 \(the no-op\).*valid actions are 0, 1, 2, 3"),
    ],
)  # fmt: skip
def test_illegal_actions(actions, message):
    strict = mrta_v0.parallel_env(scenario=square(), on_illegal="raise")
    strict.reset()
    with pytest.raises(ActionError, match=message):
        strict.step(actions)
    assert strict.mission.routes == [[], [], []]  # nothing has changed
    env = mrta_v0.parallel_env(scenario=square(), illegal_reward=-3)
    for _ in range(2):
        env.reset()
        observations, rewards, terminations, truncations, infos = env.step(actions)
        offender = message[:7]
        assert rewards == {agent: -3.0 if agent == offender else 0.0 for agent in rewards}
        assert len(observations) == len(infos) == 3
        assert all(terminations.values())
        assert not any(truncations.values())
        assert env.agents == []
        assert env.mission.routes == [[], [], []]


def test_a_busy_robot_may_not_choose():
    env = mrta_v0.parallel_env(scenario=square(), on_illegal="raise")
    env.reset()
    env.step({"robot_0": 2, "robot_1": 0, "robot_2": 1})
    with pytest.raises(ActionError, match=r"robot_2 sent action 3 at time 1; its valid actions are 4 \(the no-op\)"):
        env.step({"robot_1": 3, "robot_2": 3})


@pytest.mark.parametrize("on_illegal", ["raise", "terminate"])
@pytest.mark.parametrize(
    ("actions", "message"),
    [
        ({"robot_0": 9}, "robot_0 sent action 9; expected a whole number from 0 to 4"),
        ({"robot_0": "x"}, "robot_0 sent action 'x'"),
        ({"robot_7": 0}, "there is an action for 'robot_7'; the agents now are robot_0, robot_1, robot_2"),
    ],
)
def test_what_is_no_action_at_all_always_raises(on_illegal, actions, message):
    env = mrta_v0.parallel_env(scenario=square(), on_illegal=on_illegal)
    env.reset()
    with pytest.raises(ActionError, match=message):
        env.step(actions)


def test_own_options_are_checked():
    with pytest.raises(ConfigError, match="on_illegal is 'noop'; expected one of terminate, raise"):
        mrta_v0.parallel_env(on_illegal="noop")
    env = mrta_v0.parallel_env()
    with pytest.raises(ActionError, match=r"call reset\(\) first"):
        env.step({})
    with pytest.raises(ActionError, match="no agent 'x'"):
        env.action_space("x")


def test_where_nothing_can_be_done_the_first_step_ends_it():
    env = mrta_v0.parallel_env(scenario=hopeless_scenario(2))
    for _ in range(2):
        observations, infos = env.reset()
        assert env.agents == ["robot_0", "robot_1"]
        for agent in env.agents:
            assert observations[agent]["action_mask"].tolist() == [0, 1]
            assert infos[agent]["conflict"] == 0
        _, rewards, terminations, _, _ = env.step({"robot_0": 1, "robot_1": 1})
        assert rewards == {"robot_0": -1.0, "robot_1": -1.0}
        assert all(terminations.values())


def test_the_first_step_brings_the_reward_of_the_reset():
    env = mrta_v0.parallel_env(scenario=square(), reward=lambda mission, finished: [1.0 + len(finished)] * 3)
    env.reset()
    _, rewards, _, _, _ = env.step({"robot_0": 1, "robot_1": 0, "robot_2": 1})
    assert set(rewards.values()) == {2.0}  # 1 at the reset + 1 now
    _, rewards, _, _, _ = env.step({"robot_2": 3})
    assert set(rewards.values()) == {2.0}  # 1 + 1 task finished


def test_staggered_robots_leave_early():
    # robot_1 is too slow for anything, robot_0 does both tasks.
    scenario = Scenario(
        task_xy=[[1, 0], [2, 0]], deadline=[5, 5], workload=[0, 0],
        robot_xy=[[0, 0], [0, 0]], capacity=[1, 1], speed=[1, 0.1], map_size=(10, 10),
    )  # fmt: skip
    env = mrta_v0.parallel_env(scenario=scenario, staggered=True, reward="individual")
    observations, _ = env.reset()
    assert observations["robot_1"]["action_mask"].tolist() == [0, 0, 1]
    _, rewards, terminations, _, _ = env.step({"robot_0": 0, "robot_1": 2})
    assert terminations == {"robot_0": False, "robot_1": True}
    assert rewards == {"robot_0": 0.5, "robot_1": 0.0}
    assert env.agents == ["robot_0"]
    observations, rewards, terminations, _, infos = env.step({"robot_0": 1})
    assert set(observations) == set(infos) == {"robot_0"}
    assert (rewards, terminations) == ({"robot_0": 0.5}, {"robot_0": True})
    assert env.agents == []


def test_the_same_seed_gives_the_same_episode_and_copies_go_on_alike():
    generator = UniformGenerator(tasks=(14, 18), robots=(3, 3), deadline=(90, 300))

    def record(env, seed):
        rng = np.random.default_rng(seed)
        out = []
        while env.agents:
            actions = {agent: random_action(env.mask(agent), rng) for agent in env.agents}
            observations, rewards, terminations, _, infos = env.step(actions)
            out.append((actions, rewards, terminations, {a: i["mask_reason"].tolist() for a, i in infos.items()},
                        {a: o["observation"]["tasks"].tolist() for a, o in observations.items()}))  # fmt: skip
        return out

    first, second = (mrta_v0.parallel_env(generator=generator) for _ in range(2))
    for seed in (3, None):
        first.reset(seed=seed)
        second.reset(seed=seed)
        rng = np.random.default_rng(0)
        for env in (first, second):
            rng = np.random.default_rng(0)
            env.step({agent: random_action(env.mask(agent), rng) for agent in env.agents})
        twins = [copy.deepcopy(first), pickle.loads(pickle.dumps(first)), second]
        original = record(first, 4)
        assert len(original) > 2
        assert all(record(twin, 4) == original for twin in twins)


def test_any_agent_can_be_observed_and_the_state_is_the_aec_forms():
    env = mrta_v0.parallel_env(scenario=square(), max_robots=5)
    aec = mrta_v0.env(scenario=square(), max_robots=5)
    env.reset()
    aec.reset()
    assert np.array_equal(env.state(), aec.state())
    absent = env.observe("robot_4")
    assert env.observation_space("robot_4").contains(absent)
    assert absent["action_mask"].tolist() == [0, 0, 0, 0, 1]
    env.step({"robot_0": 2, "robot_1": 0, "robot_2": 1})
    for task in (2, 0, 1):
        aec.step(task)
    assert np.array_equal(env.state(), aec.state())
    assert env.action_space("robot_0") is env.action_space("robot_0")
    assert env.observation_space("robot_0") is env.observation_space("robot_1")


@pytest.mark.parametrize("actions", [None, 3, [0, 1]])
def test_actions_come_in_a_dictionary(actions):
    env = mrta_v0.parallel_env()
    env.reset(seed=0)
    with pytest.raises(ActionError, match=r"actions is .*; expected a dictionary with an action for each agent"):
        env.step(actions)
