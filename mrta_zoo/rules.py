"""The rules of the problem as formulas, written once for NumPy arrays and for torch tensors.

Everything that decides *when* a robot finishes, *what* it may choose and *what it costs* is here; `mission`
(one scenario, readable) and `batch` (thousands at once) only keep the books. All arithmetic is in float64 and in
the order written here, so that both give the same bits; `verify` states the rules a second time, on purpose.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import IntEnum
from typing import Any, Literal, get_args

from mrta_zoo.errors import ConfigError

MaskRule = Literal["feasible", "active", "unvisited"]
"""Which of the tasks not yet taken a robot may choose:

- ``"feasible"``: those that this robot can finish by their deadline (the default);
- ``"active"``: those whose deadline has not passed;
- ``"unvisited"``: all of them, even if late (the paper's rule, §II-B).
"""


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


class MaskReason(IntEnum):
    """Why a robot may not choose a task."""

    CHOOSABLE = 0
    TAKEN = 1
    DEADLINE_PASSED = 2
    TOO_LATE = 3
    """This robot could not finish it by its deadline."""
    NO_TASK = 4
    """Padding: the scenario has fewer tasks than the environment has room for."""


# Arrays are NumPy or torch, hence `Any`; shapes only need to broadcast.
def travel_time(dx: Any, dy: Any, speed: Any, sqrt: Callable[[Any], Any]) -> Any:
    """Time to travel the straight line (dx, dy)."""
    return sqrt(dx * dx + dy * dy) / speed


def finish_time(ready: Any, travel: Any, work: Any) -> Any:
    """When a robot that is free at `ready` finishes a task: first the way, then the work."""
    return (ready + travel) + work


def may_choose(rule: MaskRule, finish: Any, ready: Any, deadline: Any) -> Any:
    """Which tasks the mask rule allows a robot that is free at `ready`, if nobody has taken them.

    To add a rule, add its name to `MaskRule` and its formula here: environment and simulator follow.
    """
    if rule == "feasible":
        return finish <= deadline
    if rule == "active":
        return (ready <= deadline) & (finish == finish)  # the second term only broadcasts to (..., N)
    check_mask_rule(rule)
    return finish == finish  # "unvisited"


def check_mask_rule(rule: object) -> None:
    """Check the name of a mask rule.

    Raises:
        ConfigError: if there is none of that name.
    """
    if not isinstance(rule, str) or rule not in get_args(MaskRule):
        raise ConfigError(f"mask_rule is {rule!r}; expected one of {', '.join(get_args(MaskRule))}")


def task_cost(taken: Any, finish: Any, deadline: Any, end: Any, where: Any, maximum: Any) -> Any:
    """Each task's term of the objective, Eq. 1 of the paper: f/d if late, else 0.

    A task nobody took counts as finished at the end of the mission or at its deadline, whichever is later,
    so that it costs at least 1.
    """
    counted = where(taken, finish, maximum(end, deadline))
    return where(taken & (finish <= deadline), 0.0, counted / deadline)
