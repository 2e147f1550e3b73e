"""Iterated local search for TAPTC, after ILS for the team orienteering problem with time windows.

Source: P. Vansteenwegen, W. Souffriau, G. Vanden Berghe, D. Van Oudheusden, "Iterated local search for the team
orienteering problem with time windows", Computers & Operations Research 36 (2009). The paper compares with
an adaptation to TAPTC, which is inferred here: tours are open and start at the robot at time 0, windows are open from
the beginning, and every task has the score 1. It draws nothing at random.
"""

from __future__ import annotations

from functools import cache, partial

import numpy as np
import numpy.typing as npt

from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.local_search.compiled import compiled
from mrta_zoo.policies.classical.local_search.insertion import fill
from mrta_zoo.policies.classical.local_search.problem import Problem, make_problem, smallest_scenario
from mrta_zoo.policies.classical.local_search.tours import Tours, copy_tours, empty_tours, plan_of, remove
from mrta_zoo.policies.interruption import interruptible
from mrta_zoo.policies.stop import Cancellation, FirstOf, NoImprovement, StoppingCriterion, TimeLimit
from mrta_zoo.scenario import FloatArray, Scenario

ROUNDS_WITHOUT_IMPROVEMENT = 150
"""After so many the search ends (Vansteenwegen et al. 2009, §4)."""
CHUNK = 10
"""Rounds between two checks whether to stop."""

START, COUNT, IDLE = range(3)
"""Indices into the search's state: the shake's position S and length R, and the rounds without improvement."""


class IlsSolver:
    """Plans by iterated local search. The first instance compiles it: some 20 seconds on a new machine.

    Args:
        budget: seconds per scenario, > 0. By default the search ends after `ROUNDS_WITHOUT_IMPROVEMENT`, and the plan
            is the same on every machine.
    """

    def __init__(self, budget: float | None = None) -> None:
        self._budget = budget
        compile_once()

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        own = NoImprovement(ROUNDS_WITHOUT_IMPROVEMENT) if self._budget is None else TimeLimit.of(self._budget)
        cancellation = Cancellation()
        stop = FirstOf((own, cancellation))
        return interruptible(partial(_solve, scenario, stop), cancellation.cancel)


@cache
def compile_once() -> None:
    """Compile the search, so that no plan has to wait for it."""
    interruptible(partial(_solve, smallest_scenario(), NoImprovement(1)))


def _solve(scenario: Scenario, stop: StoppingCriterion) -> Plan:
    problem = make_problem(scenario)
    tours, best, shift = empty_tours(problem), empty_tours(problem), np.empty(problem.work.shape)
    state = np.array([0, 1, 0])
    rounds, progress = 0, 0.0
    while progress < 1.0:
        search(problem, tours, best, shift, state, CHUNK)
        rounds += CHUNK
        progress = stop.progress(rounds, int(state[IDLE]))
    return plan_of(best, scenario, "ils")


@compiled
def search(
    problem: Problem, tours: Tours, best: Tours, shift: FloatArray, state: npt.NDArray[np.int64], rounds: int
) -> None:
    """Some more rounds of insertion and shake. `tours`, `best` and `state` are changed in place.

    R starts again from 1 once it is floor(N / (3M)) (Vansteenwegen et al. 2009).
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
    """Remove `count` consecutive visits from every tour, from position `start` on, wrapping around at its end."""
    for robot in range(len(tours.size)):
        size = tours.size[robot]
        if size > 0:
            first, number = start % size, min(count, size)
            at_end = min(number, size - first)
            remove(problem, tours, robot, first, at_end)
            remove(problem, tours, robot, 0, min(number - at_end, tours.size[robot]))
