"""The insertion step of ILS: put unvisited tasks where they cost the least time, until nothing fits."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from numba import njit

from mrta_zoo.policies.local_search.problem import TOLERANCE, Problem
from mrta_zoo.policies.local_search.tours import Tours, insert
from mrta_zoo.scenario import FloatArray


@njit(cache=True)
def fill(
    problem: Problem, tours: Tours, shift: FloatArray, open_tours: npt.NDArray[np.bool_], weight: FloatArray
) -> None:
    """Insert the task and position with the least weighted Shift, again and again, until nothing fits.

    With equal scores for all tasks, the greatest score² / Shift of ILS is the least Shift. Ties go to the lowest
    robot, then the lowest task.

    Args:
        problem: the scenario.
        tours: is filled.
        shift: (M, N) scratch space, for the least Shift of each task in each tour.
        open_tours: (M,) the tours that may get tasks.
        weight: (N,) > 0, what the Shift of each task is multiplied by.
    """
    m = len(problem.speed)
    best_task, best_value = np.full(m, -1), np.full(m, np.inf)
    for robot in range(m):
        if open_tours[robot]:
            _look_up(problem, tours, shift, robot)
            best_task[robot], best_value[robot] = _choose(tours, shift, robot, weight)
    while True:
        winner = int(best_value.argmin())
        if best_value[winner] == np.inf:
            break
        task = best_task[winner]
        inserted = insert(problem, tours, task, winner, _best_position(problem, tours, task, winner))
        position = 0
        while not inserted and position <= tours.size[winner]:  # the look-up was wrong by a rounding error
            inserted = insert(problem, tours, task, winner, position)
            position += 1
        if inserted:
            _look_up(problem, tours, shift, winner)
        else:
            shift[winner, task] = np.inf
        for other in range(m):
            if other == winner or (inserted and best_task[other] == task):
                best_task[other], best_value[other] = _choose(tours, shift, other, weight)


@njit(cache=True)
def _choose(tours: Tours, shift: FloatArray, robot: int, weight: FloatArray) -> tuple[int, float]:
    """The unvisited task with the least weighted Shift in a tour, and that; (-1, inf) if none fits."""
    chosen, least = -1, np.inf
    for task in range(len(weight)):
        value = shift[robot, task] * weight[task]
        if value < least and tours.robot[task] < 0:
            chosen, least = task, value
    return chosen, least


@njit(cache=True)
def _look_up(problem: Problem, tours: Tours, shift: FloatArray, robot: int) -> None:
    """Find the least Shift of every task in a tour, inf where it does not fit.

    What comes out for tasks that are visited already has no meaning.
    """
    least, work, latest = shift[robot], problem.work[robot], problem.latest[robot]
    pace, size = 1.0 / problem.speed[robot], tours.size[robot]
    place, ready = len(work) + robot, 0.0
    least[:] = np.inf
    tolerance = TOLERANCE * tours.finish[robot, size - 1] if size > 0 else 0.0
    # Tasks in the inner loop, no branches and few arrays there: that is compiled to vector instructions.
    for position in range(size):
        following = tours.tasks[robot, position]
        to, onward = problem.distance[place], problem.distance[following]
        leg, slack = tours.leg[robot, position], tours.max_shift[robot, position] + tolerance
        for task in range(len(work)):
            new = max((to[task] + onward[task]) * pace + work[task] - leg, 0.0)
            fits = (ready + to[task] * pace <= latest[task]) & (new <= slack)
            least[task] = min(least[task], new if fits else np.inf)
        place, ready = following, tours.finish[robot, position]
    to = problem.distance[place]
    for task in range(len(work)):
        fits = ready + to[task] * pace <= latest[task]
        least[task] = min(least[task], to[task] * pace + work[task] if fits else np.inf)


@njit(cache=True)
def _best_position(problem: Problem, tours: Tours, task: int, robot: int) -> int:
    """The position in a tour at which a task that fits there has the least Shift."""
    pace, size = 1.0 / problem.speed[robot], tours.size[robot]
    work, latest = problem.work[robot, task], problem.latest[robot, task]
    place, ready = len(problem.deadline) + robot, 0.0
    least = np.inf
    best: int = size
    for position in range(size):
        following = tours.tasks[robot, position]
        to, onward = problem.distance[place, task], problem.distance[following, task]
        shift = max((to + onward) * pace + work - tours.leg[robot, position], 0.0)
        fits = shift <= tours.max_shift[robot, position] + TOLERANCE * tours.finish[robot, size - 1]
        if fits and ready + to * pace <= latest and shift < least:
            least, best = shift, position
        place, ready = following, tours.finish[robot, position]
    to = problem.distance[place, task] * pace
    if ready + to <= latest and to + work < least:
        best = size
    return best
