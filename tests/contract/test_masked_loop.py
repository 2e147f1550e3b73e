"""The ordinary loop of masked policies over a vector environment, which goes on through ends and resets."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import torch
from factories import FORMS, GENERATOR, hopeless_scenario, small_scenario
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from torch.distributions import Categorical

from mrta_zoo import mrta_v0
from mrta_zoo.env.gym_view import ActingRobotEnv


@pytest.mark.parametrize("autoreset", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
@pytest.mark.parametrize("where", ["observation", "info", "action_masks"])
@pytest.mark.parametrize("form", FORMS)
def test_masked_logits(form: str, where: str, autoreset: AutoresetMode) -> None:
    if form == "flat" and where == "observation":
        pytest.skip("a flat observation has no mask")
    torch.manual_seed(0)
    envs = SyncVectorEnv(
        [lambda: ActingRobotEnv(generator=GENERATOR, observation=form, reward="completion")] * 4,
        autoreset_mode=autoreset,
    )
    observations, infos = envs.reset(seed=0)
    ended = 0
    for _ in range(40):
        masks = {
            "observation": lambda: observations["action_mask"],  # noqa: B023  (called at once)
            "info": lambda: infos["action_mask"],  # noqa: B023
            "action_masks": lambda: np.stack(envs.call("action_masks")),
        }[where]()
        logits = torch.zeros(masks.shape).masked_fill(~torch.as_tensor(masks, dtype=torch.bool), -torch.inf)
        observations, _, terminated, _, infos = envs.step(Categorical(logits=logits).sample().numpy())
        ended += int(terminated.sum())
    assert ended >= 8


def masks_of(view: ActingRobotEnv, observation: Any, info: dict[str, Any]) -> list[list[int]]:
    masks = [info["action_mask"], view.action_masks()]
    if isinstance(observation, dict):
        masks.append(observation["action_mask"])
        assert view.observation_space.contains(observation)
    assert info["action_mask"].dtype == np.int8
    return [mask.tolist() for mask in masks]


@pytest.mark.parametrize("form", FORMS)
def test_where_the_mission_is_over_any_action_will_do(form: str) -> None:
    """After the end, where the next action only resets, and where nothing can be done from the start; padding, too."""
    view = ActingRobotEnv(scenario=small_scenario(0), max_tasks=10, observation=form)
    observation, info = view.reset()
    over = False
    while not over:
        masks = masks_of(view, observation, info)
        assert masks.count(masks[0]) == len(masks)
        assert sum(masks[0]) > 0
        assert masks[0][8:] == [0, 0]
        observation, _, over, _, info = view.step(masks[0].index(1))
    assert all(mask == [1] * 10 for mask in masks_of(view, observation, info))
    assert (info["mask_reason"] > 0).all()  # which still tells why nothing can be done
    nothing = ActingRobotEnv(scenario=hopeless_scenario(2), max_tasks=3, observation=form)
    assert all(mask == [1, 1, 1] for mask in masks_of(nothing, *nothing.reset()))


@pytest.mark.parametrize("form", FORMS)
def test_an_illegal_end_shows_what_could_have_been_chosen(form: str) -> None:
    view = ActingRobotEnv(scenario=small_scenario(0), observation=form)
    observation, info = view.reset()
    first = int(view.action_masks().argmax())
    view.step(first)
    observation, _, terminated, _, info = view.step(first)
    assert terminated
    masks = masks_of(view, observation, info)
    assert masks.count(masks[0]) == len(masks)
    assert sum(masks[0]) > 0
    assert masks[0][first] == 0


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("staggered", [False, True])
def test_in_the_parallel_form_there_is_always_an_action(form: str, staggered: bool) -> None:
    """The no-op, for agents that have terminated as for those under way; also after an illegal end."""
    for illegal in (False, True):
        env = mrta_v0.parallel_env(scenario=small_scenario(0), observation=form, staggered=staggered)
        env.reset()
        while env.agents:
            actions = {agent: int(env.mask(agent).argmax()) for agent in env.agents}
            if illegal:
                actions = dict.fromkeys(env.agents, env.noop)
            observations, _, terminations, _, infos = env.step(actions)
            for agent, over in terminations.items():
                masks = [infos[agent]["action_mask"], env.mask(agent)]
                masks += [] if form == "flat" else [observations[agent]["action_mask"]]
                assert all(mask.any() for mask in masks)
                if over:
                    assert all(mask.tolist() == [0] * 8 + [1] for mask in masks)
