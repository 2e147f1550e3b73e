"""EILS-style search: the insertion step of ILS with an enhanced perturbation, accepted as in simulated annealing.

The paper compares with EILS (A. Mitiche, D. Boughaci, M. Gini, "Iterated local search for time-extended multi-robot
task allocation with spatio-temporal and capacity constraints", Journal of Intelligent Systems 28, 2019). The details of
its perturbation could not be recovered, so this one is ours, in the spirit of slack induction by string removals (J.
Christiaens, G. Vanden Berghe, Transportation Science 54, 2020): near a random task, remove a string of consecutive
visits from some tours, then refill those tours with the unvisited tasks, either by the least Shift times a random
weight or one after another, as they do, but by deadline. The first does better where most tasks cannot be done, the
second where most can. What comes out is kept if it completes more tasks or takes less time, or is worse by no more than
chance allows.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from functools import cache, partial
from operator import itemgetter
from threading import Event

import numpy as np
import numpy.typing as npt

from mrta_zoo.errors import ConfigError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.local_search.compiled import compiled
from mrta_zoo.policies.classical.local_search.insertion import fill, fill_by_deadline
from mrta_zoo.policies.classical.local_search.problem import Problem, make_problem, smallest_scenario
from mrta_zoo.policies.classical.local_search.tours import (
    Tours,
    copy_tour,
    copy_tours,
    empty_tours,
    plan_of,
    remove,
    tours_of,
)
from mrta_zoo.policies.interruption import interruptible, side_by_side
from mrta_zoo.scenario import FloatArray, Scenario
from mrta_zoo.verify import verify

Worth = tuple[int, float]
"""Of tours; the greater, the better."""

CHUNK = 100
"""Iterations at one temperature, at most."""
LOOKS = 100
"""At the clock, about so many at least, if there is a budget."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EilsConfig:
    """How the search goes; times are multiples of what a visit takes on average in the first plan.

    Attributes:
        iterations_a_task: without a budget the search ends after so many iterations for each task, >= 1,
        least_iterations: but not before so many, >= 1.
        removals: visits that a perturbation removes on average, >= 1.
        noise: random weights of Shift lie between 1 and 1 + noise, >= 0.
        by_deadline: share of the refills that go by deadline instead, 0 to 1.
        blink: probability with which these do not offer a task to a tour, 0 to 1.
        reward: what a completed task is worth, in time, > 0.
        hot: temperature at the beginning, in time, > 0.
        cold: temperature at the end, in time, > 0.

    Raises:
        ConfigError: if a value is out of range.
    """

    iterations_a_task: int = 8
    least_iterations: int = 800
    removals: float = 16.0
    noise: float = 1.0
    by_deadline: float = 0.7
    blink: float = 0.01
    reward: float = 4.0
    hot: float = 2.0
    cold: float = 0.1

    def __post_init__(self) -> None:
        for field in ("iterations_a_task", "least_iterations", "removals"):
            if not 1 <= getattr(self, field) < math.inf:
                raise ConfigError(f"{field} is {getattr(self, field)}; expected a number >= 1")
        for field in ("reward", "hot", "cold"):
            if not 0 < getattr(self, field) < math.inf:
                raise ConfigError(f"{field} is {getattr(self, field)}; expected a number > 0")
        if not 0 <= self.noise < math.inf:
            raise ConfigError(f"noise is {self.noise}; expected a number >= 0")
        for field in ("by_deadline", "blink"):
            if not 0 <= getattr(self, field) <= 1:
                raise ConfigError(f"{field} is {getattr(self, field)}; expected a number from 0 to 1")


class EilsSolver:
    """Plans by EILS-style search. Making the first one compiles the search, some 20 seconds on a machine new to it.

    Args:
        seed: of the perturbations, >= 0.
        budget: seconds a scenario, > 0; by default `EilsConfig.iterations_a_task` ends the search, and the plan does
            not depend on the machine.
        config: how the search goes.
        threads: with a budget, so many searches go on at a time, each with draws of its own, and the best plan counts.
            Without one there is one search, and the plan does not depend on this.
    """

    def __init__(
        self, seed: int = 0, budget: float | None = None, config: EilsConfig | None = None, threads: int = 1
    ) -> None:
        self._seed, self._budget, self._config = seed, budget, config or EilsConfig()
        self._threads = 1 if budget is None else threads
        compile_once()

    def solve(self, scenario: Scenario, stop: Event | None = None) -> Plan:
        """A plan for `scenario`; the search ends early once another thread sets `stop`."""
        return self.improve(scenario, Plan(((),) * scenario.num_robots), "eils", stop)

    def improve(self, scenario: Scenario, plan: Plan, method: str, stop: Event | None = None) -> Plan:
        """A plan that completes at least as many tasks as `plan`, with no late visits unless it is the same.

        Args:
            scenario: the mission.
            plan: where the search begins.
            method: what the plan is signed with.
            stop: ends the search early once another thread sets it.

        Raises:
            PlanError: if `plan` does not fit `scenario`.
        """
        begun = time.perf_counter()
        problem, stopped = make_problem(scenario), stop or Event()

        def search(number: int) -> tuple[Worth, Tours]:
            rng = np.random.default_rng((self._seed, number) if number else self._seed)
            tours = tours_of(problem, scenario, plan)
            best = _search(problem, tours, rng, begun, self._budget, self._config, stopped)
            return worth(best), best

        searches = [partial(search, number) for number in range(self._threads)]
        found = side_by_side([partial(interruptible, each, stopped.set) for each in searches], stopped.set)
        best = max(found, key=itemgetter(0))[1]
        if verify(scenario, plan).completed > best.size.sum():  # one late visit, dropped, made another late by rounding
            return Plan(plan.routes, scenario.name, method)
        return plan_of(best, scenario, method)


def worth(tours: Tours) -> Worth:
    """Visits, then time saved."""
    return int(tours.size.sum()), -total_time(tours)


@cache
def compile_once() -> None:
    """Compile the search, so that no plan has to wait for it."""
    interruptible(_compile)


def _compile() -> None:
    problem = make_problem(smallest_scenario())
    worth(_search(problem, empty_tours(problem), np.random.default_rng(0), 0.0, None, EilsConfig(), Event()))


def _search(
    problem: Problem,
    tours: Tours,
    rng: np.random.Generator,
    begun: float,
    budget: float | None,
    config: EilsConfig,
    stopped: Event,
) -> Tours:
    """The best tours that come of some; these are changed."""
    shift, weight = np.empty(problem.work.shape), np.ones(len(problem.deadline))
    fill(problem, tours, shift, np.ones(len(problem.speed), dtype=np.bool_), weight)
    visits = int(tours.size.sum())
    if visits == 0:
        return tours
    trial, best = empty_tours(problem), empty_tours(problem)
    copy_tours(tours, trial)
    copy_tours(tours, best)
    visit_time = total_time(tours) / visits
    iterations = max(config.iterations_a_task * len(problem.deadline), config.least_iterations)
    done, share = 0, 0.0
    while share < 1.0 and not stopped.is_set():
        if budget is None:
            chunk = min(CHUNK, iterations - done)
        elif share == 0.0:
            chunk = 1  # which tells the pace
        else:
            chunk = min(CHUNK, int(done / share * min(1.0 / LOOKS, 1.0 - share)) + 1)
        temperature = visit_time * config.hot * (config.cold / config.hot) ** share
        anneal(
            problem, tours, trial, best, shift, weight, chunk, temperature, config.removals, config.noise,
            config.by_deadline, config.blink, config.reward * visit_time, rng,
        )  # fmt: skip
        done += chunk
        share = done / iterations if budget is None else (time.perf_counter() - begun) / budget
    return best


@compiled
def anneal(
    problem: Problem,
    tours: Tours,
    trial: Tours,
    best: Tours,
    shift: FloatArray,
    weight: npt.NDArray[np.float64],
    iterations: int,
    temperature: float,
    removals: float,
    noise: float,
    by_deadline: float,
    blink: float,
    reward: float,
    rng: np.random.Generator,
) -> None:
    """Some iterations of perturbation, refilling and acceptance at one temperature.

    Args:
        problem: the scenario.
        tours: the tours that the search stands at, changed in place.
        trial: a copy of them, and again at the end.
        best: the best tours so far, updated.
        shift: (M, N) scratch space.
        weight: (N,) scratch space.
        iterations: how many.
        temperature: a change that is worse by so much time is accepted with probability 1/e.
        removals: visits removed on average.
        noise: weights of Shift lie between 1 and 1 + noise.
        by_deadline: share of the refills that go by deadline instead.
        blink: probability with which these do not offer a task to a tour.
        reward: what a completed task is worth, in time.
        rng: of all draws.
    """
    m, n = problem.work.shape
    changed = np.zeros(m, dtype=np.bool_)
    most = best.size.sum()
    value = reward * tours.size.sum() - total_time(tours)
    for _ in range(iterations):
        changed[:] = False
        remove_strings(problem, trial, changed, removals, rng)
        if by_deadline > 0.0 and rng.random() < by_deadline:  # where there is no choice, nothing is drawn
            fill_by_deadline(problem, trial, changed, blink, rng)
        else:
            for task in range(n):
                if trial.robot[task] < 0:
                    weight[task] = 1.0 + noise * rng.random()
            fill(problem, trial, shift, changed, weight)
        new_value = reward * trial.size.sum() - total_time(trial)
        if new_value > value + temperature * math.log(1.0 - rng.random()):
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
    """Remove a string of visits from some tours that pass near a random task, and mark those tours.

    Lengths and number of strings are drawn as by Christiaens and Vanden Berghe (2020), §5.1: no longer than the mean
    tour, `removals` visits on average.
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


@compiled
def total_time(tours: Tours) -> float:
    """The time until each robot is through with its tour, summed over the robots."""
    total = 0.0
    for robot in range(len(tours.size)):
        if tours.size[robot] > 0:
            total += tours.finish[robot, tours.size[robot] - 1]
    return total
