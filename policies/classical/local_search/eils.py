"""EILS-style search: the insertion step of ILS with an enhanced perturbation, accepted as in simulated annealing.

The paper compares with EILS (A. Mitiche, D. Boughaci, M. Gini, "Iterated local search for time-extended multi-robot
task allocation with spatio-temporal and capacity constraints", Journal of Intelligent Systems 28, 2019). The details of
its perturbation could not be recovered, so this one is ours, in the spirit of slack induction by string removals (J.
Christiaens, G. Vanden Berghe, Transportation Science 54, 2020): near a random task, remove a string of consecutive
visits from some tours, then refill those tours with the unvisited tasks. Tasks go in either by the least Shift times a
random weight or, as in that paper, one after another, but by deadline. The first does better where most tasks cannot be
done, the second where most can. A step that completes more tasks or saves time is accepted; a worse one is accepted
with a probability that falls as the search cools.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache, partial
from operator import itemgetter

import numpy as np

from mrta_zoo.errors import ConfigError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.local_search.annealing import Annealing, Moves, anneal
from mrta_zoo.policies.classical.local_search.insertion import fill
from mrta_zoo.policies.classical.local_search.problem import Problem, make_problem, smallest_scenario
from mrta_zoo.policies.classical.local_search.tours import (
    Tours,
    copy_tours,
    empty_tours,
    plan_of,
    total_time,
    tours_of,
)
from mrta_zoo.policies.interruption import interruptible, run_in_parallel
from mrta_zoo.policies.stop import Cancellation, FirstOf, MaxIterations, StoppingCriterion, TimeLimit
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify

Worth = tuple[int, float]
"""Of tours: the number of visits and the time saved. The greater is the better."""

CHUNK = 100
"""Most iterations at one temperature."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EilsConfig:
    """Parameters of the search. The unit of time is the mean time per visit in the first plan.

    Attributes:
        iterations_per_task: number of iterations per task of a search without a budget, >= 1.
        least_iterations: minimum number of iterations of such a search, >= 1.
        removals: mean number of visits that a perturbation removes, >= 1.
        noise: the random weights of Shift lie between 1 and 1 + noise, >= 0.
        by_deadline: share of the refills that go by deadline instead, from 0 to 1.
        blink: probability that such a refill does not offer a task to a tour, from 0 to 1.
        reward: time that a completed task is worth, > 0.
        hot: temperature at the beginning, as a time, > 0.
        cold: temperature at the end, as a time, > 0.

    Raises:
        ConfigError: if a value is out of range.
    """

    iterations_per_task: int = 8
    least_iterations: int = 800
    removals: float = 16.0
    noise: float = 1.0
    by_deadline: float = 0.7
    blink: float = 0.01
    reward: float = 4.0
    hot: float = 2.0
    cold: float = 0.1

    def __post_init__(self) -> None:
        for field in ("iterations_per_task", "least_iterations", "removals"):
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
    """Plans by EILS-style search. The first instance compiles the search: some 20 seconds on a new machine.

    Args:
        seed: of the perturbations, >= 0.
        budget: seconds per scenario, > 0. By default the search ends after a number of iterations (see `EilsConfig`),
            and the plan is the same on every machine.
        config: parameters of the search.
        threads: number of parallel searches, each with its own random draws; the best plan counts. Without a budget
            there is one search, whatever this is.
    """

    def __init__(
        self, seed: int = 0, budget: float | None = None, config: EilsConfig | None = None, threads: int = 1
    ) -> None:
        self._seed, self._budget, self._config = seed, budget, config or EilsConfig()
        self._threads = 1 if budget is None else threads
        compile_once()

    def solve(self, scenario: Scenario, stop: StoppingCriterion | None = None) -> Plan:
        """A plan for `scenario`. `stop` ends the search instead of the solver's own budget."""
        return self.improve(scenario, Plan(((),) * scenario.num_robots), "eils", stop)

    def improve(self, scenario: Scenario, plan: Plan, method: str, stop: StoppingCriterion | None = None) -> Plan:
        """A plan that completes at least as many tasks as `plan`. Unless it is `plan` itself, no visit is late.

        Args:
            scenario: the mission.
            plan: the plan that the search begins with.
            method: method name stored in the new plan.
            stop: ends the search instead of the solver's own budget.

        Raises:
            PlanError: if `plan` does not fit `scenario`.
        """
        cancellation = Cancellation()
        criterion = FirstOf((stop or self._stop(scenario), cancellation))
        problem = make_problem(scenario)

        def search(number: int) -> tuple[Worth, Tours]:
            rng = np.random.default_rng((self._seed, number) if number else self._seed)
            best = _search(problem, tours_of(problem, scenario, plan), rng, criterion, self._config)
            return worth(best), best

        searches = [partial(interruptible, partial(search, k), cancellation.cancel) for k in range(self._threads)]
        best = max(run_in_parallel(searches, cancellation.cancel), key=itemgetter(0))[1]
        if verify(scenario, plan).completed > best.size.sum():  # dropping a late visit made another late by rounding
            return Plan(plan.routes, scenario.name, method)
        return plan_of(best, scenario, method)

    def _stop(self, scenario: Scenario) -> StoppingCriterion:
        if self._budget is not None:
            return TimeLimit.of(self._budget)
        return MaxIterations(max(self._config.iterations_per_task * scenario.num_tasks, self._config.least_iterations))


def worth(tours: Tours) -> Worth:
    """Visits, then time saved."""
    return int(tours.size.sum()), -total_time(tours)


@cache
def compile_once() -> None:
    """Compile the search, so that no plan has to wait for it."""
    interruptible(_compile)


def _compile() -> None:
    problem = make_problem(smallest_scenario())
    worth(_search(problem, empty_tours(problem), np.random.default_rng(0), MaxIterations(1), EilsConfig()))


def _search(
    problem: Problem, tours: Tours, rng: np.random.Generator, stop: StoppingCriterion, config: EilsConfig
) -> Tours:
    """The best tours that a search finds from `tours` on, which it changes."""
    m, n = problem.work.shape
    state = Annealing(tours, empty_tours(problem), empty_tours(problem), np.empty((m, n)), np.ones(n))
    fill(problem, tours, state.shift, np.ones(m, dtype=np.bool_), state.weight)
    visits = int(tours.size.sum())
    if visits == 0:
        return tours
    copy_tours(tours, state.trial)
    copy_tours(tours, state.best)
    visit_time = total_time(tours) / visits
    done = idle = 0
    while (progress := stop.progress(done, idle)) < 1.0:
        chunk = int(min(CHUNK, stop.next_look(done, progress)))
        anneal(problem, state, chunk, _moves(config, visit_time, progress), rng)
        done, idle = done + chunk, idle + chunk
        if (most := int(state.best.size.sum())) > visits:
            visits, idle = most, 0
    return state.best


def _moves(config: EilsConfig, visit_time: float, progress: float) -> Moves:
    """The parameters where a visit takes `visit_time` on average and the search is `progress` of its way."""
    return Moves(
        temperature=visit_time * config.hot * (config.cold / config.hot) ** progress,
        removals=config.removals,
        noise=config.noise,
        by_deadline=config.by_deadline,
        blink=config.blink,
        reward=config.reward * visit_time,
    )
