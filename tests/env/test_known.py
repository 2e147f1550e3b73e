"""What a robot does not know of, it neither sees nor may choose, in any form, nor is it advised to."""

from __future__ import annotations

import copy

import numpy as np
import pytest
from factories import small_scenario

from mrta_zoo import mrta_v0
from mrta_zoo.debug.advisors import make_advisor
from mrta_zoo.debug.outlook import outlook
from mrta_zoo.env.observation import TASK_FEATURES, Observer
from mrta_zoo.errors import ActionError
from mrta_zoo.mission import Mission
from mrta_zoo.policies.classical.heuristics import NearestPolicy
from mrta_zoo.rules import MaskReason, Status

SCENARIO = small_scenario(0)
HIDDEN = np.arange(SCENARIO.num_tasks) % 2 == 0
MISSED = TASK_FEATURES.index("active") + Status.MISSED


@pytest.fixture(autouse=True)
def _half_is_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    def known(mission: Mission, robot: int) -> Mission:
        less = copy.copy(mission)
        less.reasons, less.status = mission.reasons.copy(), mission.status.copy()
        less.reasons[:, HIDDEN], less.status[HIDDEN] = MaskReason.RULED_OUT, Status.MISSED
        return less

    monkeypatch.setattr(Mission, "known", known)


def check_observation(observation: dict[str, np.ndarray]) -> None:  # type: ignore[type-arg]
    """Only what is known is there to do."""
    assert (observation["tasks"][: len(HIDDEN), MISSED] == HIDDEN).all()


def test_agents_in_turn() -> None:
    env = mrta_v0.raw_env(scenario=SCENARIO)
    env.reset()
    while not all(env.terminations.values()):
        for agent in env.agents:
            seen, info = env.observe(agent), env.infos[agent]
            check_observation(seen["observation"])
            for mask in (env.mask(agent), seen["action_mask"], info["action_mask"]):
                assert not mask[: len(HIDDEN)][HIDDEN].any()
            assert (info["mask_reason"][: len(HIDDEN)][HIDDEN] == MaskReason.RULED_OUT).all()
        mask = env.mask(env.agent_selection)
        assert mask.any()
        env.step(int(mask.argmax()))
    assert (env.unwrapped.mission.taken_by[HIDDEN] < 0).all()
    assert (env.unwrapped.mission.taken_by[~HIDDEN] >= 0).any()


def test_agents_at_once() -> None:
    env = mrta_v0.parallel_env(scenario=SCENARIO)
    observations, infos = env.reset()
    while env.agents:
        for agent in env.agents:
            check_observation(observations[agent]["observation"])
            for mask in (env.mask(agent), observations[agent]["action_mask"], infos[agent]["action_mask"]):
                assert not mask[: len(HIDDEN)][HIDDEN].any()
            assert (infos[agent]["mask_reason"][: len(HIDDEN)][HIDDEN] == MaskReason.RULED_OUT).all()
        observations, _, _, _, infos = env.step({agent: int(env.mask(agent).argmax()) for agent in env.agents})


def test_advice() -> None:
    mission = Mission(SCENARIO)
    for method in ("nearest", "big-mrta"):
        choice, _ = (advisor := make_advisor(SCENARIO, method)).advise(mission, advisor.begin())
        assert choice.task is not None
        assert not HIDDEN[choice.task]
    seen = Observer(SCENARIO, SCENARIO.num_tasks, SCENARIO.num_robots).observe(mission, mission.actor)
    check_observation(seen["observation"])
    assert not HIDDEN[NearestPolicy().act(seen)]
    assert [each.reason == MaskReason.RULED_OUT for each in outlook(mission, 0)] == HIDDEN.tolist()


def test_what_is_not_known_cannot_be_taken() -> None:
    with pytest.raises(ActionError, match=r"may not choose task 0 .*: ruled out"):
        Mission(SCENARIO).assign(0)
