"""The dynamics of one mission, against arithmetic done by hand."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
import pytest

from mrta_zoo.errors import ActionError, ConfigError
from mrta_zoo.mission import Finished, Mission
from mrta_zoo.rules import MASK_RULES, MaskFormula, MaskReason, MaskRule, Status
from mrta_zoo.scenario import Scenario

ACTIVE, ASSIGNED, COMPLETED, MISSED = Status


def scenario(
    tasks: list[tuple[float, float, float, float]],
    robots: list[tuple[float, float]] | None = None,
    capacity: list[float] | None = None,
    speed: list[float] | None = None,
) -> Scenario:
    """Tasks are (x, y, deadline, workload); one robot in the origin with capacity and speed 1 unless told."""
    robots = robots or [(0, 0)]
    table = np.array(tasks, dtype=float)
    return Scenario(
        task_xy=table[:, :2],
        deadline=table[:, 2],
        workload=table[:, 3],
        robot_xy=np.array(robots, dtype=float),
        capacity=np.array(capacity or [1.0] * len(robots)),
        speed=np.array(speed or [1.0] * len(robots)),
    )


def run(case: Scenario, *tasks: int, rule: MaskRule = "feasible") -> Mission:
    """The mission after these choices."""
    mission = Mission(case, rule)
    for task in tasks:
        mission.assign(task)
    return mission


def choices(mission: Mission, robot: int = 0) -> list[int]:
    return np.flatnonzero(mission.mask(robot)).tolist()


# The way is 5 (3-4-5 triangle), the work 4 / 2 = 2: finished at 5 + 2 = 7.
@pytest.mark.parametrize(
    ("deadline", "completed"),
    [(7.0, True), (math.nextafter(7.0, 8.0), True), (math.nextafter(7.0, 0.0), False)],
)
def test_a_finish_at_the_very_deadline_counts(deadline: float, completed: bool) -> None:
    case = scenario([(3, 4, deadline, 4)], capacity=[2])
    assert choices(Mission(case)) == ([0] if completed else [])
    mission = run(case, 0, rule="unvisited")
    assert mission.time == 7.0
    assert mission.completed() == completed
    assert mission.status.tolist() == [COMPLETED if completed else MISSED]
    assert mission.cost() == (0.0 if completed else 7.0 / deadline)


def test_a_task_may_be_active_up_to_its_very_deadline() -> None:
    # Task 0 takes the robot until 5. At 5, task 1 (deadline 5) is still active, task 2 (deadline 4) is not.
    mission = run(scenario([(3, 4, 9, 0), (0, 0, 5, 0), (0, 0, 4, 0)]), 0, rule="active")
    assert mission.time == 5.0
    assert mission.status.tolist() == [COMPLETED, ACTIVE, MISSED]
    assert choices(mission) == [1]


def test_capacity_and_speed() -> None:
    # Robot 0: way 5 / 1 = 5, work 3 / 1 = 3, finished at 8.
    # Robot 1: way 5 / 2 = 2.5, work 3 / 4 = 0.75, finished at 3.25.
    mission = Mission(scenario([(3, 4, 99, 3)], [(0, 0), (0, 0)], capacity=[1, 4], speed=[1, 2]))
    assert mission.finish_if.tolist() == [[8.0], [3.25]]


def test_finish_if_looks_ahead_from_the_next_free_time_and_place() -> None:
    mission = run(scenario([(3, 4, 99, 1), (6, 8, 99, 2)]), 0)
    # Free at 5 + 1 = 6 in (3, 4); task 1 is 5 away: 6 + 5 + 2 = 13. Task 0 again: 6 + 0 + 1 = 7.
    assert mission.ready == [6.0]
    assert mission.position.tolist() == [[3, 4]]
    assert mission.finish_if.tolist() == [[7.0, 13.0]]


def test_zero_distance_and_zero_workload_take_no_time() -> None:
    case = scenario([(0, 0, 1, 0), (0, 0, 3, 3), (0, 0, 9, 0)])
    mission = Mission(case)
    assert mission.assign(0) == [Finished(0, 0, 0.0, True)]
    assert (mission.time, mission.actor) == (0.0, 0)
    assert mission.status.tolist() == [COMPLETED, ACTIVE, ACTIVE]
    assert mission.assign(1) == [Finished(0, 1, 3.0, True)]  # work 3 / 1 = 3 = deadline
    assert mission.assign(2) == [Finished(0, 2, 3.0, True)]
    assert mission.done
    assert (mission.time, mission.cost(), mission.completed()) == (3.0, 0.0, 3)


def test_robots_that_arrive_together_act_in_index_order() -> None:
    # All three robots are 5 away from their first task, from three sides, and then 5 from the middle.
    tasks = [
        (55, 50, 99, 0),
        (50, 55, 99, 0),
        (45, 50, 99, 0),
        (50, 50, 99, 0),
        (50, 50, 99, 0),
        (50, 50, 99, 0),
    ]
    mission = Mission(scenario(tasks, [(60, 50), (50, 60), (40, 50)]))
    actors = []
    for task in range(6):
        actors.append((mission.time, mission.actor))
        events = mission.assign(task)
        if task == 2:
            assert events == [Finished(robot, robot, 5.0, True) for robot in range(3)]
    assert actors == [(0, 0), (0, 1), (0, 2), (5, 0), (5, 1), (5, 2)]
    assert mission.done
    assert mission.time == 10.0


def test_whoever_is_free_first_acts_next() -> None:
    # Robot 0 goes 10 far, robot 1 only 5, then 4 more (at 9), and then 2 more (at 11); robot 0 is free at 10.
    case = scenario([(6, 8, 99, 0), (3, 4, 99, 0), (3, 8, 99, 0), (3, 10, 99, 0), (0, 0, 99, 0)], [(0, 0), (0, 0)])
    mission = Mission(case)
    log = []
    while not mission.done:
        log.append((mission.time, mission.actor))
        mission.assign(choices(mission, mission.actor)[0])
    assert log == [(0, 0), (0, 1), (5, 1), (9, 1), (10, 0)]
    assert mission.routes == [[0, 4], [1, 2, 3]]
    assert mission.time == 20.0  # robot 0: 10 + 10


def test_events_come_in_order_of_time() -> None:
    # Robot 0 finishes at 5, robot 1 at 3; both before robot 2, which is free at 6, has the next choice.
    case = scenario([(3, 4, 5, 0), (0, 3, 3, 0), (6, 0, 6, 0), (6, 0, 6, 0)], [(0, 0)] * 3)
    mission = run(case, 0, 1)
    assert mission.assign(2) == [
        Finished(1, 1, 3.0, True),
        Finished(0, 0, 5.0, True),
        Finished(2, 2, 6.0, True),
    ]
    assert mission.retired == [True, True, False]
    assert (mission.time, mission.actor) == (6.0, 2)


def test_nothing_feasible_at_all_is_over_at_once() -> None:
    # Both robots are 5 away from task 0; task 1 is 2 work units, longer than its deadline 1.
    mission = Mission(scenario([(3, 4, 4.9, 0), (0, 0, 1, 2)], [(0, 0), (6, 0)]))
    assert mission.done
    assert (mission.actor, mission.time, mission.completed()) == (-1, 0.0, 0)
    assert mission.retired == [True, True]
    assert mission.free() == []
    assert mission.status.tolist() == [ACTIVE, ACTIVE]  # at time 0 no deadline has passed
    assert mission.cost() == 2.0  # each counts as finished at its deadline: 4.9 / 4.9 + 1 / 1


# From (0, 0): task 0 at 5 + 1 = 6, its deadline; task 1 at 10, too late for 9.5; task 2 at 0 + 2 = 2.
THREE = [(3, 4, 6, 1), (6, 8, 9.5, 0), (0, 0, 20, 2)]


@pytest.mark.parametrize(
    ("rule", "at_0", "at_6", "at_13"),
    [
        # At 6 in (3, 4): task 1 is 5 away, 6 + 5 = 11 > 9.5; task 2: 6 + 5 + 2 = 13, when 9.5 is past.
        ("feasible", [0, 2], [2], []),
        ("active", [0, 1, 2], [1, 2], []),
        ("unvisited", [0, 1, 2], [1, 2], [1]),
    ],
)
def test_the_mask_rules(rule: MaskRule, at_0: list[int], at_6: list[int], at_13: list[int]) -> None:
    mission = Mission(scenario(THREE), rule)
    assert choices(mission) == at_0
    mission.assign(0)
    assert (mission.time, choices(mission)) == (6.0, at_6)
    mission.assign(2)
    assert (mission.time, choices(mission)) == (13.0, at_13)
    assert mission.done == (not at_13)
    if mission.done:
        assert mission.cost() == 13 / 9.5  # nobody took task 1, and the mission ended after its deadline
    else:
        assert mission.assign(1) == [Finished(0, 1, 23.0, False)]  # 13 + 10
        assert mission.cost() == 23 / 9.5


def test_why_a_robot_may_not_choose() -> None:
    mission = Mission(scenario(THREE))
    choosable, taken, passed, too_late = MaskReason.CHOOSABLE, MaskReason.TAKEN, *list(MaskReason)[2:4]
    assert mission.reasons[0].tolist() == [choosable, too_late, choosable]
    mission.assign(0)
    assert mission.reasons[0].tolist() == [taken, too_late, choosable]
    mission.assign(2)
    assert mission.reasons[0].tolist() == [taken, passed, taken]
    assert passed is MaskReason.DEADLINE_PASSED
    assert too_late is MaskReason.TOO_LATE


def test_a_new_rule_calls_nothing_late_that_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    def allows(finish: Any, ready: Any, deadline: Any) -> Any:
        return finish + 50 <= deadline

    monkeypatch.setitem(MASK_RULES, "to spare", MaskFormula(allows, "those done 50 before their deadline"))
    case = scenario([(1, 0, 51.0, 0), (1, 0, 50.9, 0)])  # both are finished at 1
    assert Mission(case, "to spare").reasons[0].tolist() == [MaskReason.CHOOSABLE, MaskReason.RULED_OUT]  # type: ignore[arg-type]


def test_retirement_in_order_of_time() -> None:
    # Robot 1 can do nothing from the start, but is asked only after robot 0 has chosen. Robot 0 is free at 5.
    case = scenario([(3, 4, 5, 0), (3, 9, 10, 0)], [(0, 0), (100, 100)])
    mission = Mission(case)
    assert (mission.actor, mission.retired) == (0, [False, False])
    mission.assign(0)
    assert (mission.actor, mission.time, mission.retired) == (0, 5.0, [False, True])
    mission.assign(1)
    assert (mission.actor, mission.time, mission.retired) == (-1, 10.0, [True, True])


def test_a_robot_retires_when_another_took_its_last_choice() -> None:
    case = scenario([(50, 50, 9, 0)], [(50, 49), (50, 51)])
    mission = Mission(case)
    assert choices(mission, 1) == [0]
    mission.assign(0)
    assert mission.done
    assert mission.routes == [[0], []]


def test_statuses_over_time() -> None:
    # Robot 0: task 0 at 5, then task 1 at 5 + 5 = 10, late for 9. Robot 1: task 2 with work 7, at 7.
    tasks = [(3, 4, 6, 0), (6, 8, 9, 0), (50, 50, 99, 7), (90, 90, 6, 0), (90, 90, 98, 0)]
    mission = Mission(scenario(tasks, [(0, 0), (50, 50)]), "active")
    assert mission.status.tolist() == [ACTIVE] * 5
    mission.assign(0)
    assert mission.status.tolist() == [ASSIGNED, ACTIVE, ACTIVE, ACTIVE, ACTIVE]
    mission.assign(2)
    assert mission.time == 5.0
    assert mission.status.tolist() == [COMPLETED, ACTIVE, ASSIGNED, ACTIVE, ACTIVE]
    mission.assign(1)
    assert mission.time == 7.0  # robot 1 is free; deadline 6 has passed
    assert mission.status.tolist() == [COMPLETED, ASSIGNED, COMPLETED, MISSED, ACTIVE]
    mission.assign(4)  # 40² + 40² = 3200: robot 1 gets there at 7 + 56.57 = 63.57
    assert mission.done
    assert mission.time == 7 + math.sqrt(3200)
    assert mission.status.tolist() == [COMPLETED, MISSED, COMPLETED, MISSED, COMPLETED]


def test_a_task_on_the_way_stays_assigned_when_its_deadline_passes() -> None:
    # Robot 0 needs 10 for a task with deadline 4; robot 1 is free at 5.
    case = scenario([(6, 8, 4, 0), (3, 4, 99, 0), (3, 4, 99, 0)], [(0, 0), (0, 0)])
    mission = run(case, 0, 1, rule="unvisited")
    assert mission.time == 5.0
    assert mission.status.tolist() == [ASSIGNED, COMPLETED, ACTIVE]


def test_cost_of_late_and_never_taken_tasks() -> None:
    # The robot does task 0 at 5, late for 4: 5 / 4. It then does task 1 at 5 + 5 = 10, in time: the end.
    # Never taken: task 2, deadline 8 < 10, costs 10 / 8; task 3, deadline 50 > 10, costs exactly 1.
    case = scenario([(3, 4, 4, 0), (6, 8, 10, 0), (90, 90, 8, 0), (90, 90, 50, 50)])
    mission = run(case, 0, 1, rule="unvisited")
    assert mission.time == 10.0
    assert not mission.done  # a cost may be asked for at any time
    assert mission.cost() == 5 / 4 + 0 + 10 / 8 + 1
    assert mission.completed() == 1


def test_single_robot_and_single_task() -> None:
    mission = Mission(scenario([(3, 4, 10, 0)]))
    assert (mission.actor, mission.done, mission.free()) == (0, False, [0])
    mission.assign(0)
    assert (mission.done, mission.time, mission.routes) == (True, 5.0, [[0]])


def test_robots_that_choose_at_once() -> None:
    # The ways are 5, 5 and 10.
    case = scenario([(3, 4, 99, 0), (50, 45, 99, 0), (6, 8, 99, 0)], [(0, 0), (50, 50), (16, 8)])
    mission = Mission(case)
    assert mission.free() == [0, 1, 2]
    mission.take(1, 1)
    assert mission.free() == [0, 2]
    assert (mission.time, mission.actor) == (0.0, 0)
    mission.take(0, 0)
    assert mission.status.tolist() == [ASSIGNED, ASSIGNED, ACTIVE]
    mission.take(2, 2)
    # Nobody has a choice any more, so the clock goes on to the end, when robot 2 arrives.
    assert mission.advance() == [
        Finished(0, 0, 5.0, True), Finished(1, 1, 5.0, True), Finished(2, 2, 10.0, True),
    ]  # fmt: skip
    assert (mission.done, mission.time, mission.routes) == (True, 10.0, [[0], [1], [2]])


def test_the_clock_waits_for_those_who_took_nothing() -> None:
    mission = Mission(scenario([(3, 4, 99, 0), (6, 8, 99, 0)], [(0, 0), (0, 0)]))
    mission.take(0, 0)
    assert mission.advance() == []
    assert (mission.time, mission.actor) == (0.0, 1)


def test_a_task_that_needs_no_time_is_finished_before_the_robot_takes_another() -> None:
    mission = Mission(scenario([(0, 0, 9, 0), (0, 0, 9, 0)]))
    mission.take(0, 0)
    assert mission.free() == []
    with pytest.raises(ActionError, match=r"^robot 0 has just taken task 0 and cannot take task 1 too; advance"):
        mission.take(0, 1)
    assert mission.advance() == [Finished(0, 0, 0.0, True)]
    assert mission.free() == [0]
    mission.take(0, 1)
    mission.advance()
    assert mission.status.tolist() == [COMPLETED, COMPLETED]


@pytest.mark.parametrize(
    ("robot", "task", "message"),
    [
        (0, 1, "robot 0 may not choose task 1 at time 0: too late; its choices are 0, 2"),
        (0, 3, "robot 0 chose task 3; tasks are numbered 0 to 2"),
        (0, -1, "robot 0 chose task -1; tasks are numbered 0 to 2"),
        (1, 0, "there is no robot 1; the scenario has 1"),
        (-1, 0, "there is no robot -1; the scenario has 1"),
    ],
)
def test_errors_of_take(robot: int, task: int, message: str) -> None:
    mission = Mission(scenario(THREE))
    with pytest.raises(ActionError, match=f"^{re.escape(message)}$"):
        mission.take(robot, task)
    assert mission.routes == [[]], "a refused choice changes nothing"
    assert choices(mission) == [0, 2]


def test_errors_name_what_happened() -> None:
    mission = run(scenario(THREE), 0)
    with pytest.raises(ActionError, match=r"^robot 0 may not choose task 0 at time 6: taken; its choices are 2$"):
        mission.assign(0)
    mission.assign(2)
    with pytest.raises(ActionError, match=r"^task 1 was chosen, but the mission is over: every robot is retired$"):
        mission.assign(1)
    mission = run(scenario([(3, 4, 99, 0), (3, 4, 4, 0), (9, 9, 99, 0)], [(0, 0), (0, 1)]), 0, rule="active")
    with pytest.raises(ActionError, match=r"^robot 0 is not free at time 0; robot 1 is to act$"):
        mission.take(0, 1)
    # At 5 the deadline of task 1 has passed.
    mission = run(scenario([(3, 4, 99, 0), (3, 4, 4, 0), (9, 9, 99, 0)]), 0, rule="active")
    message = "^robot 0 may not choose task 1 at time 5: deadline passed; its choices are 2$"
    with pytest.raises(ActionError, match=message):
        mission.take(0, 1)


def test_long_lists_of_choices_are_cut() -> None:
    mission = Mission(scenario([(0, 0, 1, 9)] + [(0, 0, 9, 0)] * 12))
    with pytest.raises(ActionError, match=r"its choices are 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, …$"):
        mission.assign(0)


def test_unknown_mask_rule() -> None:
    with pytest.raises(ConfigError, match=r"^mask_rule is 'any'; expected one of feasible, active, unvisited$"):
        Mission(scenario(THREE), "any")  # type: ignore[arg-type]


def test_two_missions_share_nothing() -> None:
    case = scenario(THREE)
    first, second = Mission(case), Mission(case)
    first.assign(0)
    assert second.status.tolist() == [ACTIVE] * 3
    assert second.position.tolist() == [[0, 0]]
    assert case.robot_xy.tolist() == [[0, 0]]
