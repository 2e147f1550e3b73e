"""All the sets of tasks that one robot can complete, each with the order that finishes it earliest.

Dynamic programming over (set, last task), as Held and Karp did for the travelling salesman ("A dynamic programming
approach to sequencing problems", 1962). Times are the same to the bit as those of `rules` and the
verifier. As floating-point addition is monotone, a robot that finishes a task no later than another finishes all that
follows no later, even where a deadline is met exactly. So only the earliest finish has to be kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from mrta_zoo.policies.stop import TimeLimit
from mrta_zoo.reach import BoolArray, first_finish
from mrta_zoo.rules import travel_time, visit
from mrta_zoo.scenario import FloatArray, Scenario

IntArray = npt.NDArray[np.int64]

MOST_TASKS = 63
"""Sets are the bits of an integer."""
ROUNDING = 1e-9
"""Relative; far above what rounding can add to a finish time."""


@dataclass(frozen=True, slots=True)
class TaskSets:
    """Sets of tasks that a robot can complete, as routes.

    Attributes:
        routes: (S, L) tasks in the order that finishes the set earliest, padded with -1; the longest first.
        all_found: whether every set that the robot can complete is among them, or part of one of them.
    """

    routes: IntArray
    all_found: bool


@dataclass(frozen=True, slots=True)
class _Layer:
    """The states with k tasks, in which a robot has completed a set and stands at its last task.

    Attributes:
        tasks: (S,) the sets.
        last: (S,) the last task.
        finish: (S,) the earliest time at which that is finished.
        before: (S,) the state in the layer of k - 1 tasks that each comes from.
    """

    tasks: IntArray
    last: IntArray
    finish: FloatArray
    before: IntArray

    def __len__(self) -> int:
        return len(self.tasks)


def task_sets(
    scenario: Scenario, robot: int, *, only_largest: bool, max_states: int, limit: TimeLimit | None = None
) -> TaskSets:
    """The sets of tasks that `robot` can complete if it is alone.

    Args:
        scenario: the scenario.
        robot: which robot.
        only_largest: leave out the sets that are part of another.
        max_states: stop at more states than this, of 50 bytes each; the sets found so far have few tasks.
        limit: stop when the time is up, too.
    """
    reach = np.flatnonzero(within_reach(scenario, [robot])[0])
    if len(reach) > MOST_TASKS:
        return TaskSets(np.empty((0, 1), dtype=np.int64), all_found=False)
    x, y = scenario.task_xy[reach].T
    travel = travel_time(x[None, :] - x[:, None], y[None, :] - y[:, None], scenario.speed[robot], np.sqrt)
    work, deadline = scenario.workload[reach] / scenario.capacity[robot], scenario.deadline[reach]
    layers: list[_Layer] = []
    layer: _Layer | None = _first(first_finish(scenario, [robot])[0, reach], deadline)
    states = 0
    while layer is not None and len(layer):
        layers.append(layer)
        states += len(layer)
        layer = _next(layer, travel, work, deadline, max_states - states, limit)
    routes = []
    for size in range(len(layers), 0, -1):
        chosen = _earliest_of_each(layers[size - 1].tasks, layers[size - 1].finish)
        if only_largest and size < len(layers):
            chosen = chosen[~_part_of(layers[size - 1].tasks[chosen], layers[size].tasks, len(reach))]
        routes.append(_routes(layers[:size], chosen, reach, len(layers)))
    none = np.empty((0, 1), dtype=np.int64)
    return TaskSets(np.concatenate(routes) if routes else none, all_found=layer is not None)


def within_reach(scenario: Scenario, robots: Sequence[int] | slice = slice(None)) -> BoolArray:
    """(M, N) the tasks that each robot may be able to complete: those that it can finish first, up to rounding."""
    return first_finish(scenario, robots) <= scenario.deadline * (1 + ROUNDING)


def _first(finish: FloatArray, deadline: FloatArray) -> _Layer:
    """The states with one task."""
    tasks = np.flatnonzero(finish <= deadline)
    return _Layer(np.left_shift(1, tasks), tasks, finish[tasks], np.zeros_like(tasks))


def _next(
    layer: _Layer, travel: FloatArray, work: FloatArray, deadline: FloatArray, room: int, limit: TimeLimit | None
) -> _Layer | None:
    """The states with one more task; None if there is no time or room for them."""
    grown: list[_Layer] = []
    for task in range(len(deadline)):
        if limit is not None and limit.over:
            return None
        finish = visit(layer.finish, travel[layer.last, task], work[task]).finishes
        before = np.flatnonzero((finish <= deadline[task]) & (layer.tasks >> task & 1 == 0))
        tasks, finish = layer.tasks[before] | 1 << task, finish[before]
        keep = _earliest_of_each(tasks, finish)
        grown.append(_Layer(tasks[keep], np.full(len(keep), task), finish[keep], before[keep]))
        room -= len(keep)
        if room < 0:
            return None
    return _Layer(
        np.concatenate([part.tasks for part in grown]),
        np.concatenate([part.last for part in grown]),
        np.concatenate([part.finish for part in grown]),
        np.concatenate([part.before for part in grown]),
    )


def _earliest_of_each(tasks: IntArray, finish: FloatArray) -> IntArray:
    """For each set in `tasks`, in order, the index of the first entry that finishes earliest."""
    if len(tasks) == 0:
        return np.empty(0, dtype=np.int64)
    order = np.argsort(tasks, kind="stable")  # fast: a few runs that are sorted already
    finish = finish[order]
    new = np.diff(tasks[order], prepend=-1) != 0
    least = np.minimum.reduceat(finish, np.flatnonzero(new))
    which = np.cumsum(new) - 1
    best = np.flatnonzero(finish == least[which])
    first: IntArray = order[best[np.diff(which[best], prepend=-1) != 0]]
    return first


def _part_of(smaller: IntArray, larger: IntArray, bits: int) -> npt.NDArray[np.bool_]:
    """Which of the sorted sets `smaller` are a set of `larger` without one of its tasks."""
    part = np.zeros(len(smaller), dtype=np.bool_)
    larger = np.unique(larger)
    for bit in range(bits):
        without = larger[larger >> bit & 1 == 1] ^ 1 << bit
        place = np.minimum(np.searchsorted(smaller, without), len(smaller) - 1)
        part[place[smaller[place] == without]] = True
    return part


def _routes(layers: list[_Layer], chosen: IntArray, reach: IntArray, length: int) -> IntArray:
    """(S, length) the tasks of the `chosen` states of the last layer, in order, padded with -1."""
    routes = np.full((len(chosen), length), -1, dtype=np.int64)
    for position in range(len(layers) - 1, -1, -1):
        routes[:, position] = reach[layers[position].last[chosen]]
        chosen = layers[position].before[chosen]
    return routes
