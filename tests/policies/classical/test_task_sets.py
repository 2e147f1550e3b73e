"""The dynamic program against every order of every set of tasks, through the verifier."""

from __future__ import annotations

import math
from itertools import permutations

import numpy as np
import pytest
from strategies import seeded_scenarios

from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.exact.task_sets import TaskSets, task_sets
from mrta_zoo.policies.stop import TimeLimit
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify

Earliest = dict[frozenset[int], float]


def enumerated(scenario: Scenario, robot: int) -> Earliest:
    """Every set that the robot can complete, with its earliest finish, by trying every order."""
    earliest: Earliest = {}
    for size in range(1, scenario.num_tasks + 1):
        for route in permutations(range(scenario.num_tasks), size):
            finish = finish_of(scenario, robot, route)
            if finish is not None:
                earliest[frozenset(route)] = min(finish, earliest.get(frozenset(route), math.inf))
    return earliest


def finish_of(scenario: Scenario, robot: int, route: tuple[int, ...]) -> float | None:
    """When the robot is done, or None if it is late for a task."""
    routes = [()] * robot + [route] + [()] * (scenario.num_robots - robot - 1)
    score = verify(scenario, Plan.of(routes))
    return score.makespan if score.completed == len(route) else None


def found(sets: TaskSets, scenario: Scenario, robot: int) -> Earliest:
    """The same form; checks that no set is there twice."""
    earliest = {}
    for row in sets.routes.tolist():
        route = tuple(task for task in row if task >= 0)
        assert row == [*route, *[-1] * (len(row) - len(route))]
        finish = finish_of(scenario, robot, route)
        assert finish is not None
        assert frozenset(route) not in earliest
        earliest[frozenset(route)] = finish
    return earliest


def test_all_sets_each_in_its_best_order() -> None:
    counted = 0
    for scenario in seeded_scenarios(11, 150, max_tasks=5, max_robots=2):
        for robot in range(scenario.num_robots):
            want = enumerated(scenario, robot)
            sets = task_sets(scenario, robot, only_largest=False, max_states=10_000)
            assert sets.all_found
            assert found(sets, scenario, robot) == want  # bit for bit, ties with deadlines included
            largest = task_sets(scenario, robot, only_largest=True, max_states=10_000)
            # Every set is one of these or part of one; none of these is another one less a task.
            kept = found(largest, scenario, robot)
            assert kept.items() <= want.items()
            assert all(any(each <= large for large in kept) for each in want)
            assert not any(each < large and len(each) == len(large) - 1 for each in kept for large in kept)
            counted += len(want)
    assert counted > 800


def everything_feasible(tasks: int) -> Scenario:
    rng = np.random.default_rng(0)
    return Scenario(rng.random((tasks, 2)), np.full(tasks, 1e3), np.ones(tasks), [[0, 0]], [1.0], map_size=(1, 1))  # type: ignore[arg-type]


def test_numbers_of_sets() -> None:
    # 2^10 - 1 = 1023 sets that are not empty; the states are sum over k of k · C(10, k) = 10 · 2^9 = 5120.
    assert len(task_sets(everything_feasible(10), 0, only_largest=False, max_states=5120).routes) == 1023
    largest = task_sets(everything_feasible(10), 0, only_largest=True, max_states=5120)
    assert (largest.routes.shape, largest.all_found) == ((1, 10), True)


def test_cut_off_by_states_and_by_the_clock() -> None:
    # 10 + 10 · 9 + C(10, 3) · 3 = 10 + 90 + 360 = 460 states have up to 3 tasks.
    some = task_sets(everything_feasible(10), 0, only_largest=True, max_states=460)
    assert (some.routes.shape, some.all_found) == ((120, 3), False)
    none = task_sets(everything_feasible(10), 0, only_largest=True, max_states=5120, limit=TimeLimit.of(0.0))
    assert (none.routes.shape, none.all_found) == ((10, 1), False)
    assert not task_sets(everything_feasible(64), 0, only_largest=True, max_states=5120).all_found
    assert task_sets(everything_feasible(63), 0, only_largest=True, max_states=5000).routes.shape[1] == 2


@pytest.mark.parametrize("only_largest", [True, False])
def test_nothing_in_reach(only_largest: bool) -> None:
    far = Scenario([[1, 1]], [0.5], [0.0], [[0, 0]], [1.0], map_size=(1, 1))  # type: ignore[arg-type]
    sets = task_sets(far, 0, only_largest=only_largest, max_states=10)
    assert (len(sets.routes), sets.all_found) == (0, True)
