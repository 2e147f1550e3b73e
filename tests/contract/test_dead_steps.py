"""The wrapper that steps for agents that have terminated."""

from __future__ import annotations

import numpy as np
import pytest
from factories import GENERATOR, hopeless_scenario, mask_of, play, random_action

from mrta_zoo import mrta_v0
from mrta_zoo.env.dead_steps import SkipDeadSteps


def played(env: SkipDeadSteps, seed: int) -> tuple[list[tuple[str, int]], dict[str, float]]:
    """As `factories.play`, but every turn is a decision."""
    rng = np.random.default_rng(seed)
    decisions, returns = [], dict.fromkeys(env.agents, 0.0)
    for agent in env.agent_iter():
        observation, reward, terminated, truncated, info = env.last()
        assert not terminated
        assert not truncated
        returns[agent] += reward
        decisions.append((agent, random_action(mask_of(observation, info), rng)))
        env.step(decisions[-1][1])
    return decisions, {agent: returns[agent] + env.final_rewards[agent] for agent in returns}


@pytest.mark.parametrize("staggered", [False, True])
@pytest.mark.parametrize("form", ["dict", "flat"])
def test_same_decisions_and_returns(staggered: bool, form: str) -> None:
    options = {"generator": GENERATOR, "staggered": staggered, "observation": form, "reward": "individual"}
    plain, skipping = mrta_v0.env(**options), SkipDeadSteps(mrta_v0.env(**options))
    for seed in range(10):
        plain.reset(seed=seed)
        skipping.reset(seed=seed)
        expected_decisions, expected_returns = play(plain, seed)
        decisions, returns = played(skipping, seed)
        assert decisions == expected_decisions
        assert returns == pytest.approx(expected_returns)


def test_a_mission_that_ends_at_once() -> None:
    """No turn at all; the terminal reward is −1, see the test of the Gymnasium view."""
    env = SkipDeadSteps(mrta_v0.env(scenario=hopeless_scenario(2)))
    env.reset()
    assert list(env.agent_iter()) == []
    assert env.final_rewards == {"robot_0": -1.0, "robot_1": -1.0}
