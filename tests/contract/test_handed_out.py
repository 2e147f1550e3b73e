"""What the environment hands out belongs to the caller: whatever becomes of it, the episode stays the same."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np
import pytest
from factories import FORMS, mask_of, random_action, same, small_scenario, started

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.env.gym_view import ActingRobotEnv
from mrta_zoo.errors import ActionError

# Two robots, three tasks; robot_0 may choose all of them at first, robot_1 as well.
SCENARIO = Scenario(
    task_xy=[[10, 10], [40, 80], [90, 30]], deadline=[60, 120, 150], workload=[20, 20, 10],
    robot_xy=[[0, 0], [50, 50]], capacity=[1, 2], map_size=(100, 100),
)  # fmt: skip


def spoil(thing: Any) -> None:
    """Writes over every array within what was handed out, and empties every dictionary and list."""
    if isinstance(thing, dict):
        for value in thing.values():
            spoil(value)
        thing.clear()
    elif isinstance(thing, (list, tuple)):
        for value in thing:
            spoil(value)
        if isinstance(thing, list):
            thing.clear()
    elif isinstance(thing, np.ndarray):
        thing.fill(1 - int(thing.flat[0]))


def strike_out(mask: np.ndarray) -> None:
    mask[:] = 0


def allow_all(mask: np.ndarray) -> None:
    mask[:] = 1


def with_supersuit(env: Any) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        supersuit = pytest.importorskip("supersuit")
    return supersuit.pad_action_space_v0(supersuit.reward_lambda_v0(env, lambda reward: reward))


AEC: dict[str, Callable[..., Any]] = {
    "raw_env": mrta_v0.raw_env,
    "env": mrta_v0.env,
    "SuperSuit": lambda **options: with_supersuit(mrta_v0.env(**options)),
}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("make", AEC)
@pytest.mark.parametrize("change", [strike_out, allow_all])
def test_a_legal_action_stays_legal(make: str, form: str, change: Callable[[np.ndarray], None]) -> None:
    """Rank, take the best, strike it out, then send it: neither robot is punished, and nobody has terminated."""
    env = started(seed=1, make=AEC[make], scenario=SCENARIO, observation=form)
    observation, _, _, _, info = env.last()
    for mask in (mask_of(observation, info), info["action_mask"], env.infos["robot_0"]["action_mask"]):
        change(mask)
    change(mask_of(env.observe("robot_0"), env.infos["robot_0"]))
    info.pop("action_mask")
    if isinstance(observation, dict):
        observation.pop("action_mask")
    env.step(0)
    assert env.rewards == {"robot_0": 0.0, "robot_1": 0.0}
    assert env.terminations == env.truncations == {"robot_0": False, "robot_1": False}
    assert env.unwrapped.mission.routes == [[0], []]
    assert env.last()[4]["action_mask"].tolist() == [0, 1, 1]


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("make", ["env", "SuperSuit"])
def test_an_illegal_action_stays_illegal(make: str, form: str) -> None:
    """Task 0 is taken; allowing it in every mask handed out ends the episode in the documented way, as ever."""
    env = started(seed=1, make=AEC[make], scenario=SCENARIO, observation=form, illegal_reward=-5)
    env.step(0)
    observation, _, _, _, info = env.last()
    for mask in (mask_of(observation, info), info["action_mask"], env.infos["robot_1"]["action_mask"]):
        mask[:] = 1
    env.step(0)
    assert env.rewards == {"robot_0": 0.0, "robot_1": -5.0}
    assert all(env.terminations.values())
    assert all(env.truncations.values())
    assert env.unwrapped.mission.routes == [[0], []]


@pytest.mark.parametrize("form", FORMS)
def test_in_the_raw_environment_too(form: str) -> None:
    raw = started(seed=1, make=mrta_v0.raw_env, scenario=SCENARIO, observation=form)
    raw.step(0)
    observation, _, _, _, info = raw.last()
    mask_of(observation, info)[:] = 1
    with pytest.raises(ActionError, match=r"robot_1 sent action 0: .*: taken; its choices are 1, 2"):
        raw.step(0)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("make", AEC)
def test_spoiling_everything_changes_no_episode(make: str, form: str) -> None:
    options = {"scenario": small_scenario(2), "observation": form, "reward": "individual"}
    env, twin = (started(make=AEC[make], **options) for _ in range(2))
    rng = np.random.default_rng(0)
    while twin.agents:
        seen, expected = env.last(), twin.last()
        assert all(same(one, other) for one, other in zip(seen, expected, strict=True))
        spoil(seen)
        if not expected[2]:  # at the end they stay until all have seen theirs
            spoil(list(env.infos.values()))
        for _ in range(2):  # asked again after spoiling, it says the same
            assert np.array_equal(env.state(), twin.state())
            spoil(env.state())
            for possible in env.possible_agents:
                assert same(env.observe(possible), twin.observe(possible))
                spoil(env.observe(possible))
        action = None if expected[2] else random_action(mask_of(expected[0], expected[4]), rng)
        assert env.agent_selection == twin.agent_selection
        env.step(action)
        twin.step(action)
        assert env.rewards == twin.rewards


def test_an_action_is_judged_by_the_environments_size_and_not_by_a_space_handed_out() -> None:
    for make in (mrta_v0.env, mrta_v0.raw_env):
        env = started(seed=1, make=make, scenario=SCENARIO)
        env.action_space("robot_0").n = np.int64(1)
        env.unwrapped.action_spaces.clear()
        env.possible_agents.reverse()
        env.agents.reverse()
        env.step(2)
        assert env.agent_selection == "robot_1"
        assert env.unwrapped.mission.routes == [[2], []]


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("on_illegal", ["terminate", "raise", "replace"])
def test_the_parallel_form(form: str, on_illegal: str) -> None:
    options = {"scenario": small_scenario(2), "observation": form, "on_illegal": on_illegal, "reward": "individual"}
    env, twin = mrta_v0.parallel_env(**options), mrta_v0.parallel_env(**options)
    seen, expected = env.reset(seed=0), twin.reset(seed=0)
    rng = np.random.default_rng(0)
    while twin.agents:
        assert same(dict(enumerate(seen)), dict(enumerate(expected)))
        actions = {agent: random_action(twin.mask(agent), rng) for agent in twin.agents}
        spoil(seen)
        spoil([env.observe(agent) for agent in env.possible_agents])
        spoil([env.mask(agent) for agent in env.possible_agents])
        spoil([env.state(), env.agents])
        seen, expected = env.step(actions), twin.step(actions)
    assert same(dict(enumerate(seen)), dict(enumerate(expected)))
    assert env.agents == []
    assert env.mission.routes == twin.mission.routes


def test_an_illegal_action_stays_illegal_in_the_parallel_form() -> None:
    env = mrta_v0.parallel_env(scenario=SCENARIO)
    observations, infos = env.reset()
    for agent in env.agents:
        observations[agent]["action_mask"][:] = 1
        infos[agent]["action_mask"][:] = 1
    _, rewards, terminations, _, _ = env.step({"robot_0": 0, "robot_1": env.noop})  # which must choose
    assert rewards == {"robot_0": 0.0, "robot_1": -1.0}
    assert all(terminations.values())


def plain(env: gymnasium.Env[Any, Any]) -> gymnasium.Env[Any, Any]:
    return env


def checked(env: gymnasium.Env[Any, Any]) -> gymnasium.Env[Any, Any]:
    return gymnasium.wrappers.RecordEpisodeStatistics(gymnasium.wrappers.OrderEnforcing(env))


@pytest.mark.parametrize("wrap", [plain, checked])
@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("on_illegal", ["terminate", "raise", "replace"])
def test_the_gymnasium_view(form: str, on_illegal: str, wrap: Callable[[Any], Any]) -> None:
    options: dict[str, Any] = {"scenario": small_scenario(2), "observation": form, "on_illegal": on_illegal}
    view, twin = wrap(ActingRobotEnv(**options)), ActingRobotEnv(**options)
    seen, expected = view.reset(seed=0), twin.reset(seed=0)
    rng = np.random.default_rng(0)
    over = False
    while not over:
        assert same(seen[0], expected[0])
        assert same(seen[-1], expected[-1])
        action = random_action(twin.action_masks(), rng)
        spoil(seen)
        spoil(view.get_wrapper_attr("action_masks")())
        view.unwrapped.action_space.n = np.int64(1)
        seen, expected = view.step(action), twin.step(action)
        assert seen[1:4] == expected[1:4]
        over = expected[2]
    assert view.unwrapped.mission.routes == twin.mission.routes


def test_an_illegal_action_stays_illegal_in_the_gymnasium_view() -> None:
    view = ActingRobotEnv(scenario=SCENARIO, observation="masked")
    view.reset()
    observation, _, _, _, info = view.step(0)
    observation["action_mask"][:] = 1
    info["action_mask"][:] = 1
    view.action_masks()[:] = True
    assert view.step(0)[1:4] == (-1.0, True, False)


def test_what_a_reward_function_is_told_is_its_own() -> None:
    def reward(mission: Any, finished: Any) -> list[float]:
        gained = [float(len(finished))] * mission.scenario.num_robots
        finished.clear()
        return gained

    env = started(seed=1, scenario=SCENARIO, reward=reward)
    for task in (0, 1, 2):
        env.step(task)
    assert env.infos["robot_0"]["completed"] == env.unwrapped.mission.completed() == 3
