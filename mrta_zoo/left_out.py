"""The tasks that a plan leaves out, and why: no robot could have done them in time, or others were worth more."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from mrta_zoo.plan import Plan
from mrta_zoo.reach import in_time
from mrta_zoo.scenario import Scenario

Reason = Literal["out of reach", "others were worth more"]
"""Why a task is left out:

- ``"out of reach"``: no robot could finish it by its deadline, even if it went straight there at the start;
- ``"others were worth more"``: some robot could, but the plan has the robots do something else.
"""


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A task that nobody takes.

    Attributes:
        task: the task.
        reason: why.
    """

    task: int
    reason: Reason


def left_out(scenario: Scenario, plan: Plan) -> tuple[LeftOut, ...]:
    """The tasks that a plan leaves out, in index order.

    Args:
        scenario: what was planned.
        plan: its plan, which must fit it, see `verify.verify`.
    """
    within_reach = np.asarray(in_time(scenario).any(axis=0))
    taken = {task for route in plan.routes for task in route}
    return tuple(
        LeftOut(task, "others were worth more" if within_reach[task] else "out of reach")
        for task in range(scenario.num_tasks)
        if task not in taken
    )
