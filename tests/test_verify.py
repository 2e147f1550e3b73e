"""The verifier against arithmetic done by hand, and its errors."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest
from factories import named_scenario

from mrta_zoo.errors import PlanError
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import Score, Visit, verify

# Robot 0 starts in (0, 0) with capacity 2 and speed 1, robot 1 in (6, 8) with capacity 1 and speed 5.
SCENARIO = Scenario(
    task_xy=np.array([[3, 4], [6, 8], [6, 4], [60, 80]]),
    deadline=np.array([7, 10, 4, 40]),
    workload=np.array([4, 6, 1, 2]),
    robot_xy=np.array([[0, 0], [6, 8]]),
    capacity=np.array([2.0, 1.0]),
    speed=np.array([1.0, 5.0]),
    name="four",
)


def test_every_score_by_hand() -> None:
    # Robot 0: task 0 is 5 away: there at 5, finished at 5 + 4/2 = 7 = its deadline.
    #          task 1 is 5 away: there at 12, finished at 12 + 6/2 = 15, late for 10.
    # Robot 1: task 2 is 4 away: there at 4/5 = 0.8, finished at 0.8 + 1/1 = 1.8, by its deadline 4.
    # Task 3 is left: max(15, 40) / 40 = 1.
    assert verify(SCENARIO, Plan.of([[0, 1], [2]])) == Score(
        tasks=4,
        completed=2,
        completion=0.5,
        cost=15 / 10 + 1,
        distance=5 + 5 + 4,
        makespan=15.0,
        schedule=(
            (Visit(0, 5.0, 7.0, 7.0, True), Visit(1, 12.0, 15.0, 10.0, False)),
            (Visit(2, 0.8, 1.8, 4.0, True),),
        ),
    )


def test_a_task_nobody_took_counts_at_the_end_or_at_its_deadline() -> None:
    # Robot 0 does only task 1: 10 away, finished at 10 + 6/2 = 13, late: 13 / 10.
    # Left: deadlines 7 and 4 lie before the end: 13/7, 13/4; deadline 40 lies after it: exactly 1.
    score = verify(SCENARIO, Plan.of([[1], []]))
    assert score.cost == math.fsum([13 / 7, 13 / 10, 13 / 4, 1.0])
    assert (score.completed, score.completion, score.distance, score.makespan) == (0, 0.0, 10.0, 13.0)


def test_the_empty_plan_costs_one_for_each_task() -> None:
    assert verify(SCENARIO, Plan.of([[], []])) == Score(4, 0, 0.0, 4.0, 0.0, 0.0, ((), ()))


def test_zero_distance() -> None:
    # Robot 1 starts at task 1: there at 0, finished at 0 + 6/1 = 6, by its deadline 10.
    score = verify(SCENARIO, Plan.of([[], [1]]))
    assert score.schedule == ((), (Visit(1, 0.0, 6.0, 10.0, True),))
    assert score.distance == 0.0


def test_one_bit_decides() -> None:
    def completed(deadline: float) -> int:
        one = Scenario([[3, 4]], [deadline], [2], [[0, 0]], [1])  # type: ignore[arg-type]
        return verify(one, Plan.of([[0]])).completed  # 5 + 2 = 7

    assert completed(7.0) == 1
    assert completed(math.nextafter(7.0, 0.0)) == 0


def test_order_matters() -> None:
    # Task 2 first: 5² + 4² … from (6, 4) task 0 is 3 away.
    score = verify(SCENARIO, Plan.of([[], [2, 0]]))
    first, second = score.schedule[1]
    assert (first.task, second.task) == (2, 0)
    assert second.arrival == first.finish + 3 / 5
    assert second.finish == first.finish + 3 / 5 + 4 / 1


def test_integers_of_any_kind_are_tasks() -> None:
    plan: Any = Plan((np.array([0, 1]), [np.int32(2)]))
    assert verify(SCENARIO, plan) == verify(SCENARIO, Plan.of([[0, 1], [2]]))
    assert type(verify(SCENARIO, plan).schedule[0][0].task) is int


@pytest.mark.parametrize(
    ("routes", "message"),
    [
        (
            ((0,),),
            "the plan has 1 route, but scenario 'four' has 2 robots; every robot needs one, empty "
            "if it stays where it is",
        ),
        (
            ((), (), ()),
            "the plan has 3 routes, but scenario 'four' has 2 robots; every robot needs one, empty "
            "if it stays where it is",
        ),
        (
            ((0, 4), ()),
            "position 1 of robot 0's route names task 4; the tasks of scenario 'four' are numbered 0 to 3",
        ),
        (
            ((), (-1,)),
            "position 0 of robot 1's route names task -1; the tasks of scenario 'four' are numbered 0 to 3",
        ),
        (
            ((0, 2), (1, 2)),
            "task 2 is taken twice, at position 1 of robot 0's route and at position 1 of robot 1's route",
        ),
        (
            ((3, 1, 3), ()),
            "task 3 is taken twice, at position 0 of robot 0's route and at position 2 of robot 0's route",
        ),
        (((1.0,), ()), "position 0 of robot 0's route is 1.0; expected the number of a task, an integer"),
        (((), (0, "1")), "position 1 of robot 1's route is '1'; expected the number of a task, an integer"),
        (((None,), ()), "position 0 of robot 0's route is None; expected the number of a task, an integer"),
        (((True,), ()), "position 0 of robot 0's route is True; expected the number of a task, an integer"),
    ],
)
def test_errors(routes: Any, message: str) -> None:
    with pytest.raises(PlanError, match=f"^{re.escape(message)}$"):
        verify(SCENARIO, Plan(routes))


def test_messages_have_numbers_and_names() -> None:
    named = named_scenario()
    for routes, message in (
        ([[0], [0]], r"^task 0 \(valve-A\) is taken twice, at position 0 of robot 0 \(Ann\)'s route and at position 0"),
        ([[], [7]], r"^position 0 of robot 1 \(Bob & Co\)'s route names task 7; "),
    ):
        with pytest.raises(PlanError, match=message):
            verify(named, Plan.of(routes))
