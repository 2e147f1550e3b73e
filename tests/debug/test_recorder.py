"""Recorded episodes are the plans that the methods make, with their probabilities."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from factories import small_scenario

from mrta_zoo.debug.advisors import PlanAdvisor, make_advisor
from mrta_zoo.debug.recorder import play, record
from mrta_zoo.env.observation import Observation
from mrta_zoo.errors import ConfigError, PlanError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.heuristics import RandomPolicy
from mrta_zoo.policies.pretrained import pretrained_names
from mrta_zoo.policies.registry import make_solver, method_names
from mrta_zoo.scenario import Scenario
from mrta_zoo.trace import Choice, Trace

SCENARIO = small_scenario(2, tasks=12, robots=3)


@pytest.mark.parametrize(
    ("name", "rule"),
    [*((name, None) for name in (*method_names(), "nearest+polish")), ("edf", "unvisited"), ("capam", "active")],
)
def test_every_method_is_recorded_as_it_plans(name: str, rule: Any) -> None:
    learned = name in pretrained_names()
    if learned:
        pytest.importorskip("torch")
    options: dict[str, Any] = {"seed": 3, "mask_rule": rule} | ({"budget": 0.2} if name == "pyvrp" else {})
    trace = record(SCENARIO, name, **options)
    if name != "pyvrp":  # which is cut off by the clock
        plan = make_solver(name, **options).solve(SCENARIO)
        assert trace.plan() == plan
    assert trace.mission().done
    assert trace.seed == 3
    assert all((choice.probabilities is not None) == learned for choice in trace.choices)


@pytest.mark.parametrize("decode", ["greedy", "sample", "augment", "beam"])
def test_a_learned_policy_shows_its_probabilities(decode: str) -> None:
    pytest.importorskip("torch")
    options: dict[str, Any] = {"decode": decode, "samples": 4}
    trace = record(SCENARIO, "capam-plus", **options)
    assert trace.plan() == make_solver("capam-plus", **options).solve(SCENARIO)
    assert trace.decode == decode
    for mission, decision in trace.steps():
        probabilities = decision.choice.probabilities
        assert probabilities is not None
        assert sum(probabilities.values()) == pytest.approx(1, abs=0.01)
        assert mission.mask(decision.robot)[list(probabilities)].all()
        assert list(probabilities.values()) == sorted(probabilities.values(), reverse=True)
        assert decode != "greedy" or decision.choice.task == next(iter(probabilities))


def test_a_policy_that_samples_is_recorded_as_it_acts() -> None:
    pytest.importorskip("torch")
    from mrta_zoo.policies.aec_loop import run_in_environment
    from mrta_zoo.policies.neural.policy import load_policy

    trace = record(SCENARIO, load_policy("capam", decode="sample", seed=4))
    assert trace == record(SCENARIO, load_policy("capam", decode="sample", seed=4))
    played = run_in_environment(load_policy("capam", decode="sample", seed=4), SCENARIO)
    assert trace.plan().routes == played.routes
    assert any(choice.task != next(iter(choice.probabilities or ())) for choice in trace.choices)


def test_a_policy_of_ones_own_is_not_touched() -> None:
    policy = RandomPolicy(5)
    assert record(SCENARIO, policy) == record(SCENARIO, policy)
    assert record(SCENARIO, policy).plan().routes == make_solver("random", seed=5).solve(SCENARIO).routes


def test_choices_made_for_a_method_are_kept_with_its_advice() -> None:
    free = record(SCENARIO, "nearest")
    (legal,) = np.nonzero(free.mission(0).mask(0))
    other = next(int(task) for task in legal if task != free.choices[0].task)
    forced = play(SCENARIO, make_advisor(SCENARIO, "nearest"), (Choice(other),))
    assert forced.choices[0] == Choice(other, advice=free.choices[0].task)
    assert all(choice.advice is None for choice in forced.choices[1:])
    assert play(SCENARIO, make_advisor(SCENARIO, "nearest"), free.choices[:5]) == free


def test_a_plan_that_has_been_left_advises_what_can_still_be_done() -> None:
    # Places 0 to 4 on the x axis, robots at 0 and 4: robot 0 snatches task 1, which was robot 1's second. There it is
    # at 3, then back at task 0 at 5; robot 1 does task 2 at 1 and passes task 1 over for task 3, at 3.
    scenario = Scenario(
        [[1, 0], [3, 0], [3, 0], [1, 0]], [9.0] * 4, [0.0] * 4, [[0, 0], [4, 0]], [1.0] * 2, map_size=(4, 4)
    )  # type: ignore[arg-type]
    trace = play(scenario, PlanAdvisor(scenario, Plan(((0,), (2, 1, 3)))), (Choice(1),))
    assert [(each.time, each.robot, each.choice.task) for each in trace.decisions()] == [
        (0, 0, 1), (0, 1, 2), (1, 1, 3), (3, 0, 0),
    ]  # fmt: skip


def test_what_cannot_be_recorded() -> None:
    with pytest.raises(ConfigError, match="there is no method 'nearst'"):
        record(SCENARIO, "nearst")
    with pytest.raises(PlanError, match="has 1 route"):
        record(SCENARIO, Plan(((0,),)))

    class Illegal:
        def act(self, observation: Observation, agent: str) -> int:
            return int(observation["action_mask"].argmin())  # the first that is masked

    with pytest.raises(PlanError, match="decision 0: robot 0 may not choose task 0 at time 0"):
        record(small_scenario(1, tasks=60, latest=12.0), Illegal())


def test_a_recorded_trace_is_its_plans_trace() -> None:
    trace = record(SCENARIO, "edf")
    assert Trace.of_plan(SCENARIO, trace.plan()).decisions() == trace.decisions()
