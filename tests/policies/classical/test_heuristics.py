"""The heuristics, by hand on small missions and against published figures on real cases."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from real_cases import REAL, needs_real_cases
from strategies import seeded_scenarios

from mrta_zoo.env.observation import Observation, Observer
from mrta_zoo.errors import ActionError
from mrta_zoo.io import read_cases
from mrta_zoo.mission import Mission
from mrta_zoo.plan import Plan
from mrta_zoo.policies.aec_loop import run_in_environment
from mrta_zoo.policies.classical.heuristics import EarliestDeadlinePolicy, NearestPolicy, RandomPolicy
from mrta_zoo.policies.plan_policy import PlanPolicy
from mrta_zoo.policies.protocol import Policy
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify


def scenario_of(
    places: list[tuple[float, float]], deadlines: list[float], robots: list[tuple[float, float]]
) -> Scenario:
    """No workloads, capacity and speed 1: a robot finishes after as much time as it travels distance."""
    return Scenario(
        task_xy=np.array(places, dtype=float),
        deadline=np.array(deadlines, dtype=float),
        workload=np.zeros(len(places)),
        robot_xy=np.array(robots, dtype=float),
        capacity=np.ones(len(robots)),
    )


def first_look(scenario: Scenario) -> Observation:
    """What robot 0 sees at the start."""
    return Observer(scenario, scenario.num_tasks, scenario.num_robots).observe(Mission(scenario), 0)


def test_nearest_takes_the_nearest_of_the_feasible() -> None:
    # From (0, 0) the distances are 50, 5, 13; task 1 has to be done by 4 < 5, so it is not feasible.
    scenario = scenario_of([(30, 40), (3, 4), (5, 12)], [100, 4, 100], [(0, 0)])
    assert NearestPolicy().act(first_look(scenario)) == 2
    # It goes to task 2 and from there, over sqrt(25² + 28²) = 37.5, to task 0.
    assert run_in_environment(NearestPolicy(), scenario).routes == ((2, 0),)


def test_nearest_breaks_ties_by_index_although_observations_are_rounded() -> None:
    # All at distance 5 from (50.1, 50.1), and not exactly so in float32.
    places = [(53.1, 54.1), (50.1, 55.1), (46.1, 53.1), (45.1, 50.1), (54.1, 47.1)]
    for first in range(len(places)):
        rotated = places[first:] + places[:first]
        assert NearestPolicy().act(first_look(scenario_of(rotated, [100] * 5, [(50.1, 50.1)]))) == 0


def test_nearest_tells_apart_what_is_not_a_tie() -> None:
    # 99 against 98.999: the difference is 1e-5 of the map.
    assert NearestPolicy().act(first_look(scenario_of([(99, 0), (98.999, 0)], [200, 200], [(0, 0)]))) == 1


def test_earliest_deadline_breaks_ties_by_distance_then_index() -> None:
    # Deadline 60 is the earliest; of tasks 1, 2, 3 that have it, 2 and 3 are nearest, both at distance 10.
    scenario = scenario_of([(1, 0), (20, 0), (10, 0), (0, 10)], [90, 60, 60, 60], [(0, 0)])
    assert EarliestDeadlinePolicy().act(first_look(scenario)) == 2


def test_random_draws_every_feasible_task_and_no_other() -> None:
    # Task 1 is 50 away and due at 40.
    observation = first_look(scenario_of([(1, 0), (50, 0), (2, 0), (3, 0)], [40] * 4, [(0, 0)]))
    policy = RandomPolicy(seed=1)
    counts = np.bincount([policy.act(observation) for _ in range(600)], minlength=4)
    assert counts[1] == 0
    assert (counts[[0, 2, 3]] > 150).all()


def test_random_is_fixed_by_its_seed() -> None:
    scenario = seeded_scenarios(3, 1, max_tasks=12)[0]
    plans = [run_in_environment(RandomPolicy(seed), scenario, "unvisited") for seed in (1, 1, 2, 3, 4)]
    assert plans[0] == plans[1]
    assert any(plan != plans[0] for plan in plans[2:])


@pytest.mark.parametrize("policy", [RandomPolicy(), NearestPolicy(), EarliestDeadlinePolicy()])
def test_nothing_to_choose_is_an_error_that_names_the_agent(policy: Policy) -> None:
    observation = first_look(scenario_of([(50, 0)], [10], [(0, 0)]))
    with pytest.raises(ActionError, match="robot_0 has nothing to choose"):
        policy.act(observation, "robot_0")


def test_the_aec_loop_names_who_chose_what_it_may_not() -> None:
    class Stubborn:
        def act(self, observation: Observation, agent: str) -> int:
            return 1

    scenario = scenario_of([(1, 0), (50, 0)], [40, 40], [(0, 0)])
    with pytest.raises(ActionError, match=r"robot_0 sent action 1: .*too late; its choices are 0"):
        run_in_environment(Stubborn(), scenario)


@pytest.mark.parametrize("task", [None, 1.5, 0.0, -1, 2])
def test_the_aec_loop_names_who_chose_no_task(task: Any) -> None:
    class Odd:
        def act(self, observation: Observation, agent: str) -> int:
            return task  # type: ignore[no-any-return]

    scenario = scenario_of([(1, 0), (50, 0)], [400, 400], [(0, 0)])
    sentence = f"robot_0 sent action {task!r}; expected a whole number from 0 to 1"
    with pytest.raises(ActionError, match=sentence):
        run_in_environment(Odd(), scenario)
    with pytest.raises(ActionError, match=sentence):
        run_in_environment(PlanPolicy(Plan.of([[]]), then=Odd()), scenario)


@pytest.mark.parametrize("kind", [np.int64, np.array])
def test_policies_may_choose_by_numbers_of_numpy(kind: Any) -> None:
    class First:
        def act(self, observation: Observation, agent: str) -> int:
            return kind(observation["action_mask"].argmax())  # type: ignore[no-any-return]

    plan = run_in_environment(First(), scenario_of([(1, 0), (50, 0)], [400, 400], [(0, 0)]))
    assert plan.routes == ((0, 1),)
    assert all(type(task) is int for task in plan.routes[0])


def test_a_policy_has_the_form_of_observation_that_it_asks_for() -> None:
    """The random policy looks at the mask alone: the same draws, whatever else it is shown."""
    for scenario in seeded_scenarios(seed=0, count=5):
        tables = run_in_environment(RandomPolicy(1), scenario)
        assert run_in_environment(RandomPolicy(1), scenario, observation="masked").routes == tables.routes


@pytest.mark.parametrize("rule", ["feasible", "active", "unvisited"])
def test_plans_agree_with_a_loop_on_the_bare_mission(rule: str) -> None:
    for scenario in seeded_scenarios(5, 60):
        mission = Mission(scenario, rule)  # type: ignore[arg-type]
        observer = Observer(scenario, scenario.num_tasks, scenario.num_robots, rule)  # type: ignore[arg-type]
        while not mission.done:
            mission.assign(NearestPolicy().act(observer.observe(mission, mission.actor)))
        plan = run_in_environment(NearestPolicy(), scenario, rule, "nearest")  # type: ignore[arg-type]
        assert [list(route) for route in plan.routes] == mission.routes
        assert (plan.scenario, plan.method) == (scenario.name, "nearest")


@needs_real_cases
@pytest.mark.parametrize("folder", ["n100", "n200"])
def test_nearest_reproduces_the_reference_on_every_real_case(folder: str) -> None:
    cases = read_cases(REAL / folder)
    assert len(cases) == 32
    for case in cases:
        plan = run_in_environment(NearestPolicy(), case.scenario)
        assert verify(case.scenario, plan).completed == case.reference["nearest"], case.name
