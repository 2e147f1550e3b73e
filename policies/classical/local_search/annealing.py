"""Perturbation, refilling and acceptance as in simulated annealing: the compiled part of the EILS-style search."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from mrta_zoo.policies.classical.local_search.compiled import compiled
from mrta_zoo.policies.classical.local_search.insertion import fill, fill_by_deadline
from mrta_zoo.policies.classical.local_search.problem import Problem
from mrta_zoo.policies.classical.local_search.tours import Tours, copy_tour, copy_tours, remove, total_time
from mrta_zoo.scenario import FloatArray


class Annealing(NamedTuple):
    """The state of a search. All of it is changed in place.

    Attributes:
        current: the tours that the search has accepted.
        trial: a copy of them between iterations, and the tours on trial within one.
        best: the tours with the most visits so far.
        shift: (M, N) scratch space.
        weight: (N,) scratch space.
    """

    current: Tours
    trial: Tours
    best: Tours
    shift: FloatArray
    weight: FloatArray


class Moves(NamedTuple):
    """Parameters of the iterations at one temperature, with times in the scenario's units; see `eils.EilsConfig`.

    Attributes:
        temperature: a change for the worse by this much time is accepted with probability 1/e.
        removals: mean number of visits removed.
        noise: the weights of Shift lie between 1 and 1 + noise.
        by_deadline: share of the refills that go by deadline instead.
        blink: probability that such a refill does not offer a task to a tour.
        reward: time that a completed task is worth.
    """

    temperature: float
    removals: float
    noise: float
    by_deadline: float
    blink: float
    reward: float


@compiled
def anneal(problem: Problem, state: Annealing, iterations: int, moves: Moves, rng: np.random.Generator) -> None:
    """Some iterations of perturbation, refilling and acceptance at one temperature.

    Args:
        problem: the scenario.
        state: of the search, changed in place.
        iterations: how many.
        moves: their parameters.
        rng: of all draws.
    """
    m, n = problem.work.shape
    tours, trial, best, shift, weight = state
    changed = np.zeros(m, dtype=np.bool_)
    most = best.size.sum()
    value = moves.reward * tours.size.sum() - total_time(tours)
    for _ in range(iterations):
        changed[:] = False
        remove_strings(problem, trial, changed, moves.removals, rng)
        if moves.by_deadline > 0.0 and rng.random() < moves.by_deadline:  # where there is no choice, nothing is drawn
            fill_by_deadline(problem, trial, changed, moves.blink, rng)
        else:
            for task in range(n):
                if trial.robot[task] < 0:
                    weight[task] = 1.0 + moves.noise * rng.random()
            fill(problem, trial, shift, changed, weight)
        new_value = moves.reward * trial.size.sum() - total_time(trial)
        if new_value > value + moves.temperature * math.log(1.0 - rng.random()):
            value = new_value
            for robot in range(m):
                if changed[robot]:
                    copy_tour(trial, tours, robot)
            tours.robot[:] = trial.robot
            if tours.size.sum() > most:
                most = tours.size.sum()
                copy_tours(tours, best)
        else:
            for robot in range(m):
                if changed[robot]:
                    copy_tour(tours, trial, robot)
            trial.robot[:] = tours.robot


@compiled
def remove_strings(
    problem: Problem, tours: Tours, changed: npt.NDArray[np.bool_], removals: float, rng: np.random.Generator
) -> None:
    """Remove a string of visits from each of some tours that pass near a random task, and mark those tours.

    Lengths and number of strings are drawn as in Christiaens and Vanden Berghe (2020), §5.1: no longer than the mean
    tour, with `removals` visits in all on average.
    """
    visits = tours.size.sum()
    if visits == 0:
        return
    longest = max(min(removals, visits / len(tours.size)), 1.0)
    strings = int(rng.random() * (4.0 * removals / (1.0 + longest) - 1.0)) + 1
    centre = int(rng.random() * len(problem.deadline))
    for index in range(-1, problem.neighbours.shape[1]):
        task = centre if index < 0 else problem.neighbours[centre, index]
        robot = tours.robot[task]
        if robot < 0 or changed[robot]:
            continue
        size, position = tours.size[robot], 0
        while tours.tasks[robot, position] != task:
            position += 1
        length = int(rng.random() * min(size, longest)) + 1
        earliest, latest = max(0, position - length + 1), min(position, size - length)
        remove(problem, tours, robot, earliest + int(rng.random() * (latest - earliest + 1)), length)
        changed[robot] = True
        strings -= 1
        if strings == 0:
            break
