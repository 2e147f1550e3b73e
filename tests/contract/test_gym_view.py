"""The mission as a Gymnasium environment: one agent that acts for each robot in its turn."""

from __future__ import annotations

import copy
import pickle

import gymnasium
import numpy as np
import pytest
from factories import FORMS, GENERATOR, hopeless_scenario, random_action, same, small_scenario
from gymnasium.utils.env_checker import check_env

from mrta_zoo import mrta_v0
from mrta_zoo.env.gym_view import ActingRobotEnv
from mrta_zoo.errors import ActionError, ConfigError


@pytest.mark.parametrize("form", FORMS)
def test_gymnasium_check(form: str) -> None:
    check_env(ActingRobotEnv(generator=GENERATOR, observation=form), skip_render_check=True)


@pytest.mark.parametrize("form", FORMS)
def test_gymnasium_makes_it(form: str) -> None:
    """Under Gymnasium's own wrappers, one of which checks what it gives; warnings are errors here."""
    env = gymnasium.make("mrta_zoo/mrta-v0", generator=GENERATOR, observation=form, reward="completion")
    assert isinstance(env.unwrapped, ActingRobotEnv)
    assert env.spec is not None
    assert env.spec.max_episode_steps is None
    check_env(env.unwrapped, skip_render_check=True)
    alone = ActingRobotEnv(generator=GENERATOR, observation=form, reward="completion")
    assert same(env.reset(seed=5)[0], alone.reset(seed=5)[0])
    over = False
    while not over:
        action = int(env.get_wrapper_attr("action_masks")().argmax())
        seen, expected = env.step(action), alone.step(action)
        assert same(dict(enumerate(seen)), dict(enumerate(expected)))
        over = seen[2]
    with pytest.raises(ConfigError, match="there is no option 'mask'"):
        gymnasium.make("mrta_zoo/mrta-v0", mask=1)


def test_gymnasium_makes_many() -> None:
    envs = gymnasium.make_vec("mrta_zoo/mrta-v0", num_envs=3, generator=GENERATOR, observation="masked")
    observations, infos = envs.reset(seed=0)
    assert observations["action_mask"].shape == infos["action_mask"].shape == (3, 10)
    assert np.array_equal(np.stack(envs.call("action_masks")), observations["action_mask"] == 1)
    _, rewards, terminated, _, _ = envs.step(observations["action_mask"].argmax(axis=1))
    assert rewards.tolist() == [0.0, 0.0, 0.0]  # nothing is done yet
    assert not terminated.any()


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("reward", ["terminal", "completion", "individual"])
def test_is_the_aec_form_turn_by_turn(form: str, reward: str) -> None:
    view = ActingRobotEnv(generator=GENERATOR, observation=form, reward=reward)
    aec = mrta_v0.raw_env(generator=GENERATOR, observation=form, reward=reward)
    rng = np.random.default_rng(0)
    for seed in range(10):
        seen, info = view.reset(seed=seed)
        aec.reset(seed=seed)
        over, returns, expected = False, 0.0, sum(aec.rewards.values()) / len(aec.agents)
        while not over:
            agent = aec.agent_selection
            assert agent == f"robot_{view.robot}" == f"robot_{info['robot']}"
            assert str(seen) == str(aec.observe(agent))
            assert np.array_equal(view.action_masks(), aec.infos[agent]["action_mask"])
            action = random_action(view.action_masks(), rng)
            seen, gained, over, truncated, info = view.step(action)
            aec.step(action)
            returns += gained
            expected += sum(aec.rewards.values()) / len(aec.agents)
            assert over == all(aec.terminations.values())
            assert not truncated
        assert returns == pytest.approx(expected)


def test_reward_is_the_mean_of_the_robots() -> None:
    """Of 3 robots the one that completes one of 8 tasks gets 1/8: the mean is 1/24."""
    view = ActingRobotEnv(scenario=small_scenario(0), reward="individual")
    view.reset()
    gained = 0.0
    over = False
    while not over:
        _, reward, over, _, info = view.step(int(view.action_masks().argmax()))
        gained += reward
    assert info["completed"] > 0
    assert gained == pytest.approx(info["completed"] / 24)


@pytest.mark.parametrize("form", FORMS)
def test_an_illegal_action_ends_the_episode(form: str) -> None:
    view = ActingRobotEnv(scenario=small_scenario(0), illegal_reward=-3.0, observation=form)
    view.reset()
    view.step(first := int(view.action_masks().argmax()))
    seen, reward, terminated, truncated, _ = view.step(first)
    assert (reward, terminated, truncated) == (-3.0, True, False)
    assert view.observation_space.contains(seen)
    with pytest.raises(ActionError, match=r"the episode is over.*call reset"):
        view.step(0)


def test_or_is_an_error() -> None:
    view = ActingRobotEnv(scenario=small_scenario(0), on_illegal="raise")
    view.reset()
    view.step(first := int(view.action_masks().argmax()))
    with pytest.raises(ActionError, match=f"sent action {first}"):
        view.step(first)
    view.step(int(view.action_masks().argmax()))  # nothing was changed


def test_or_stands_for_the_next_legal_one() -> None:
    view = ActingRobotEnv(scenario=small_scenario(0), on_illegal="replace")
    view.reset()
    over = False
    while not over:
        legal, robot = np.flatnonzero(view.action_masks()).tolist(), view.robot
        illegal = next((task for task in range(7, -1, -1) if task not in legal), legal[0])
        expected = next((task for task in legal if task >= illegal), legal[0])
        _, _, over, _, _ = view.step(illegal)
        assert view.mission.routes[robot][-1] == expected


@pytest.mark.parametrize("action", [8, -1, 1.5, None, True])
def test_actions_outside_the_space(action: object) -> None:
    view = ActingRobotEnv(scenario=small_scenario(0))
    view.reset()
    if action is True and not view.action_masks()[1]:
        pytest.skip("task 1 is masked here")
    with pytest.raises(ActionError, match="expected a whole number from 0 to 7"):
        view.step(action)


def test_a_mission_in_which_nothing_can_be_done() -> None:
    """Eq. 1: the one task counts as finished at its deadline, f/d = 1, so that the terminal reward is −1/1."""
    view = ActingRobotEnv(scenario=hopeless_scenario(2), reward="terminal")
    view.reset()
    assert view.action_masks().all()
    assert view.step(0)[1:4] == (-1.0, True, False)


def test_seeds_are_those_of_the_aec_form() -> None:
    env = ActingRobotEnv(generator=GENERATOR)
    assert str(env.reset(seed=np.int64(3))) == str(env.reset(seed=3))  # type: ignore[arg-type]
    for seed in (-1, 1.5, "a"):
        with pytest.raises(ConfigError, match="seed is"):
            env.reset(seed=seed)  # type: ignore[arg-type]


def test_before_the_first_reset() -> None:
    for ask in (lambda: ActingRobotEnv().step(0), ActingRobotEnv().action_masks):
        with pytest.raises(ActionError, match="call reset"):
            ask()


def test_options() -> None:
    with pytest.raises(ConfigError, match="staggered is True"):
        ActingRobotEnv(staggered=True)
    with pytest.raises(ConfigError, match="on_illegal"):
        ActingRobotEnv(on_illegal="ignore")
    with pytest.raises(ConfigError, match="there is no option 'mask'"):
        ActingRobotEnv(mask=1)


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_a_copy_goes_on_as_the_original_would(duplicate) -> None:
    view = ActingRobotEnv(generator=GENERATOR, observation="masked")
    view.reset(seed=3)
    view.step(int(view.action_masks().argmax()))
    twin = duplicate(view)
    action = int(view.action_masks().argmax())
    assert str(view.step(action)) == str(twin.step(action))
    assert str(view.reset()) == str(twin.reset())
