"""The rules of the problem as formulas, written once for NumPy arrays and for torch tensors.

Everything that decides *when* a robot finishes, *what* it may choose and *what it costs* is here; `mission`
(one scenario, readable) and `batch` (thousands at once) only keep the state. All arithmetic is in float64 and in
the order written here, so that both give the same bits; `verify` states the rules a second time, on purpose.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from enum import IntEnum
from typing import Any, Literal, NamedTuple

from mrta_zoo.errors import ConfigError

MaskRule = Literal["feasible", "active", "unvisited"]
"""Which of the tasks not yet taken a robot may choose, see `MASK_RULES`."""


class VisitTimes(NamedTuple):
    """When a robot does a task, in time units: floats, or arrays of one shape.

    Attributes:
        departs: when it leaves for the task.
        arrives: when it gets there.
        starts: when its work begins.
        finishes: when its work is done.
    """

    departs: Any
    arrives: Any
    starts: Any
    finishes: Any


class MaskReason(IntEnum):
    """Why a robot may not choose a task."""

    CHOOSABLE = 0
    TAKEN = 1
    DEADLINE_PASSED = 2
    TOO_LATE = 3
    """This robot could not finish it by its deadline."""
    NO_TASK = 4
    """Padding: the scenario has fewer tasks than the environment has room for."""
    RULED_OUT = 5
    """The mask rule refuses it for a reason of its own."""


class MaskFormula(NamedTuple):
    """A mask rule.

    Attributes:
        allows: ``allows(finish, ready, deadline)``: whether a robot that is free at `ready` may choose a task that it
            would finish at `finish`, if nobody has taken it.
        help: which tasks these are.
        reason: why it refuses others, of those whose deadline has not passed.
    """

    allows: Callable[[Any, Any, Any], Any]
    help: str
    reason: MaskReason = MaskReason.RULED_OUT


MASK_RULES: dict[MaskRule, MaskFormula] = {
    "feasible": MaskFormula(
        lambda finish, ready, deadline: finish <= deadline,
        "those that this robot can finish by their deadline",
        MaskReason.TOO_LATE,
    ),
    "active": MaskFormula(
        lambda finish, ready, deadline: (ready <= deadline) & (finish == finish),  # which only broadcasts to (..., N)
        "those whose deadline has not passed",
    ),
    "unvisited": MaskFormula(
        lambda finish, ready, deadline: finish == finish, "all of them, even if late (the paper's rule, §II-B)"
    ),
}
"""Every mask rule, the tightest first: what one allows, the later ones allow, too. To add one, add its name to
`MaskRule` and its line here."""


class Status(IntEnum):
    """Status of a task at a given time (paper §II-B, with *assigned* kept apart from *active*)."""

    ACTIVE = 0
    """Not taken, deadline not passed."""
    ASSIGNED = 1
    """Taken, and its robot is on the way or at work."""
    COMPLETED = 2
    """Finished by its deadline."""
    MISSED = 3
    """Finished late, or its deadline passed before anyone took it."""


# Arrays are NumPy or torch, hence `Any`; shapes only need to broadcast.
def travel_time(dx: Any, dy: Any, speed: Any, sqrt: Callable[[Any], Any]) -> Any:
    """Time to travel the straight line (dx, dy)."""
    return sqrt(dx * dx + dy * dy) / speed


def visit(ready: Any, travel: Any, work: Any) -> VisitTimes:
    """When a robot that is free at `ready` does a task: it travels, then works, without delay.

    Args:
        ready: when the robot is free.
        travel: how long it travels to the task.
        work: how long it works there.
    """
    departs = ready
    starts = arrives = departs + travel
    return VisitTimes(departs, arrives, starts, starts + work)


def next_event(
    ready: Any, out: Any, where: Callable[[Any, Any, Any], Any], least: Callable[[Any], tuple[Any, Any]]
) -> tuple[Any, Any]:
    """When a robot acts next, and which: the one that is free first, ties to the lowest index.

    Args:
        ready: (..., M) when each robot is free.
        out: (..., M) bool, those that may not be selected: they are retired, or have nothing to choose.
        where: chooses elements, as ``numpy.where`` does.
        least: the least of each row and its first index.

    Returns:
        (...) times, infinite where all are out, and (...) indices, meaningless there.
    """
    return least(where(out, math.inf, ready))


def may_choose(rule: MaskRule, finish: Any, ready: Any, deadline: Any) -> Any:
    """Which tasks the mask rule allows a robot that is free at `ready`, if nobody has taken them.

    Raises:
        ConfigError: if there is no such rule.
    """
    check_mask_rule(rule)
    return MASK_RULES[rule].allows(finish, ready, deadline)


def check_mask_rule(rule: object) -> None:
    """Check the name of a mask rule.

    Raises:
        ConfigError: if there is no such rule.
    """
    if not isinstance(rule, str) or rule not in MASK_RULES:
        raise ConfigError(f"mask_rule is {rule!r}; expected one of {', '.join(MASK_RULES)}")


def loosest(rules: Iterable[MaskRule]) -> MaskRule:
    """The loosest of one or more mask rules."""
    return max(rules, key=list(MASK_RULES).index)


def task_cost(finish: Any, deadline: Any, end: Any, where: Any, maximum: Any) -> Any:
    """Each task's term of the objective, Eq. 1 of the paper: f/d if late, else 0.

    A task nobody took, whose `finish` is infinite, counts as finished at the end of the mission or at its deadline,
    whichever is later, so that it costs at least 1.
    """
    counted = where(finish < math.inf, finish, maximum(end, deadline))
    return where(finish <= deadline, 0.0, counted / deadline)
