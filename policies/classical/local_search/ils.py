"""Iterated local search for TAPTC, after ILS for the team orienteering problem with time windows.

Source: P. Vansteenwegen, W. Souffriau, G. Vanden Berghe, D. Van Oudheusden, "Iterated local search for the team
orienteering problem with time windows", Computers & Operations Research 36 (2009). Its adaptation to TAPTC, which the
paper compares with, is inferred: tours are open, start at the robot at time 0, windows have no opening, and every task
has the score 1. Nothing in it is drawn at random.
"""

from __future__ import annotations

import time
from functools import cache, partial
from threading import Event

import numpy as np
import numpy.typing as npt

from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.local_search.compiled import compiled
from mrta_zoo.policies.classical.local_search.insertion import fill
from mrta_zoo.policies.classical.local_search.problem import Problem, make_problem, smallest_scenario
from mrta_zoo.policies.classical.local_search.tours import Tours, copy_tours, empty_tours, plan_of, remove
from mrta_zoo.policies.interruption import interruptible
from mrta_zoo.scenario import FloatArray, Scenario

ROUNDS_WITHOUT_IMPROVEMENT = 150
"""After so many the search ends (Vansteenwegen et al. 2009, §4)."""
CHUNK = 10
"""Rounds between two looks at the clock."""

START, COUNT, IDLE = range(3)
"""Where in the state the shake's position S and length R, and the number of rounds without improvement, stand."""


class IlsSolver:
    """Plans by iterated local search. Making the first one compiles it, some 20 seconds on a machine new to it.

    Args:
        budget: seconds a scenario, > 0; by default the search ends after `ROUNDS_WITHOUT_IMPROVEMENT`, and the plan
            does not depend on the machine.
    """

    def __init__(self, budget: float | None = None) -> None:
        self._budget = budget
        compile_once()

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        stopped = Event()
        return interruptible(partial(_solve, scenario, self._budget, stopped), stopped.set)


@cache
def compile_once() -> None:
    """Compile the search, so that no plan has to wait for it."""
    interruptible(partial(_solve, smallest_scenario(), None, Event()))


def _solve(scenario: Scenario, budget: float | None, stopped: Event) -> Plan:
    begun = time.perf_counter()
    problem = make_problem(scenario)
    tours, best, shift = empty_tours(problem), empty_tours(problem), np.empty(problem.work.shape)
    state = np.array([0, 1, 0])
    over = False
    while not over and not stopped.is_set():
        search(problem, tours, best, shift, state, CHUNK)
        idle = state[IDLE] >= ROUNDS_WITHOUT_IMPROVEMENT
        over = idle if budget is None else time.perf_counter() - begun >= budget
    return plan_of(best, scenario, "ils")


@compiled
def search(
    problem: Problem, tours: Tours, best: Tours, shift: FloatArray, state: npt.NDArray[np.int64], rounds: int
) -> None:
    """Some rounds of insertion and shake, going on from `tours` and `state`, which are changed as `best` is.

    R starts anew at floor(N / (3M)) (Vansteenwegen et al. 2009).
    """
    m, n = problem.work.shape
    changed, weight = np.empty(m, dtype=np.bool_), np.ones(n)
    for _ in range(rounds):
        changed[:] = True
        fill(problem, tours, shift, changed, weight)
        if tours.size.sum() > best.size.sum():
            copy_tours(tours, best)
            state[COUNT] = 1
            state[IDLE] = 0
        else:
            state[IDLE] += 1
        shake(problem, tours, state[START], state[COUNT])
        state[START] += state[COUNT]
        state[COUNT] += 1
        smallest = tours.size.min()
        if state[START] >= smallest:
            state[START] -= smallest
        if state[COUNT] >= n // (3 * m):
            state[COUNT] = 1


@compiled
def shake(problem: Problem, tours: Tours, start: int, count: int) -> None:
    """In every tour remove `count` consecutive visits from position `start` on, going on at its beginning."""
    for robot in range(len(tours.size)):
        size = tours.size[robot]
        if size > 0:
            first, number = start % size, min(count, size)
            at_end = min(number, size - first)
            remove(problem, tours, robot, first, at_end)
            remove(problem, tours, robot, 0, min(number - at_end, tours.size[robot]))
