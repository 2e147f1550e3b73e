"""The dynamics of one mission: which robot acts next, what it may choose, and what follows from its choice."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from mrta_zoo.digits import full
from mrta_zoo.errors import ActionError
from mrta_zoo.rules import (
    MASK_RULES,
    MaskReason,
    MaskRule,
    Status,
    check_mask_rule,
    next_event,
    task_cost,
    travel_time,
    visit,
)
from mrta_zoo.scenario import FloatArray, Scenario

BoolArray = npt.NDArray[np.bool_]
ReasonArray = npt.NDArray[np.int8]

# As plain integers, which are faster to look up and compare than members of an enumeration.
_ACTIVE, _ASSIGNED, _COMPLETED, _MISSED = (int(status) for status in Status)
# Arrays without dimensions, which NumPy compares with others in half the time that integers take.
_CHOOSABLE, _TAKEN, _DEADLINE_PASSED = (np.array(reason, np.int8) for reason in list(MaskReason)[:3])


@dataclass(frozen=True, slots=True)
class Finished:
    """A robot finished a task while the clock moved on."""

    robot: int
    task: int
    time: float
    completed: bool
    """Whether it finished by the deadline."""


class Mission:
    """A scenario under way. Event-driven: the robot that is free first acts next, ties to the lowest index.

    >>> mission = Mission(scenario)
    >>> while not mission.done:
    ...     mission.assign(int(mission.mask(mission.actor).argmax()))

    Attributes:
        scenario: the scenario.
        mask_rule: which untaken tasks a robot may choose, see `rules.MaskRule`.
        time: the mission clock, in time units; at the end, the makespan.
        actor: the robot to act now, or -1 when the mission is over.
        ready: M floats, when each robot is (or will be) free.
        position: (M, 2) where each robot is, or is heading for.
        routes: for each robot the tasks it has taken, in order.
        heading: for each robot the task it is heading for or working on, or -1.
        retired: for each robot whether it was free and found nothing left to choose, or stayed.
        taken_by: (N,) the robot that took each task, or -1.
        finish: (N,) when each taken task is finished; infinite for the others.
        status: (N,) int8 `rules.Status` of each task at `time`.
        finish_if: (M, N) when each robot would finish each task if it took it next.
        reasons: (M, N) int8 `rules.MaskReason`: whether each robot may choose each task when it is next free, and why
            not, as far as is known now.
    """

    def __init__(self, scenario: Scenario, mask_rule: MaskRule = "feasible") -> None:
        check_mask_rule(mask_rule)
        n, m = scenario.num_tasks, scenario.num_robots
        self.scenario = scenario
        self.mask_rule: MaskRule = mask_rule
        self.time = 0.0
        self.actor = -1
        self.ready = [0.0] * m
        self.position: FloatArray = scenario.robot_xy.copy()
        self.routes: list[list[int]] = [[] for _ in range(m)]
        self.heading = [-1] * m
        self.retired = [False] * m
        self.taken_by = np.full(n, -1, dtype=np.int64)
        self.finish: FloatArray = np.full(n, np.inf)
        self.status = np.full(n, _ACTIVE, dtype=np.int8)
        self.finish_if: FloatArray = np.empty((m, n))
        self.reasons: ReasonArray = np.full((m, n), _CHOOSABLE, dtype=np.int8)
        order = np.argsort(scenario.deadline, kind="stable")
        self._by_deadline = list(zip(scenario.deadline[order].tolist(), order.tolist(), strict=True))
        self._refused = np.array(MASK_RULES[mask_rule].reason, np.int8)
        self._passed = 0  # how many of `_by_deadline` lie before the clock
        self._x, self._y = np.ascontiguousarray(scenario.task_xy.T)
        self._work: FloatArray = scenario.workload[None, :] / scenario.capacity[:, None]
        for robot in range(m):
            self._look_ahead(robot)
        self.advance()

    @property
    def done(self) -> bool:
        """Whether every robot is retired."""
        return self.actor < 0

    def mask(self, robot: int) -> BoolArray:
        """(N,) what `robot` may choose when it is next free, as far as it knows now."""
        mask: BoolArray = self.known(robot).reasons[robot] == _CHOOSABLE
        return mask

    def known(self, robot: int) -> Mission:
        """The mission as `robot` knows it, today all of it; masks, observations and advice are made from this."""
        return self

    def free(self) -> list[int]:
        """The robots that are free now and have something to choose, in index order.

        A robot that took a task since the last `advance` is not among them, even if the task needs no time.
        """
        return [
            robot
            for robot, ready in enumerate(self.ready)
            if ready == self.time and not self.retired[robot] and self.heading[robot] < 0 and self.mask(robot).any()
        ]

    def assign(self, task: int) -> list[Finished]:
        """Let the acting robot take `task` and move the clock on to the next actor.

        Returns:
            What was finished on the way, in order of time, then robot.

        Raises:
            ActionError: if the mission is over or the robot may not choose this task.
        """
        self.take(self.actor, task)
        return self.advance()

    def stay(self) -> list[Finished]:
        """Let the acting robot retire although it may choose, and move the clock on to the next actor.

        Agents of the environment cannot do this; a plan can, when it ends a robot's route.

        Returns:
            What was finished on the way, as `assign` does.

        Raises:
            ActionError: if the mission is over.
        """
        if self.actor < 0:
            raise ActionError("a robot was to stay, but the mission is over: every robot is retired")
        self.retired[self.actor] = True
        return self.advance()

    def take(self, robot: int, task: int) -> None:
        """Let a free `robot` take `task`, without moving the clock on (for robots that choose at once).

        Raises:
            ActionError: if the robot is not free, or may not choose this task.
        """
        self._check(robot, task)
        place = self.scenario.task_xy[task]
        finish = float(self.finish_if[robot, task])
        self.reasons[:, task] = _TAKEN
        self.taken_by[task] = robot
        self.finish[task] = finish
        self.status[task] = _ASSIGNED
        self.routes[robot].append(task)
        self.heading[robot] = task
        self.position[robot] = place
        self.ready[robot] = finish
        self._look_ahead(robot)

    def advance(self) -> list[Finished]:
        """Move the clock to the next robot that is free and has a choice, retiring those that have none.

        Returns:
            What was finished on the way, in order of time, then robot.
        """
        while True:
            time, robot = next_event(self.ready, self.retired, _where, _least)
            if time == math.inf:
                self.actor = -1
                break
            self.time, self.actor = time, robot
            if np.count_nonzero(self.mask(robot)):
                break
            self.retired[robot] = True
        return self._finish_until(self.time)

    def cost(self) -> float:
        """The objective so far, Eq. 1 of the paper; final once the mission is `done`."""
        terms = task_cost(self.finish, self.scenario.deadline, self.time, np.where, np.maximum)
        return float(np.sum(terms))

    def completed(self) -> int:
        """Number of taken tasks that finish by their deadline, including those still under way."""
        return int(np.count_nonzero(self.finish <= self.scenario.deadline))

    def _look_ahead(self, robot: int) -> None:
        scenario, ready = self.scenario, self.ready[robot]
        dx, dy = self._x - self.position[robot, 0], self._y - self.position[robot, 1]
        travel = travel_time(dx, dy, scenario.speed[robot], np.sqrt)
        finish = visit(ready, travel, self._work[robot]).finishes
        self.finish_if[robot] = finish
        reasons = self.reasons[robot]
        taken = reasons == _TAKEN
        reasons.fill(self._refused)
        np.putmask(reasons, scenario.deadline < ready, _DEADLINE_PASSED)
        np.putmask(reasons, MASK_RULES[self.mask_rule].allows(finish, ready, scenario.deadline), _CHOOSABLE)
        np.putmask(reasons, taken, _TAKEN)

    def _finish_until(self, time: float) -> list[Finished]:
        finished = []
        deadline = self.scenario.deadline
        for robot, task in enumerate(self.heading):
            if task >= 0 and self.ready[robot] <= time:
                completed = bool(self.ready[robot] <= deadline[task])
                self.status[task] = _COMPLETED if completed else _MISSED
                self.heading[robot] = -1
                finished.append(Finished(robot, task, self.ready[robot], completed))
        if len(finished) > 1:
            finished.sort(key=lambda event: (event.time, event.robot))
        while self._passed < len(self._by_deadline):
            latest, task = self._by_deadline[self._passed]
            if latest >= time:
                break
            if self.status[task] == _ACTIVE:
                self.status[task] = _MISSED
            self._passed += 1
        return finished

    def _check(self, robot: int, task: int) -> None:
        if self.actor < 0:
            raise ActionError(f"task {task} was chosen, but the mission is over: every robot is retired")
        name, named = self.scenario.robot_label, self.scenario.task_label
        robots, tasks = self.reasons.shape
        if not 0 <= robot < robots:
            raise ActionError(f"there is no robot {robot}; the scenario has {robots}")
        if self.retired[robot] or self.ready[robot] != self.time:
            raise ActionError(
                f"robot {name(robot)} is not free at time {full(self.time)}; robot {name(self.actor)} is to act"
            )
        if self.heading[robot] >= 0:
            raise ActionError(
                f"robot {name(robot)} has just taken task {named(self.heading[robot])} and cannot take task {task} "
                "too; advance the mission first"
            )
        if not 0 <= task < tasks:
            raise ActionError(f"robot {name(robot)} chose task {task}; tasks are numbered 0 to {tasks - 1}")
        if (why := self.known(robot).reasons[robot, task]) != _CHOOSABLE:
            reason = MaskReason(why).name.lower().replace("_", " ")
            choices = np.flatnonzero(self.mask(robot)).tolist()
            shown = ", ".join(map(named, choices[:10])) + (", …" if len(choices) > 10 else "")
            raise ActionError(
                f"robot {name(robot)} may not choose task {named(task)} at time {full(self.time)}: {reason}; "
                f"its choices are {shown or 'none'}"
            )


# For lists, which are faster than arrays while there are few robots.
def _where(condition: list[bool], value: float, others: list[float]) -> list[float]:
    return [value if holds else other for holds, other in zip(condition, others, strict=True)]


def _least(values: list[float]) -> tuple[float, int]:
    least = min(values)
    return least, values.index(least)
