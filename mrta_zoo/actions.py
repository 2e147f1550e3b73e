"""Actions: the index of a task to take or, in the forms of the environment that have it, the no-op.

The no-op is the action after the last task, ``max_tasks``. It takes no task.
"""

from __future__ import annotations

import operator
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from mrta_zoo.errors import OutOfBoundsError

Mask = TypeVar("Mask", bound=Any)


def noop(max_tasks: int) -> int:
    """The index of the no-op, in a form that has it."""
    return max_tasks


def split_mask(mask: Mask, max_tasks: int) -> tuple[Mask, Mask]:
    """Split one or more masks into the part for the tasks and the part for the no-op.

    Args:
        mask: (..., max_tasks) or, with a no-op, (..., max_tasks + 1); a NumPy array or a tensor.
        max_tasks: the environment's number of task rows.

    Returns:
        Two views: (..., max_tasks), and (..., 1) or, without a no-op, (..., 0).
    """
    return mask[..., :max_tasks], mask[..., max_tasks:]


def must_wait(mask: Mask, max_tasks: int) -> Mask:
    """(...) bool, where a mask, or more of them, leave only the no-op; arguments as those of `split_mask`."""
    waits: Mask = mask[..., max_tasks:].any(-1)
    return waits


def as_action(agent: str, action: Any, num_actions: int) -> int:
    """An action as a Python integer from 0 to ``num_actions - 1``.

    Raises:
        OutOfBoundsError: if it is not one.
    """
    try:
        number = operator.index(action)
    except TypeError:
        number = -1
    if not 0 <= number < num_actions or isinstance(action, bool):
        raise OutOfBoundsError(f"{agent} sent action {action!r}; expected a whole number from 0 to {num_actions - 1}")
    return number


def next_legal(mask: npt.NDArray[Any], action: int) -> int:
    """The first action that the mask allows, searching upwards from `action` and then from 0."""
    return int(np.roll(mask, -action).argmax() + action) % len(mask)
