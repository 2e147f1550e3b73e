"""The formulas, by hand."""

from __future__ import annotations

from itertools import pairwise
from typing import get_args

import numpy as np
import pytest

from mrta_zoo import mrta_v0
from mrta_zoo.errors import ConfigError
from mrta_zoo.rules import (
    MASK_RULES,
    MaskReason,
    MaskRule,
    Status,
    loosest,
    may_choose,
    next_event,
    task_cost,
    travel_time,
    visit,
)


def test_travel_time() -> None:
    assert travel_time(3.0, -4.0, 2.0, np.sqrt) == 2.5  # 5 / 2


def test_a_visit_adds_the_way_before_the_work() -> None:
    # The order matters for the last bit: (0.1 + 0.2) + 0.3 = 0.6000000000000001, 0.1 + (0.2 + 0.3) = 0.6.
    assert visit(0.1, 0.2, 0.3) == (0.1, 0.1 + 0.2, 0.1 + 0.2, 0.6000000000000001)


def test_next_event() -> None:
    def least(times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return times.min(-1), times.argmin(-1)

    # Of the first team robot 0 is out, and 1 and 2 are free at 3: the lower index acts. Of the second all are out.
    ready, out = np.array([[1.0, 3.0, 3.0], [1.0, 2.0, 3.0]]), np.array([[True, False, False], [True, True, True]])
    time, robot = next_event(ready, out, np.where, least)
    assert (time.tolist(), robot[0]) == ([3.0, np.inf], 1)


@pytest.mark.parametrize(
    ("rule", "allowed"),
    [("feasible", [True, False, False]), ("active", [True, True, False]), ("unvisited", [True, True, True])],
)
def test_may_choose(rule: str, allowed: list[bool]) -> None:
    # Free at 4; finishes at 5, 6, 7. Deadlines: 5 is met, 4 has not passed but is too early, 3 has passed.
    finish, deadline = np.array([5.0, 6.0, 7.0]), np.array([5.0, 4.0, 3.0])
    assert may_choose(rule, finish, 4.0, deadline).tolist() == allowed  # type: ignore[arg-type]


def test_the_table_holds_every_mask_rule_the_tightest_first() -> None:
    assert tuple(MASK_RULES) == get_args(MaskRule)
    finish, ready, deadline = (axis.ravel() for axis in np.meshgrid(*[np.arange(4.0)] * 3))
    possible = finish >= ready
    allowed = [may_choose(rule, finish, ready, deadline)[possible] for rule in MASK_RULES]
    for tighter, looser in pairwise(allowed):
        assert (tighter <= looser).all()
        assert tighter.sum() < looser.sum()
    assert loosest(["active", "feasible", "active"]) == "active"


def test_the_environments_documentation_lists_every_mask_rule() -> None:
    for rule, formula in MASK_RULES.items():
        assert f'- ``"{rule}"``' in mrta_v0.__doc__
        assert formula.help in " ".join(mrta_v0.__doc__.split())


def test_unknown_rule() -> None:
    with pytest.raises(ConfigError, match=r"^mask_rule is 'late'; expected one of feasible, active, unvisited$"):
        may_choose("late", np.zeros(1), 0.0, np.ones(1))  # type: ignore[arg-type]


def test_task_cost() -> None:
    finish = np.array([4.0, 6.0, np.inf, np.inf])
    deadline = np.array([4.0, 4.0, 4.0, 20.0])
    # In time: 0. Late: 6 / 4. Never taken, mission ends at 10: max(10, 4) / 4 and max(10, 20) / 20.
    cost = task_cost(finish, deadline, 10.0, np.where, np.maximum)
    assert cost.tolist() == [0.0, 1.5, 2.5, 1.0]


def test_codes_are_fixed() -> None:
    # They are written to observations, infos and files.
    assert [status.name for status in sorted(Status)] == ["ACTIVE", "ASSIGNED", "COMPLETED", "MISSED"]
    assert [reason.name for reason in sorted(MaskReason)] == [
        "CHOOSABLE", "TAKEN", "DEADLINE_PASSED", "TOO_LATE", "NO_TASK", "RULED_OUT",
    ]  # fmt: skip
