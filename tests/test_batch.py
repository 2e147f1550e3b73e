"""The batched simulator: padding, errors and bookkeeping. That it follows the rules is in `property/`."""

from __future__ import annotations

import re

import numpy as np
import pytest
import torch

from mrta_zoo.batch import BatchMission
from mrta_zoo.errors import ConfigError
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario
from mrta_zoo.scenario_batch import ScenarioBatch

# Task 0 takes robot 0 until 5, task 1 (zero distance) until 3.
SMALL = Scenario(
    task_xy=np.array([[3, 4], [0, 0]]),
    deadline=np.array([5, 20]),
    workload=np.array([0, 3]),
    robot_xy=np.array([[0, 0]]),
    capacity=np.array([1.0]),
    map_size=(10, 20),
)
LARGE = Scenario(
    task_xy=np.array([[3, 4], [6, 8], [30, 40]]),
    deadline=np.array([6, 12, 9]),
    workload=np.array([2, 0, 1]),
    robot_xy=np.array([[0, 0], [6, 8]]),
    capacity=np.array([2.0, 1.0]),
    speed=np.array([1.0, 5.0]),
)


def test_padding() -> None:
    batch = ScenarioBatch.of([SMALL, LARGE])
    assert (len(batch), batch.num_tasks, batch.num_robots) == (2, 3, 2)
    assert batch.task_xy.tolist() == [[[3, 4], [0, 0], [0, 0]], [[3, 4], [6, 8], [30, 40]]]
    assert batch.deadline.tolist() == [[5, 20, 1], [6, 12, 9]]
    assert batch.workload.tolist() == [[0, 3, 0], [2, 0, 1]]
    assert batch.task_exists.tolist() == [[True, True, False], [True, True, True]]
    assert batch.robot_xy.tolist() == [[[0, 0], [0, 0]], [[0, 0], [6, 8]]]
    assert batch.capacity.tolist() == [[1, 1], [2, 1]]
    assert batch.speed.tolist() == [[1, 1], [1, 5]]
    assert batch.robot_exists.tolist() == [[True, False], [True, True]]
    # The first frame is the box around 0, 0 and 3, 4, the second that around 0, 0 and 30, 40: the maps are far larger.
    assert batch.scales.extent.tolist() == [[3, 4], [30, 40]]
    assert batch.scales.length.tolist() == [4, 40]
    for name in ("task_xy", "deadline", "workload", "robot_xy", "capacity", "speed"):
        assert getattr(batch, name).dtype == torch.float64, name


def test_room_may_be_given() -> None:
    batch = ScenarioBatch.of([SMALL], max_tasks=5, max_robots=3)
    assert (batch.num_tasks, batch.num_robots) == (5, 3)
    assert batch.task_exists.sum() == 2
    assert batch.robot_exists.sum() == 1


@pytest.mark.parametrize(
    ("room", "shown"),
    [
        ({"max_tasks": 2}, "2 and 2"),
        ({"max_robots": 1}, "3 and 1"),
        ({"max_tasks": 1, "max_robots": 9}, "1 and 9"),
    ],
)
def test_too_little_room(room: dict[str, int], shown: str) -> None:
    message = f"the largest scenario has 3 tasks and 2 robots; the batch was given room for {shown}"
    with pytest.raises(ConfigError, match=f"^{re.escape(message)}$"):
        ScenarioBatch.of([SMALL, LARGE], **room)


@pytest.mark.parametrize("room", [{"max_tasks": 0}, {"max_robots": 0}])
def test_no_room_at_all_is_not_taken_for_no_wish(room: dict[str, int]) -> None:
    with pytest.raises(ConfigError, match=r"^the largest scenario has 3 tasks and 2 robots"):
        ScenarioBatch.of([LARGE], **room)


def test_an_empty_batch() -> None:
    with pytest.raises(ConfigError, match=r"^a batch needs at least one scenario; got 0$"):
        ScenarioBatch.of([])


def test_unknown_mask_rule() -> None:
    with pytest.raises(ConfigError, match=r"^mask_rule is 'any'; expected one of feasible, active, unvisited$"):
        BatchMission(ScenarioBatch.of([SMALL]), "any")  # type: ignore[arg-type]


def test_device() -> None:
    batch = ScenarioBatch.of([SMALL], device="cpu")
    assert batch.device == torch.device("cpu")
    assert BatchMission(batch).actor.device == batch.device


def test_a_batch_does_not_share_memory_with_its_scenarios() -> None:
    batch = ScenarioBatch.of([SMALL])
    batch.deadline.add_(1)
    assert SMALL.deadline.tolist() == [5, 20]


def test_repeat_keeps_copies_together() -> None:
    batch = ScenarioBatch.of([SMALL, LARGE]).repeat(3)
    assert len(batch) == 6
    assert batch.deadline[:, 0].tolist() == [5, 5, 5, 6, 6, 6]
    assert batch.robot_exists.sum(1).tolist() == [1, 1, 1, 2, 2, 2]


def test_two_missions_on_one_batch_share_nothing() -> None:
    batch = ScenarioBatch.of([SMALL])
    first, second = BatchMission(batch), BatchMission(batch)
    first.step(torch.tensor([1]))
    assert second.untaken.all()
    assert second.ready.tolist() == [[0.0]]
    assert second.position.tolist() == [[[0, 0]]]
    assert batch.robot_xy.tolist() == [[[0, 0]]]


def test_a_mission_by_hand() -> None:
    mission = BatchMission(ScenarioBatch.of([LARGE]))
    # Robot 0: 5 + 2/2 = 6, 10 + 0 = 10, 50 + 1/2 = 50.5. Robot 1: 5/5 + 2 = 3, 0, 40/5 + 1 = 9.
    # From (6, 8) to (30, 40): 24² + 32² = 40².
    assert mission.finish_if.tolist() == [[[6, 10, 50.5], [3, 0, 9]]]
    assert mission.mask().tolist() == [[True, True, False]]
    mission.step(torch.tensor([0]))
    assert (mission.actor.tolist(), mission.time.tolist()) == ([1], [0])
    mission.step(torch.tensor([1]))
    # Robot 1 is still at (6, 8) at 0; robot 0 is free at 6.
    assert (mission.actor.tolist(), mission.time.tolist()) == ([1], [0])
    assert mission.ready.tolist() == [[6, 0]]
    assert mission.position.tolist() == [[[3, 4], [6, 8]]]
    assert mission.order.tolist() == [[0, 1, -1]]
    assert mission.taken_by.tolist() == [[0, 1, -1]]


def test_finished_missions_ignore_their_steps() -> None:
    mission = BatchMission(ScenarioBatch.of([SMALL, LARGE]), "unvisited")
    mission.step(torch.tensor([0, 0]))
    mission.step(torch.tensor([1, 1]))
    assert mission.done.tolist() == [True, False]
    assert not mission.mask()[0].any()
    before = {name: value[0].clone() for name, value in vars(mission).items() if isinstance(value, torch.Tensor)}
    mission.step(torch.tensor([1, 2]))  # task 1 of the first mission has long been done
    mission.step(torch.tensor([2, 0]))  # and its task 2 is padding
    assert mission.done.all()
    for name, value in before.items():
        assert torch.equal(getattr(mission, name)[0], value), name
    assert mission.taken_by.tolist() == [[0, 0, -1], [0, 1, 1]]


def test_scores_and_plans() -> None:
    mission = BatchMission(ScenarioBatch.of([SMALL, LARGE]), "active")
    assert mission.completed().tolist() == [0, 0]
    for step in ([1, 2], [0, 1], [0, 0]):
        mission.step(torch.tensor(step))
    assert mission.done.all()
    # SMALL: task 1 at 3, then task 0 at 3 + 5 = 8, late for 5: 8/5.
    # LARGE: robot 0 task 2 at 50 + 1/2 = 50.5, late for 9; robot 1 task 1 at 0, then task 0 at 5/5 + 2/1 = 3.
    assert mission.cost().tolist() == [8 / 5, 50.5 / 9]
    assert mission.completed().tolist() == [1, 2]
    assert mission.time.tolist() == [8, 50.5]
    assert mission.plans(["small", "large"], "hand") == [
        Plan(((1, 0),), "small", "hand"),
        Plan(((2,), (1, 0)), "large", "hand"),
    ]
    assert mission.plans() == [Plan(((1, 0),)), Plan(((2,), (1, 0)))]


def test_padding_is_never_counted() -> None:
    mission = BatchMission(ScenarioBatch.of([SMALL], max_tasks=50, max_robots=9), "active")
    # Nothing is done yet: each of the two real tasks costs 1.
    assert mission.cost().tolist() == [2.0]
    assert mission.completed().tolist() == [0]
    assert [len(plan.routes) for plan in mission.plans()] == [1]


def test_roots_are_correctly_rounded() -> None:
    # `torch.sqrt` on the CPU is one bit off in about 1 % of values; a tie with a deadline would then fall
    # otherwise here than in `mission` and `verify`.
    rng = np.random.default_rng(0)
    xy = rng.uniform(0, 100, (500, 2))
    case = Scenario(xy, np.ones(500), np.zeros(500), np.zeros((1, 2)), np.ones(1))
    finish_if = BatchMission(ScenarioBatch.of([case] * 3), "unvisited").finish_if
    exact = np.sqrt(xy[:, 0] * xy[:, 0] + xy[:, 1] * xy[:, 1])
    assert (finish_if.numpy() == exact).all()


def test_select_copies_missions_as_they_stand() -> None:
    mission = BatchMission(ScenarioBatch.of([SMALL, LARGE]), "active")
    mission.step(torch.tensor([1, 0]))
    chosen = mission.select(torch.tensor([1, 0, 1]))
    assert chosen.actor.tolist() == [1, 0, 1]
    assert chosen.scenarios.deadline[:, 0].tolist() == [6, 5, 6]
    chosen.step(torch.tensor([1, 0, 2]))
    assert chosen.taken_by.tolist() == [[0, 1, -1], [0, 0, -1], [0, -1, 1]]
    assert mission.taken_by.tolist() == [[-1, 0, -1], [0, -1, -1]], "the original stays as it was"


def test_missions_that_are_not_to_step_stay_as_they_are() -> None:
    mission = BatchMission(ScenarioBatch.of([LARGE, LARGE, SMALL]), "active")
    before = {name: value[1].clone() for name, value in vars(mission).items() if isinstance(value, torch.Tensor)}
    mission.step(torch.tensor([0, 1, 1]), where=torch.tensor([True, False, True]))
    for name, value in before.items():
        assert torch.equal(getattr(mission, name)[1], value), name
    # LARGE: robot 0 is at task 0 until 5 + 2/2 = 6, robot 1 is next. SMALL: task 1 at (0, 0) until 3.
    assert mission.ready.tolist() == [[6, 0], [0, 0], [3, 0]]
    assert mission.actor.tolist() == [1, 0, 0]
    assert mission.taken_by.tolist() == [[0, -1, -1], [-1, -1, -1], [-1, 0, -1]]
    mission.step(torch.tensor([1, 1, 0]), where=torch.tensor([False, True, False]))
    assert mission.ready.tolist() == [[6, 0], [10, 0], [3, 0]]
    assert mission.taken_by.tolist() == [[0, -1, -1], [-1, 0, -1], [-1, 0, -1]]


def test_a_robot_retires_though_it_could_go_on() -> None:
    mission = BatchMission(ScenarioBatch.of([LARGE, LARGE, SMALL]), "active")
    mission.retire(torch.tensor([True, False, True]))
    # Robot 0 of the first is out, robot 1 acts; the third had only one robot, whose mission is over where it began.
    assert mission.actor.tolist() == [1, 0, -1]
    assert mission.retired.tolist() == [[True, False], [False, False], [True, True]]
    assert mission.time.tolist() == [0, 0, 0]
    mission.step(torch.tensor([0, 0, 0]))
    # Robot 1 of the first: 5/5 + 2/1 = 3. It is the only one left there.
    assert mission.actor.tolist() == [1, 1, -1]
    assert mission.time.tolist() == [3, 0, 0]
    mission.retire(torch.tensor([True, False, False]))
    assert mission.done.tolist() == [True, False, True]
    assert mission.time.tolist() == [3, 0, 0], "the clock ends with the last task"
    # The first: task 0 at 3 <= 6; the others, which nobody took, count from their deadlines, 12/12 + 9/9.
    assert mission.cost().tolist()[0] == 2
    assert mission.plans()[0] == Plan(((), (0,)))
    assert mission.plans()[2] == Plan(((),))
