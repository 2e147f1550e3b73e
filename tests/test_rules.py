"""The formulas, by hand."""

from __future__ import annotations

import numpy as np
import pytest

from mrta_zoo.errors import ConfigError
from mrta_zoo.rules import MaskReason, Status, finish_time, may_choose, task_cost, travel_time


def test_travel_time() -> None:
    assert travel_time(3.0, -4.0, 2.0, np.sqrt) == 2.5  # 5 / 2


def test_finish_time_adds_the_way_before_the_work() -> None:
    # The order matters for the last bit: (0.1 + 0.2) + 0.3 = 0.6000000000000001, 0.1 + (0.2 + 0.3) = 0.6.
    assert finish_time(0.1, 0.2, 0.3) == 0.6000000000000001


@pytest.mark.parametrize(
    ("rule", "allowed"),
    [("feasible", [True, False, False]), ("active", [True, True, False]), ("unvisited", [True, True, True])],
)
def test_may_choose(rule: str, allowed: list[bool]) -> None:
    # Free at 4; finishes at 5, 6, 7. Deadlines: 5 is met, 4 has not passed but is too early, 3 has passed.
    finish, deadline = np.array([5.0, 6.0, 7.0]), np.array([5.0, 4.0, 3.0])
    assert may_choose(rule, finish, 4.0, deadline).tolist() == allowed  # type: ignore[arg-type]


def test_unknown_rule() -> None:
    with pytest.raises(ConfigError, match=r"^mask_rule is 'late'; expected one of feasible, active, unvisited$"):
        may_choose("late", np.zeros(1), 0.0, np.ones(1))  # type: ignore[arg-type]


def test_task_cost() -> None:
    taken = np.array([True, True, False, False])
    finish = np.array([4.0, 6.0, np.nan, np.nan])
    deadline = np.array([4.0, 4.0, 4.0, 20.0])
    # In time: 0. Late: 6 / 4. Never taken, mission ends at 10: max(10, 4) / 4 and max(10, 20) / 20.
    cost = task_cost(taken, finish, deadline, 10.0, np.where, np.maximum)
    assert cost.tolist() == [0.0, 1.5, 2.5, 1.0]


def test_codes_are_fixed() -> None:
    # They are written to observations, infos and files.
    assert [status.name for status in sorted(Status)] == ["ACTIVE", "ASSIGNED", "COMPLETED", "MISSED"]
    assert [reason.name for reason in sorted(MaskReason)] == [
        "CHOOSABLE", "TAKEN", "DEADLINE_PASSED", "TOO_LATE", "NO_TASK",
    ]  # fmt: skip
