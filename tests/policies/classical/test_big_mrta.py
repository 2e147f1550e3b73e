"""BiG-MRTA, by hand on small missions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from strategies import seeded_scenarios

pytest.importorskip("scipy")

from real_cases import REAL, needs_real_cases

from mrta_zoo.io import read_cases
from mrta_zoo.policies.classical.big_mrta import BigMrtaSolver
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify


def line(tasks: list[float], deadlines: list[float], robots: list[float], speed: list[float] | None = None) -> Scenario:
    """Everything on a line, no workloads: a robot of speed 1 finishes after as much time as it travels distance."""
    return Scenario(
        task_xy=[[x, 0.0] for x in tasks],  # type: ignore[arg-type]
        deadline=np.array(deadlines),
        workload=np.zeros(len(tasks)),
        robot_xy=[[x, 0.0] for x in robots],  # type: ignore[arg-type]
        capacity=np.ones(len(robots)),
        speed=np.array(speed or [1.0] * len(robots)),
    )


def test_the_matching_is_for_the_team_not_for_the_robot() -> None:
    # Robot 0 at 50 is nearest to task 0 (10 away; task 1 is 20 away). But robot 1 at 90 is in time for task 0
    # (30 <= 32) and not for task 1 (60 > 25). With T = 1.1 · 32 = 35.2 the matching 0-1, 1-0 weighs
    # exp(-20/35.2) + exp(-30/35.2) = 0.57 + 0.43 = 1.00, 0-0 alone exp(-10/35.2) = 0.75.
    scenario = line([60, 30], [32, 25], [50, 90])
    assert BigMrtaSolver().solve(scenario).routes == ((1,), (0,))
    # Nearest feasible has robot 0 take task 0; it then is 10 + 30 = 40 > 25 late for task 1.
    assert make_solver("nearest").solve(scenario).routes == ((0,), ())


def test_the_sum_of_weights_decides_not_the_greatest() -> None:
    # T = 1.1 · 100 = 110. Robots at 50 and 80, tasks at 60 and 30.
    # 0-0 and 1-1: exp(-10/110) + exp(-50/110) = 0.9131 + 0.6347 = 1.5478
    # 0-1 and 1-0: exp(-20/110) + exp(-20/110) = 0.8338 + 0.8338 = 1.6675
    assert math.exp(-10 / 110) + math.exp(-50 / 110) < 2 * math.exp(-20 / 110)
    assert BigMrtaSolver().solve(line([60, 30], [100, 100], [50, 80])).routes == ((1,), (0,))


def test_busy_robots_count_from_where_and_when_they_get_free() -> None:
    # Robot 0 at 50 takes task 0 at 51 (f = 1), robot 1 at 70 task 1 at 60 (f = 10). At 1, robot 0 could do task 2 at
    # 55 (f = 1 + 4 = 5) or task 3 at 45 (f = 1 + 6 = 7). Robot 1, at 60 from 10, will be in time for task 2
    # (10 + 5 = 15 <= 15), not for task 3 (25 > 7). T = 16.5: 0-3, 1-2 weighs 0.65 + 0.40 = 1.06, 0-2 alone 0.74.
    scenario = line([51, 60, 55, 45], [1, 11, 15, 7], [50, 70])
    assert BigMrtaSolver().solve(scenario).routes == ((0, 3), (1, 2))
    assert make_solver("nearest").solve(scenario).routes == ((0, 2), (1,))


def test_a_robot_that_is_left_out_takes_the_match_that_costs_the_others_least() -> None:
    # T = 110. Robot 1 stands on task 0 at 50 (weight 1), robot 2 at 20 is matched to task 1 at 29 (exp(-9/110) = 0.92).
    # Robot 0 at 40 is left out, but cannot wait: with task 0 (10 away) 0.913 + 0.92 is left, with task 1 (11 away)
    # 0.905 + 1, which is more. Robot 1 then takes task 0.
    scenario = line([50, 29], [100, 100], [40, 50, 20])
    assert BigMrtaSolver().solve(scenario).routes == ((1,), (0,), ())


def test_speeds_and_workloads_count() -> None:
    # Robot 0 is ten times as fast: it is at task 0 (20 away) at 2 and robot 1 at 20.
    assert BigMrtaSolver().solve(line([50], [60], [30, 70], speed=[10, 1])).routes == ((0,), ())
    # A deadline met exactly counts: 20 <= 20.
    assert BigMrtaSolver().solve(line([50], [20], [30])).routes == ((0,),)
    assert BigMrtaSolver().solve(line([50], [19.999], [30])).routes == ((),)


@pytest.mark.parametrize("scale", [1e-10, 1e-3, 1e9])
def test_units_do_not_matter(scale: float) -> None:
    rng = np.random.default_rng(0)
    for _ in range(10):
        tasks, deadline, robots = rng.random((12, 2)) * 100, rng.uniform(20, 150, 12), rng.random((3, 2)) * 100
        work, capacity = rng.uniform(0, 20, 12), rng.uniform(1, 2, 3)
        here = Scenario(tasks, deadline, work, robots, capacity)
        there = Scenario(
            tasks * scale, deadline * scale, work * scale, robots * scale, capacity, map_size=(100 * scale, 100 * scale)
        )
        assert BigMrtaSolver().solve(here).routes == BigMrtaSolver().solve(there).routes


def test_what_is_planned_is_in_time_and_nothing_feasible_is_left() -> None:
    for scenario in seeded_scenarios(8, 300):
        plan = BigMrtaSolver().solve(scenario)
        score = verify(scenario, plan)
        assert score.completed == sum(map(len, plan.routes))
        nearest = verify(scenario, make_solver("nearest").solve(scenario))
        assert (score.completed > 0) == (nearest.completed > 0)


@needs_real_cases
def test_as_many_tasks_as_nearest_on_real_cases() -> None:
    cases = read_cases(REAL / "n100")[::8]
    means = [
        np.mean([verify(case.scenario, solver.solve(case.scenario)).completed for case in cases])
        for solver in (make_solver("big-mrta"), make_solver("nearest"))
    ]
    assert means[0] >= means[1]
