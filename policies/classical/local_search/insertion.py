"""Putting unvisited tasks where they cost the least time: always the cheapest (ILS), or one by one, by deadline."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from mrta_zoo.policies.classical.local_search.compiled import compiled
from mrta_zoo.policies.classical.local_search.problem import TOLERANCE, Problem
from mrta_zoo.policies.classical.local_search.tours import Tours, insert
from mrta_zoo.scenario import FloatArray


@compiled
def fill(
    problem: Problem, tours: Tours, shift: FloatArray, open_tours: npt.NDArray[np.bool_], weight: FloatArray
) -> None:
    """Insert the task and position with the least weighted Shift, again and again, until nothing fits.

    With equal scores for all tasks, the greatest score² / Shift of ILS is the least Shift. Ties go to the lowest
    robot, then the lowest task.

    An insertion takes a leg from a tour, gives it two, and leaves less room at all others. So what was looked up stays
    a lower bound if the two are looked up as well, and only what a bound says is best must be looked up once more.

    Args:
        problem: the scenario.
        tours: is filled.
        shift: (M, N) scratch space, for a lower bound of the least Shift of each task in each tour.
        open_tours: (M,) the tours that may get tasks.
        weight: (N,) > 0, what the Shift of each task is multiplied by.
    """
    m = len(problem.speed)
    best_task, best_value = np.full(m, -1), np.full(m, np.inf)
    place = np.empty(shift.shape, dtype=np.int64)
    over = False
    while not over:
        failed, over = False, True
        free = np.flatnonzero(tours.robot < 0)
        unvisited = len(free)
        for robot in range(m):
            if open_tours[robot]:
                for index in range(unvisited):
                    task = free[index]
                    place[robot, task], shift[robot, task] = _best_position(problem, tours, task, robot)
                best_task[robot], best_value[robot] = _choose(shift, robot, weight, free, unvisited)
        while True:
            winner = int(best_value.argmin())
            if best_value[winner] == np.inf:
                break
            task = best_task[winner]
            position, least = _best_position(problem, tours, task, winner)
            if least > shift[winner, task]:  # there is less room than there was
                place[winner, task], shift[winner, task] = position, least
                best_task[winner], best_value[winner] = _choose(shift, winner, weight, free, unvisited)
                continue
            inserted = insert(problem, tours, task, winner, position)
            if not inserted:  # the look-up was wrong by a rounding error
                failed = True
                position = -1
                while not inserted and position < tours.size[winner]:
                    position += 1
                    inserted = insert(problem, tours, task, winner, position)
            if inserted:
                over = not failed  # what has failed may fit now, by rounding: look everything up once more
                unvisited = _forget(free, unvisited, task)
                _look_up_legs(problem, tours, shift, place, winner, position, free, unvisited)
            else:
                shift[winner, task] = np.inf
            for other in range(m):
                if other == winner or (inserted and best_task[other] == task):
                    best_task[other], best_value[other] = _choose(shift, other, weight, free, unvisited)


@compiled
def fill_by_deadline(
    problem: Problem, tours: Tours, open_tours: npt.NDArray[np.bool_], blink: float, rng: np.random.Generator
) -> None:
    """Insert the unvisited tasks, the earliest deadline first, each where its Shift is least, if it fits at all.

    After the recreation of Christiaens and Vanden Berghe (2020), which inserts in an order and "blinks"; the order is
    ours, and a blink passes over a whole tour, not a position.

    Args:
        problem: the scenario.
        tours: is filled.
        open_tours: (M,) the tours that may get tasks.
        blink: probability with which a task is not offered to a tour.
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
    """Take `task` from the first `unvisited` of `free`, and give how many are left."""
    position = 0
    while free[position] != task:
        position += 1
    for index in range(position, unvisited - 1):
        free[index] = free[index + 1]
    return unvisited - 1


@compiled
def _choose(
    shift: FloatArray, robot: int, weight: FloatArray, free: npt.NDArray[np.int64], unvisited: int
) -> tuple[int, float]:
    """Of the first `unvisited` of `free`, the least weighted Shift's task, and that; (-1, inf) if none fits."""
    chosen, least = -1, np.inf
    for index in range(unvisited):
        task = free[index]
        value = shift[robot, task] * weight[task]
        if value < least:
            chosen, least = task, value
    return chosen, least


@compiled
def _look_up_legs(
    problem: Problem,
    tours: Tours,
    shift: FloatArray,
    place: npt.NDArray[np.int64],
    robot: int,
    first: int,
    free: npt.NDArray[np.int64],
    unvisited: int,
) -> None:
    """Bring a tour's rows of `shift` and `place` up to date with a visit inserted at position `first`.

    Args:
        problem: the scenario.
        tours: the tours.
        shift: (M, N) lower bounds of the least Shift of each task.
        place: (M, N) the position that each bound is for.
        robot: whose tour.
        first: where its new visit is.
        free: of which the first `unvisited` are looked at.
        unvisited: how many.
    """
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
        task = free[index]
        if place[robot, task] == first:  # on the leg that is no more
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
