"""The policies that ship with the package: whole, documented, and worth having."""

from __future__ import annotations

import numpy as np
import pytest

from mrta_zoo.mission import Mission
from mrta_zoo.policies.aec_loop import run_in_environment
from mrta_zoo.policies.classical.heuristics import NearestPolicy
from mrta_zoo.policies.neural.policy import load_policy
from mrta_zoo.policies.pretrained import pretrained_names, pretrained_path
from mrta_zoo.scenario import Scenario
from mrta_zoo.suite import builtin_suite
from mrta_zoo.verify import verify

NAMES = pretrained_names()


def completed(scenario: Scenario, routes: tuple[tuple[int, ...], ...]) -> int:
    """Tasks completed when robots follow these routes, by the dynamics."""
    mission, left = Mission(scenario), [list(route) for route in routes]
    while not mission.done:
        mission.assign(left[mission.actor].pop(0))
    return mission.completed()


def test_capam_ships() -> None:
    assert {"capam", "capam-plus"} <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_comes_with_a_model_card(name: str) -> None:
    card = pretrained_path(name).with_suffix(".md").read_text(encoding="utf-8")
    trained = load_policy(name).info.trained
    assert f"{trained['episodes']:,}" in card
    assert "mrta-zoo train --preset" in card


@pytest.mark.parametrize("name", NAMES)
def test_completes_more_than_nearest_feasible(name: str) -> None:
    suite = builtin_suite()[::5]  # of every group, share and number of robots
    plans = load_policy(name).solve_batch(suite)
    own = [verify(scenario, plan) for scenario, plan in zip(suite, plans, strict=True)]
    nearest = [verify(scenario, run_in_environment(NearestPolicy(), scenario)) for scenario in suite]
    assert np.mean([score.completion for score in own]) > np.mean([score.completion for score in nearest])
    assert [score.completed for score in own] == [
        completed(scenario, plan.routes) for scenario, plan in zip(suite, plans, strict=True)
    ]


@pytest.mark.parametrize("name", NAMES)
def test_decides_in_the_environment_as_in_the_batch(name: str) -> None:
    policy = load_policy(name)
    for scenario in builtin_suite()[5::31]:
        assert run_in_environment(policy, scenario).routes == policy.solve(scenario).routes
