"""Plans followed through the environment."""

from __future__ import annotations

import numpy as np
import pytest
from strategies import seeded_scenarios

from mrta_zoo import mrta_v0
from mrta_zoo.errors import PlanError
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.plan import Plan
from mrta_zoo.policies.aec_loop import run_in_environment
from mrta_zoo.policies.classical.heuristics import NearestPolicy, RandomPolicy
from mrta_zoo.policies.plan_policy import PlanPolicy
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify

# One robot at (0, 0), three tasks on the x axis, all feasible at the start.
LINE = Scenario(
    task_xy=np.array([(10.0, 0.0), (20.0, 0.0), (30.0, 0.0)]),
    deadline=np.array([100.0, 100.0, 35.0]),
    workload=np.zeros(3),
    robot_xy=np.zeros((1, 2)),
    capacity=np.ones(1),
)


@pytest.mark.parametrize("rule", ["feasible", "active", "unvisited"])
def test_a_policys_plan_can_be_followed_exactly_under_its_rule(rule: str) -> None:
    for scenario in seeded_scenarios(11, 80):
        plan = run_in_environment(RandomPolicy(7), scenario, rule)  # type: ignore[arg-type]
        again = run_in_environment(PlanPolicy(plan), scenario, rule)  # type: ignore[arg-type]
        assert again.routes == plan.routes


def test_in_the_parallel_form_it_takes_the_no_op_where_that_is_all_it_may() -> None:
    # Both choose at 0; robot 0 is free again at 10, when robot 1 is still under way, to 15.
    scenario = Scenario(
        task_xy=np.array([(10.0, 0.0), (20.0, 0.0), (85.0, 0.0), (50.0, 0.0)]),
        deadline=np.full(4, 1000.0),
        workload=np.zeros(4),
        robot_xy=np.array([(0.0, 0.0), (100.0, 0.0)]),
        capacity=np.ones(2),
    )
    env, policy = mrta_v0.parallel_env(scenario=scenario, on_illegal="raise"), PlanPolicy(Plan.of([[0, 1], [2, 3]]))
    seen, _ = env.reset()
    sent = []
    while env.agents:
        actions = {agent: policy.act(seen[agent], agent) for agent in env.agents}
        sent.append(list(actions.values()))
        seen, *_ = env.step(actions)
    assert sent == [[0, 2], [1, 4], [4, 3]]


def test_a_route_that_ends_early_is_an_error() -> None:
    # After task 0 at time 10 both others can still be finished in time.
    with pytest.raises(PlanError, match="route for robot 0 is at its end, but the robot may still choose 2 tasks"):
        run_in_environment(PlanPolicy(Plan.of([[0]])), LINE)


def test_a_task_that_it_may_not_take_is_an_error() -> None:
    # Task 2 at 30, task 1 at 40, and now task 2 again, while task 0 could be done.
    with pytest.raises(PlanError, match="sends robot 0 to task 2, which it may not choose now"):
        run_in_environment(PlanPolicy(Plan.of([[2, 1, 2]])), LINE)


def test_a_late_task_is_an_error_while_others_can_be_done() -> None:
    # Task 1 at 20, then task 0 at 30, where task 2 (at 50 > 35) is all that is left: the mission ends.
    assert run_in_environment(PlanPolicy(Plan.of([[1, 0, 2]])), LINE).routes == ((1, 0),)
    # Turning around at 20 + 4 for a fourth task makes task 2 late, at 38 > 35, while task 0 can be done.
    place = np.vstack((LINE.task_xy, (16.0, 0.0)))
    scenario = Scenario(place, np.append(LINE.deadline, 100.0), np.zeros(4), LINE.robot_xy, LINE.capacity)
    plan = Plan.of([[1, 3, 2, 0]])
    with pytest.raises(PlanError, match="sends robot 0 to task 2, which it may not choose now"):
        run_in_environment(PlanPolicy(plan), scenario)
    assert run_in_environment(PlanPolicy(plan), scenario, "unvisited").routes == plan.routes


def test_a_guide_passes_over_late_tasks_and_goes_on_at_the_end() -> None:
    # Route 1, 0, then 2 would be late and is passed over; nothing else is left.
    late = PlanPolicy(Plan.of([[1, 0, 2]]), then=NearestPolicy())
    assert run_in_environment(late, LINE).routes == ((1, 0),)
    # Task 0 at 10, then the nearest: task 1 at 20, task 2 at 30 <= 35.
    short = PlanPolicy(Plan.of([[0]]), then=NearestPolicy())
    assert run_in_environment(short, LINE).routes == ((0, 1, 2),)


def test_a_guided_mission_completes_what_the_plan_completes() -> None:
    for seed in range(30):
        rng = np.random.default_rng(seed)
        scenario = UniformGenerator(tasks=(20, 20), robots=(3, 3), deadline=(20, 200))(rng)
        tasks = rng.permutation(20)[:15]
        plan = Plan.of([tasks[:5].tolist(), tasks[5:10].tolist(), tasks[10:].tolist()])
        planned = {visit.task for visits in verify(scenario, plan).schedule for visit in visits if visit.completed}
        guided = run_in_environment(PlanPolicy(plan, then=NearestPolicy()), scenario)
        done = {visit.task for visits in verify(scenario, guided).schedule for visit in visits if visit.completed}
        assert planned <= done


def test_reset_starts_over() -> None:
    policy = PlanPolicy(Plan.of([[0, 1, 2]]))
    first = run_in_environment(policy, LINE)
    policy.reset()
    assert run_in_environment(policy, LINE) == first


def test_a_robot_without_a_route_is_an_error() -> None:
    with pytest.raises(PlanError, match="the plan has 0 routes, none for robot 0"):
        run_in_environment(PlanPolicy(Plan(())), LINE)
