"""Traces: what they refuse, what they replay, and plans as traces and back."""

from __future__ import annotations

import numpy as np
import pytest
from strategies import seeded_chooser, seeded_scenarios

from mrta_zoo.errors import ActionError, ConfigError, PlanError
from mrta_zoo.mission import Mission
from mrta_zoo.plan import Plan
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import Scenario
from mrta_zoo.trace import Choice, Trace, tightest_rule
from mrta_zoo.verify import verify

# Two robots at (0, 0) and (30, 0), three tasks on the x axis without work.
LINE = Scenario(
    task_xy=np.array([(10.0, 0.0), (20.0, 0.0), (30.0, 0.0)]),
    deadline=np.array([100.0, 100.0, 35.0]),
    workload=np.zeros(3),
    robot_xy=np.array([(0.0, 0.0), (30.0, 0.0)]),
    capacity=np.ones(2),
)


def test_time_and_robot_follow_from_the_choices() -> None:
    # Robot 0 is on task 0 until 10; robot 1 on task 2 until 0, then on task 1 until 10.
    trace = Trace(LINE, (Choice(0), Choice(2), Choice(1)))
    assert [(each.index, each.time, each.robot) for each in trace.decisions()] == [(0, 0, 0), (1, 0, 1), (2, 0, 1)]
    assert trace.plan() == Plan(((0,), (2, 1)), "scenario")
    assert trace.mission(2).routes == [[0], [2]]
    assert trace.mission(0).routes == [[], []]
    assert trace.mission().done


def test_a_robot_may_stay() -> None:
    trace = Trace(LINE, (Choice(None), Choice(2)))
    mission = trace.mission()
    assert (mission.actor, mission.retired) == (1, [True, False])
    assert trace.plan().routes == ((), (2,))
    mission.stay()
    assert mission.done
    with pytest.raises(ActionError, match="the mission is over"):
        mission.stay()


@pytest.mark.parametrize(
    ("choices", "message"),
    [
        ((Choice(0), Choice(0)), "decision 1: robot 1 may not choose task 0 at time 0: taken"),
        ((Choice(None), Choice(None), Choice(0)), "decision 2 comes after the end of the mission"),
        ((Choice(0, {5: 0.5}),), "decision 0 names task 5; tasks are numbered 0 to 2"),
        ((Choice(0, advice=-1),), "decision 0 names task -1"),
    ],
)
def test_a_trace_that_cannot_be(choices: tuple[Choice, ...], message: str) -> None:
    with pytest.raises(PlanError, match=message):
        Trace(LINE, choices)


def test_values_out_of_range() -> None:
    with pytest.raises(PlanError, match=r"task 1 is -0\.1; expected"):
        Choice(0, {1: -0.1})
    with pytest.raises(PlanError, match="the bookmark is 1; expected a number from 0 to 0"):
        Trace(LINE, (), bookmark=1)
    with pytest.raises(ConfigError, match="mask_rule is 'all'"):
        Trace(LINE, (), "all")  # type: ignore[arg-type]


@pytest.mark.parametrize("rule", ["feasible", "active", "unvisited"])
def test_any_plan_is_a_trace_and_back(rule: MaskRule) -> None:
    """Also one whose robots stop early: a random policy's routes, cut anywhere."""
    for seed, scenario in enumerate(seeded_scenarios(3, 60)):
        rng, choose, mission = np.random.default_rng(seed), seeded_chooser(seed), Mission(scenario, rule)
        while not mission.done:
            mission.assign(choose(mission.mask(mission.actor)))
        routes = [route[: rng.integers(len(route) + 1)] for route in mission.routes]
        plan = Plan(Plan.of(routes).routes, scenario.name, "some", 7)
        for trace in (Trace.of_plan(scenario, plan), Trace.of_plan(scenario, plan, rule)):
            assert trace.plan() == plan
            over, score = trace.mission(), verify(scenario, plan)
            assert over.done
            assert (over.completed(), over.time) == (score.completed, score.makespan)
            assert over.cost() == pytest.approx(score.cost)


def test_the_tightest_rule() -> None:
    # Task 2 last: robot 0 is at task 1 at 20, and at task 2 at 30 <= 35. Via task 0 and back it is late, but had left
    # before 35: 20 + 10 + 20 = 50. Via one more task it leaves at 40: 20 + 10 + 10.
    assert tightest_rule(LINE, Plan.of([[1, 2], []])) == "feasible"
    assert tightest_rule(LINE, Plan.of([[1, 0, 2], []])) == "active"
    away = Scenario(
        np.vstack((LINE.task_xy, (20.0, 0.0))), np.append(LINE.deadline, 100.0), np.zeros(4), LINE.robot_xy, np.ones(2)
    )
    assert tightest_rule(away, Plan.of([[1, 0, 3, 2], []])) == "unvisited"


def test_a_plan_that_the_rule_forbids() -> None:
    with pytest.raises(PlanError, match="mask rule 'feasible' leaves robot 0 nothing to choose where the plan goes on"):
        Trace.of_plan(LINE, Plan.of([[1, 0, 2], []]), "feasible")
    with pytest.raises(PlanError, match="has 1 route"):
        Trace.of_plan(LINE, Plan.of([[1]]))
