"""What the AEC environment shows: observations, masks, infos, state, spaces."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from factories import (
    FORMS,
    GENERATOR,
    mask_of,
    random_action,
    same,
    small_scenario,
    started,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import scenarios

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.env.observation import Observer, split
from mrta_zoo.errors import ActionError, ConfigError
from mrta_zoo.mission import Mission
from mrta_zoo.rules import MaskReason, Status
from mrta_zoo.scales import Scales

INFO_KEYS = {"time", "elapsed", "completed", "action_mask", "mask_reason"}


@settings(max_examples=150)
@given(
    scenario=scenarios(6, 3),
    rule=st.sampled_from(["feasible", "active", "unvisited"]),
    form=st.sampled_from(FORMS),
    staggered=st.booleans(),
    seed=st.integers(0, 99),
)
def test_everything_stays_within_its_space(scenario, rule, form, staggered, seed):
    env = mrta_v0.env(max_tasks=7, max_robots=4, mask_rule=rule, observation=form, staggered=staggered)
    env.reset(options={"scenario": scenario})
    rng = np.random.default_rng(seed)
    decisions = 0
    last_time = 0.0
    for agent in env.agent_iter():
        for possible in env.possible_agents:
            assert env.observation_space(possible).contains(env.observe(possible))
        assert env.state_space.contains(env.state())
        assert set(env.agents) == set(env.infos) == set(env.rewards) == set(env.terminations)
        for other in env.agents:
            info = env.infos[other]
            assert set(info) == INFO_KEYS
            assert [type(info[key]) for key in ("time", "elapsed", "completed")] == [float, float, int]
            assert info["action_mask"].dtype == info["mask_reason"].dtype == np.int8
            assert info["action_mask"].shape == info["mask_reason"].shape == (7,)
            assert np.array_equal(info["action_mask"] == 1, info["mask_reason"] == MaskReason.CHOOSABLE)
            assert (info["mask_reason"][scenario.num_tasks :] == MaskReason.NO_TASK).all()
            assert (info["mask_reason"][: scenario.num_tasks] != MaskReason.NO_TASK).all()
            robot = env.unwrapped.mission.reasons[int(other.split("_")[1])]
            assert np.array_equal(info["mask_reason"][: scenario.num_tasks], robot)
            assert type(env.terminations[other]) is type(env.truncations[other]) is bool
        observation, _, terminated, truncated, info = env.last()
        assert not truncated
        assert info["time"] >= last_time
        last_time = info["time"]
        if terminated:
            env.step(None)
            continue
        mask = mask_of(observation, info)
        assert mask.dtype == np.int8
        assert mask.any(), "an agent that must act has nothing to choose"
        assert np.array_equal(mask, info["action_mask"])
        assert mask[env.action_space(agent).sample(mask)]
        env.step(random_action(mask, rng))
        decisions += 1
    assert decisions <= scenario.num_tasks
    assert not env.agents


def expected_tables(mission: Mission, robot: int, max_tasks: int, max_robots: int) -> dict[str, np.ndarray]:
    """The tables from the scenario and the routes alone, number by number."""
    scenario = mission.scenario
    scales = Scales.of(scenario)
    length, horizon, work, capacity, speed = scales.length, scales.time, scales.work, scales.capacity, scales.speed
    tasks, robots = np.zeros((max_tasks, 8)), np.zeros((max_robots, 7))
    finish = np.full(scenario.num_tasks, np.nan)
    for i, route in enumerate(mission.routes):
        time, place = 0.0, scenario.robot_xy[i]
        for task in route:
            dx, dy = scenario.task_xy[task] - place
            time = (
                time + np.sqrt(dx * dx + dy * dy) / scenario.speed[i] + scenario.workload[task] / scenario.capacity[i]
            )
            finish[task], place = time, scenario.task_xy[task]
        robots[i] = (*(place - scales.origin) / length, min(scenario.capacity[i] / capacity, 1),
                     min(scenario.speed[i] / speed, 1),
                     min(time / horizon, 1), not mission.retired[i], i == robot)  # fmt: skip
    for j in range(scenario.num_tasks):
        late = (scenario.deadline[j] if np.isnan(finish[j]) else finish[j]) > scenario.deadline[j]
        if np.isnan(finish[j]):
            status = 3 if scenario.deadline[j] < mission.time else 0
        else:
            status = 1 if finish[j] > mission.time else 3 if late else 2
        if finish[j] == mission.time:  # ends at this very moment: of this robot, or of one whose turn it will be
            status = int(mission.status[j])
            assert status in (2, 3)
        tasks[j, :4] = (
            *(scenario.task_xy[j] - scales.origin) / length,
            min(scenario.deadline[j] / horizon, 1),
            min(scenario.workload[j] / work, 1),
        )
        tasks[j, 4 + status] = 1
    crossing, labour = length / speed / horizon, work / capacity / horizon
    elapsed = min(mission.time / horizon, 1)
    return {"tasks": tasks, "robots": robots, "ego": robots[robot, :5],
            "mission": np.array([elapsed, crossing / (1 + crossing), labour / (1 + labour)])}  # fmt: skip


@pytest.mark.parametrize("rule", ["feasible", "active", "unvisited"])
@pytest.mark.parametrize("seed", range(4))
def test_observations_say_what_the_documentation_says(rule, seed):
    scenario = small_scenario(seed, tasks=9, robots=3)
    env = started(scenario=scenario, mask_rule=rule, max_tasks=10, max_robots=4)
    rng = np.random.default_rng(seed)
    while True:
        mission = env.unwrapped.mission
        for robot, agent in enumerate(env.possible_agents[:3]):
            shown = env.observe(agent)["observation"]
            for name, table in expected_tables(mission, robot, 10, 4).items():
                np.testing.assert_allclose(shown[name], table, rtol=1e-6, err_msg=name)
        for info in env.infos.values():
            assert info["completed"] == (mission.status == Status.COMPLETED).sum()
        if mission.done:
            break
        env.step(random_action(env.last()[4]["action_mask"], rng))


def test_an_observer_can_turn_to_another_mission():
    scenario = small_scenario(0)
    first, second = Mission(scenario), Mission(scenario)
    choices = np.flatnonzero(first.mask(0))
    first.assign(int(choices[0]))
    second.assign(int(choices[1]))
    observer = Observer(scenario, 8, 3)
    for mission in (first, second, first):
        assert same(observer.observe(mission, 1), Observer(scenario, 8, 3).observe(mission, 1))
    assert not same(observer.observe(first, 1), observer.observe(second, 1))


def test_flat_holds_the_same_as_the_tables():
    dicts, flats, masked = (
        started(seed=4, generator=GENERATOR, observation=form) for form in ("dict", "flat", "masked")
    )
    rng = np.random.default_rng(0)
    while dicts.agents:
        for agent in dicts.possible_agents:
            tables = dicts.observe(agent)["observation"]
            flat = flats.observe(agent)
            assert same(split(flat, 10, 5), tables)
            mask = dicts.observe(agent)["action_mask"]
            assert same(masked.observe(agent), {"observation": flat, "action_mask": mask})
            assert np.array_equal(np.concatenate([table.ravel() for table in tables.values()]), flat)
        tables = dicts.observe("robot_0")["observation"]
        state = np.concatenate((tables["tasks"].ravel(), tables["robots"][:, :6].ravel(), tables["mission"]))
        assert np.array_equal(dicts.state(), state)
        if dicts.terminations[dicts.agent_selection]:
            break
        action = random_action(dicts.infos[dicts.agent_selection]["action_mask"], rng)
        dicts.step(action)
        flats.step(action)
        masked.step(action)
    with pytest.raises(ConfigError, match=r"has \d+ numbers; this one has 3"):
        split(np.zeros(3, dtype=np.float32), 10, 5)


def test_any_agent_can_be_observed_at_any_time():
    env = started(scenario=small_scenario(0, tasks=6, robots=2), max_robots=4)
    while True:
        for robot in range(4):
            observation = env.observe(f"robot_{robot}")
            flags = observation["observation"]["robots"][:, 6]
            if robot < 2:
                assert flags.tolist() == [float(other == robot) for other in range(4)]
                ego = observation["observation"]["robots"][robot, :5]
                assert np.array_equal(observation["observation"]["ego"], ego)
            else:  # never there
                assert not flags.any()
                assert not observation["observation"]["ego"].any()
                assert not observation["action_mask"].any()
        if not env.agents:
            break
        _, _, terminated, _, info = env.last()
        env.step(None if terminated else int(info["action_mask"].argmax()))
    with pytest.raises(ActionError, match="no agent 'rover_1'; they are robot_0 to robot_3"):
        env.observe("rover_1")


def test_observations_are_the_observers_own():
    env = started(generator=GENERATOR)
    first = env.observe("robot_0")
    kept = copy.deepcopy(first)
    first["observation"]["tasks"][:] = -1
    first["action_mask"][:] = 0
    env.infos["robot_0"]["action_mask"][:] = 0
    env.infos["robot_0"]["mask_reason"][:] = 9
    assert same(env.observe("robot_0"), kept)
    infos = env.infos
    env.step(int(kept["action_mask"].argmax()))
    assert infos is not env.infos  # rebuilt, so that what a learner kept stays as it was
    assert env.infos["robot_0"]["mask_reason"].max() <= 4


def test_spaces_are_static_and_alike():
    env = mrta_v0.env(max_tasks=9, max_robots=3)
    for agent in env.possible_agents:
        assert env.observation_space(agent) is env.observation_space(agent)
        assert env.action_space(agent) is env.action_space(agent)
        assert env.observation_space(agent) == env.observation_space("robot_0")
        assert env.action_space(agent) == env.action_space("robot_0")
    assert env.action_space("robot_1") is not env.action_space("robot_0")  # each with its own seed
    assert env.possible_agents == ["robot_0", "robot_1", "robot_2"]


def test_elapsed_is_the_time_since_the_last_decision():
    # Both robots at (0, 0) and of speed 1. Tasks at 3, 10 and 4 along x, without work.
    scenario = Scenario(
        task_xy=[[3, 0], [10, 0], [4, 0]], deadline=[90, 90, 90], workload=[0, 0, 0],
        robot_xy=[[0, 0], [0, 0]], capacity=[1, 1], map_size=(10, 10),
    )  # fmt: skip
    env = started(scenario=scenario)
    env.step(0)  # robot_0 is free again at 3
    env.step(1)  # robot_1 at 10
    assert env.agent_selection == "robot_0"
    assert env.infos["robot_0"]["time"] == 3.0
    assert env.infos["robot_0"]["elapsed"] == 3.0
    assert env.infos["robot_0"]["completed"] == 1
    env.step(2)  # at 3 + 1 = 4 robot_0 has nothing left, at 10 robot_1 neither
    assert env.infos["robot_0"]["time"] == 10.0
    assert env.infos["robot_0"]["elapsed"] == 7.0  # 10 - 3
    assert env.infos["robot_1"]["elapsed"] == 10.0  # 10 - 0
    assert env.infos["robot_1"]["completed"] == 3
    assert all(env.terminations.values())
