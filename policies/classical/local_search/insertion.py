"""Insertion of unvisited tasks where they cost the least time: the cheapest first (ILS), or by deadline."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from mrta_zoo.policies.classical.local_search.compiled import compiled
from mrta_zoo.policies.classical.local_search.problem import TOLERANCE, Problem
from mrta_zoo.policies.classical.local_search.tours import Tours, insert
from mrta_zoo.scenario import FloatArray


class Insertions(NamedTuple):
    """The tasks that may be inserted, and what is known of where each fits best.

    Attributes:
        task: (U,) the unvisited tasks; as they get fewer, those that are left come first.
        weight: (N,) > 0, factor of the Shift of each task.
        shift: (M, N) a lower bound of the least Shift of each task in each tour.
        position: (M, N) where in the tour that Shift was found.
    """

    task: npt.NDArray[np.int64]
    weight: FloatArray
    shift: FloatArray
    position: npt.NDArray[np.int64]


@compiled
def fill(
    problem: Problem, tours: Tours, shift: FloatArray, open_tours: npt.NDArray[np.bool_], weight: FloatArray
) -> None:
    """Insert the task with the least weighted Shift at the position that has it, repeatedly, until nothing fits.

    With equal scores for all tasks, the greatest score² / Shift of ILS is the least Shift. Ties go to the lowest
    robot, then the lowest task.

    An insertion replaces one leg of a tour by two and leaves less room at all others. So known Shifts remain lower
    bounds once the two new legs are considered, and only the candidate with the least bound must be checked again.

    Args:
        problem: the scenario.
        tours: the tours to fill, changed in place.
        shift: (M, N) scratch space.
        open_tours: (M,) the tours that may get tasks.
        weight: (N,) > 0, factor of the Shift of each task.
    """
    m = len(problem.speed)
    best_task, best_value = np.full(m, -1), np.full(m, np.inf)
    place = np.empty(shift.shape, dtype=np.int64)
    over = False
    while not over:
        failed, over = False, True
        insertions = Insertions(np.flatnonzero(tours.robot < 0), weight, shift, place)
        unvisited = len(insertions.task)
        for robot in range(m):
            if open_tours[robot]:
                for index in range(unvisited):
                    task = insertions.task[index]
                    place[robot, task], shift[robot, task] = _best_position(problem, tours, task, robot)
                best_task[robot], best_value[robot] = _choose(insertions, unvisited, robot)
        while True:
            winner = int(best_value.argmin())
            if best_value[winner] == np.inf:
                break
            task = best_task[winner]
            position, least = _best_position(problem, tours, task, winner)
            if least > shift[winner, task]:  # there is less room than there was
                place[winner, task], shift[winner, task] = position, least
                best_task[winner], best_value[winner] = _choose(insertions, unvisited, winner)
                continue
            inserted = insert(problem, tours, task, winner, position)
            if not inserted:  # the look-up was wrong by a rounding error
                failed, position = True, _insert_anywhere(problem, tours, task, winner)
                inserted = position >= 0
            if inserted:
                over = not failed  # what has failed may fit now, by rounding: look everything up once more
                unvisited = _forget(insertions.task, unvisited, task)
                _look_up_legs(problem, tours, insertions, unvisited, winner, position)
            else:
                shift[winner, task] = np.inf
            for other in range(m):
                if other == winner or (inserted and best_task[other] == task):
                    best_task[other], best_value[other] = _choose(insertions, unvisited, other)


@compiled
def _insert_anywhere(problem: Problem, tours: Tours, task: int, robot: int) -> int:
    """Insert a task at the first position that takes it; which, or -1 if none does."""
    for position in range(tours.size[robot] + 1):
        if insert(problem, tours, task, robot, position):
            return position
    return -1


@compiled
def fill_by_deadline(
    problem: Problem, tours: Tours, open_tours: npt.NDArray[np.bool_], blink: float, rng: np.random.Generator
) -> None:
    """Insert the unvisited tasks, the earliest deadline first, each where its Shift is least, if it fits at all.

    This follows the recreate step of Christiaens and Vanden Berghe (2020), which inserts tasks in some order and
    "blinks". The order is ours, and a blink skips a whole tour, not a position.

    Args:
        problem: the scenario.
        tours: the tours to fill, changed in place.
        open_tours: (M,) the tours that may get tasks.
        blink: probability that a tour is skipped for a task.
        rng: of the blinks.
    """
    for task in problem.by_deadline:
        if tours.robot[task] >= 0:
            continue
        winner, place, least = -1, -1, np.inf
        for robot in range(len(problem.speed)):
            if open_tours[robot]:
                position, shift = _best_position(problem, tours, task, robot)
                if shift < least and rng.random() >= blink:
                    winner, place, least = robot, position, shift
        if winner >= 0:
            insert(problem, tours, task, winner, place)  # or not, if the look-up was wrong by a rounding error


@compiled
def _forget(free: npt.NDArray[np.int64], unvisited: int, task: int) -> int:
    """Remove `task` from the first `unvisited` of `free`; how many are left."""
    position = 0
    while free[position] != task:
        position += 1
    for index in range(position, unvisited - 1):
        free[index] = free[index + 1]
    return unvisited - 1


@compiled
def _choose(insertions: Insertions, unvisited: int, robot: int) -> tuple[int, float]:
    """Of the first `unvisited` tasks that with the least weighted Shift, and this; (-1, inf) if none fits."""
    chosen, least = -1, np.inf
    for index in range(unvisited):
        task = insertions.task[index]
        value = insertions.shift[robot, task] * insertions.weight[task]
        if value < least:
            chosen, least = task, value
    return chosen, least


@compiled
def _look_up_legs(
    problem: Problem, tours: Tours, insertions: Insertions, unvisited: int, robot: int, first: int
) -> None:
    """Update a tour's Shifts and positions for the visit just inserted at position `first`.

    Args:
        problem: the scenario.
        tours: the tours, with the visit.
        insertions: whose rows of `robot` are updated.
        unvisited: how many of their tasks are left.
        robot: whose tour it is.
        first: position of the visit.
    """
    shift, place = insertions.shift, insertions.position
    distance, pace, size = problem.distance, 1.0 / problem.speed[robot], tours.size[robot]
    before, ready = len(problem.deadline) + robot, 0.0
    if first > 0:
        before, ready = tours.tasks[robot, first - 1], tours.finish[robot, first - 1]
    new, new_leg, finish = tours.tasks[robot, first], tours.leg[robot, first], tours.finish[robot, first]
    tolerance = TOLERANCE * tours.finish[robot, size - 1]
    slack = tours.max_shift[robot, first] + tolerance
    after, after_leg, after_slack = -1, 0.0, np.inf
    if first + 1 < size:
        after, after_leg = tours.tasks[robot, first + 1], tours.leg[robot, first + 1]
        after_slack = tours.max_shift[robot, first + 1] + tolerance
    for index in range(unvisited):
        task = insertions.task[index]
        if place[robot, task] == first:  # on the leg that is gone
            place[robot, task], shift[robot, task] = _best_position(problem, tours, task, robot)
            continue
        if place[robot, task] > first:
            place[robot, task] += 1
        work, latest = problem.work[robot, task], problem.latest[robot, task]
        to, between = distance[before, task] * pace, distance[new, task] * pace
        least = max(to + between + work - new_leg, 0.0)
        if least < shift[robot, task] and least <= slack and ready + to <= latest:
            place[robot, task], shift[robot, task] = first, least
        onward = distance[after, task] * pace if after >= 0 else 0.0
        least = max(between + onward + work - after_leg, 0.0)
        if least < shift[robot, task] and least <= after_slack and finish + between <= latest:
            place[robot, task], shift[robot, task] = first + 1, least


@compiled
def _best_position(problem: Problem, tours: Tours, task: int, robot: int) -> tuple[int, float]:
    """The position in a tour at which a task has the least Shift, and that; inf if it fits nowhere."""
    between = problem.distance
    pace, size = 1.0 / problem.speed[robot], tours.size[robot]
    work, latest = problem.work[robot, task], problem.latest[robot, task]
    tolerance = TOLERANCE * tours.finish[robot, size - 1] if size > 0 else 0.0
    best, least = -1, np.inf
    to, ready = between[len(problem.deadline) + robot, task] * pace, 0.0
    for position in range(size):
        if ready + to > latest:  # nor is it in time after any later visit
            return best, least
        onward = between[task, tours.tasks[robot, position]] * pace
        shift = max(to + onward + work - tours.leg[robot, position], 0.0)
        if shift < least and shift <= tours.max_shift[robot, position] + tolerance:
            best, least = position, shift
        to, ready = onward, tours.finish[robot, position]
    if ready + to <= latest and to + work < least:
        best, least = size, to + work
    return best, least
