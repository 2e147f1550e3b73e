"""The AEC environment over whole episodes: rewards, masks, infos, determinism, copies, errors."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from factories import hopeless_scenario, mask_of, play, random_action, small_scenario
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import scenarios

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.errors import ActionError, ConfigError
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.mission import Mission
from mrta_zoo.observation import Observer, split
from mrta_zoo.rules import MaskReason, Status

GENERATOR = UniformGenerator(tasks=(3, 10), robots=(2, 5), deadline=(20, 200))
FORMS = ["dict", "flat"]
INFO_KEYS = {"time", "elapsed", "completed", "action_mask", "mask_reason"}


def started(seed: int = 0, make: Any = mrta_v0.env, **options: Any) -> Any:
    env = make(**options)
    env.reset(seed=seed)
    return env


def same(a: Any, b: Any) -> bool:
    """Equal, also in type and dtype, through dictionaries and arrays."""
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b)
    return type(a) is type(b) and a == b


def record(env: Any, seed: int) -> list[Any]:
    """Everything an episode shows, from where it stands to its end."""
    rng = np.random.default_rng(seed)
    seen = []
    for agent in env.agent_iter():
        observation, reward, terminated, truncated, info = env.last()
        seen.append({"agent": agent, "observation": observation, "reward": reward, "info": info,
                     "rewards": dict(env.rewards), "state": env.state(), "over": (terminated, truncated)})  # fmt: skip
        env.step(None if terminated or truncated else random_action(mask_of(observation, info), rng))
    return seen


def completion_rate(env: Any) -> float:
    mission = env.unwrapped.mission
    return mission.completed() / mission.scenario.num_tasks


# --- what is shown --------------------------------------------------------------------------------------------


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
            robot = env.unwrapped.mission.reasons(int(other.split("_")[1]))
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
    length, horizon = max(scenario.map_size), scenario.deadline.max()
    work, capacity, speed = scenario.workload.max() or 1, scenario.capacity.max(), scenario.speed.max()
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
        robots[i] = (*place / length, scenario.capacity[i] / capacity, scenario.speed[i] / speed,
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
        tasks[j, :4] = (*scenario.task_xy[j] / length, scenario.deadline[j] / horizon, scenario.workload[j] / work)
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
    dicts, flats = started(seed=4, generator=GENERATOR), started(seed=4, generator=GENERATOR, observation="flat")
    rng = np.random.default_rng(0)
    while dicts.agents:
        for agent in dicts.possible_agents:
            tables = dicts.observe(agent)["observation"]
            flat = flats.observe(agent)
            assert same(split(flat, 10, 5), tables)
            assert np.array_equal(np.concatenate([table.ravel() for table in tables.values()]), flat)
        tables = dicts.observe("robot_0")["observation"]
        state = np.concatenate((tables["tasks"].ravel(), tables["robots"][:, :6].ravel(), tables["mission"]))
        assert np.array_equal(dicts.state(), state)
        if dicts.terminations[dicts.agent_selection]:
            break
        action = random_action(dicts.infos[dicts.agent_selection]["action_mask"], rng)
        dicts.step(action)
        flats.step(action)
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


# --- rewards and termination ----------------------------------------------------------------------------------


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
    late = mission.finish > scenario.deadline  # NaN, never taken, is not late: it is counted below
    taken = mission.taken_by >= 0
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
    with pytest.raises(ConfigError, match="gave 1 numbers; expected 2, one for each robot"):
        started(scenario=scenario, reward=lambda mission, finished: [0.0])


# --- seeds, copies --------------------------------------------------------------------------------------------


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


# --- errors ---------------------------------------------------------------------------------------------------


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


@pytest.mark.parametrize("action", [99, -1, 1.5, "a", None])
def test_an_action_outside_the_space_is_refused(action):
    env = started(scenario=small_scenario(0, tasks=4))
    for error in (ActionError, AssertionError):
        with pytest.raises(error, match=f"robot_0 sent action {action!r}; expected a whole number from 0 to 3"):
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
        ({"observation": "box"}, "observation is 'box'; expected one of dict, flat"),
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
