"""A robot's outlook: for every task, when it would be done, why it may not be chosen, and who else could do it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from mrta_zoo.errors import ConfigError
from mrta_zoo.mission import Mission
from mrta_zoo.rules import MaskReason, Status, travel_time
from mrta_zoo.show.view import Digits

SortKey = Literal["rank", "distance", "finish", "slack", "deadline", "task"]
"""How tasks are sorted: those that may be chosen first, then by the policy's probability or else by finish ("rank"), or
by a column. Only "task" does not put those that may be chosen first."""

_AFTER = (
    MaskReason.CHOOSABLE, MaskReason.TOO_LATE, MaskReason.RULED_OUT, MaskReason.TAKEN, MaskReason.DEADLINE_PASSED,
    MaskReason.NO_TASK,
)  # fmt: skip
_REASONS, _STATUSES = list(MaskReason), list(Status)


@dataclass(frozen=True, slots=True)
class Prospect:
    """A task as one robot sees it.

    Attributes:
        task: the task.
        name: its name, or else its number.
        distance: from where the robot is next free, in distance units.
        travel: the time it needs to get there.
        finish: when it would be done if the robot took it next.
        slack: deadline - finish; < 0 if it would be late.
        deadline: its deadline.
        reason: why the robot may not choose it, or that it may.
        status: its status now.
        taken_by: the robot that took it, None if nobody did.
        done: when that robot finishes it, None if nobody took it.
        rival: the other robot that could finish it first, and in time; None if there is none or it is taken.
        rival_finish: when the rival would finish it if it took it next; None if there is no rival.
        who: name of the robot that took it or, if nobody did, of the rival; empty if there is neither.
        probability: the policy's, None if it has none.
        digits: how times of its scenario are written.
    """

    task: int
    name: str
    distance: float
    travel: float
    finish: float
    slack: float
    deadline: float
    reason: MaskReason
    status: Status
    taken_by: int | None
    done: float | None
    rival: int | None
    rival_finish: float | None
    who: str
    probability: float | None
    digits: Digits

    def __str__(self) -> str:
        """A remark on it: why it may not be chosen, or who else could do it."""
        time = self.digits.time
        if self.taken_by is not None and self.done is not None:
            doing = {
                Status.ASSIGNED: f"{self.who} on it until {time(self.done)}",
                Status.COMPLETED: f"done by {self.who} at {time(self.done)}",
                Status.MISSED: f"late by {self.who} at {time(self.done)}",
            }
            return doing.get(self.status, f"taken by {self.who}")
        if self.reason == MaskReason.DEADLINE_PASSED:
            return "deadline passed"
        if self.reason == MaskReason.TOO_LATE:
            return f"too late by {time(-self.slack)}" if self.slack < 0 else "too late"
        if self.reason == MaskReason.RULED_OUT:
            return "ruled out"
        late = f"late by {time(-self.slack)}; " if self.slack < 0 else ""
        if self.rival is None or self.rival_finish is None:
            return late + "nobody else in time"
        return late + f"{self.who} could by {time(self.rival_finish)}"


def outlook(
    mission: Mission,
    robot: int,
    probabilities: Mapping[int, float] | None = None,
    tasks: Sequence[int] | None = None,
) -> list[Prospect]:
    """Every task as `robot` sees it when it is next free, in order of index.

    Args:
        mission: as it stands.
        robot: the robot.
        probabilities: its policy's, by task.
        tasks: only these, in this order.

    Raises:
        ConfigError: if there is no such robot.
    """
    mission, scenario = mission.known(robot), mission.scenario
    if not 0 <= robot < scenario.num_robots:
        raise ConfigError(f"there is no robot {robot}; expected a number from 0 to {scenario.num_robots - 1}")
    which = np.arange(scenario.num_tasks) if tasks is None else np.array(tasks, dtype=np.intp)
    dx, dy = (scenario.task_xy[which] - mission.position[robot]).T
    travel = travel_time(dx, dy, scenario.speed[robot], np.sqrt)
    finish, deadline = mission.finish_if[robot, which], scenario.deadline[which]
    # Which of the others could finish first; retired robots cannot.
    others = mission.finish_if[:, which]
    others[np.array(mission.retired)] = np.inf
    others[robot] = np.inf
    others[others > deadline] = np.inf
    rival, soonest = others.argmin(axis=0), others.min(axis=0)
    given, digits = probabilities or {}, Digits.of(scenario)
    columns = zip(
        which.tolist(), np.hypot(dx, dy).tolist(), travel.tolist(), finish.tolist(), (deadline - finish).tolist(),
        deadline.tolist(), mission.reasons[robot, which].tolist(), mission.status[which].tolist(),
        mission.taken_by[which].tolist(), mission.finish[which].tolist(), rival.tolist(), soonest.tolist(), strict=True,
    )  # fmt: skip
    return [
        Prospect(
            task=task,
            name=scenario.task_name(task),
            distance=distance,
            travel=time,
            finish=end,
            slack=slack,
            deadline=due,
            reason=_REASONS[reason],
            status=_STATUSES[status],
            taken_by=taken_by if taken_by >= 0 else None,
            done=done if taken_by >= 0 else None,
            rival=who if taken_by < 0 and first < np.inf else None,
            rival_finish=first if taken_by < 0 and first < np.inf else None,
            who=scenario.robot_name(taken_by if taken_by >= 0 else who) if taken_by >= 0 or first < np.inf else "",
            probability=None if probabilities is None else given.get(task, 0.0),
            digits=digits,
        )
        for task, distance, time, end, slack, due, reason, status, taken_by, done, who, first in columns
    ]


def ranked(prospects: list[Prospect], by: SortKey = "rank") -> list[Prospect]:
    """The tasks in order, ties by index.

    Raises:
        ConfigError: if there is no such order.
    """
    if by not in get_args(SortKey):
        raise ConfigError(f"there is no order {by!r}; expected one of {', '.join(get_args(SortKey))}")
    if by != "rank":
        # What may be chosen comes first, except in the order by number.
        return sorted(
            prospects, key=lambda each: (by != "task" and each.reason != MaskReason.CHOOSABLE, getattr(each, by))
        )
    return sorted(
        prospects,
        key=lambda each: (
            _AFTER.index(each.reason), -(each.probability or 0.0), _over(each.status), each.finish,
        ),
    )  # fmt: skip


def _over(status: Status) -> bool:
    return status in (Status.COMPLETED, Status.MISSED)
