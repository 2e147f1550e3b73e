"""How a method and the local search share a budget and threads."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from factories import small_scenario

from mrta_zoo import Plan, Scenario
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.policies.protocol import SupportsTimeLimit
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.policies.stop import FirstOf, MaxIterations, StoppingCriterion, TimeLimit
from mrta_zoo.verify import verify

pytest.importorskip("numba")

from mrta_zoo.policies.classical.local_search import eils
from mrta_zoo.policies.classical.local_search.eils import EilsSolver
from mrta_zoo.policies.classical.local_search.polish import METHOD_SHARE, PolishedSolver
from mrta_zoo.policies.classical.local_search.problem import make_problem
from mrta_zoo.policies.classical.local_search.tours import tours_of


class Slow:
    """A method that needs a given number of seconds, by a clock of its own, and supports a time limit."""

    name = "slow"

    def __init__(self, seconds: float) -> None:
        self.seconds, self.now = seconds, 0.0
        self.allowed: list[float] = []
        self.seeds: list[int] = []

    def clock(self) -> float:
        return self.now

    def solve(self, scenario: Scenario) -> Plan:
        self.now += self.seconds
        return make_solver("edf").solve(scenario)

    def solve_within(self, scenario: Scenario, limit: TimeLimit) -> Plan | None:
        self.allowed.append(limit.left())
        if self.seconds > limit.left():
            self.now += limit.left()
            return None
        return Plan(self.solve(scenario).routes, scenario.name, self.name)


def spied(monkeypatch: pytest.MonkeyPatch, slow: Slow) -> list[tuple[float, int]]:
    """Seconds that each search has from now on, and the number of visits it begins with."""
    found: list[tuple[float, int]] = []

    class Spy(EilsSolver):
        def improve(self, scenario: Scenario, plan: Plan, method: str, stop: StoppingCriterion | None = None) -> Plan:
            assert isinstance(stop, FirstOf)
            limit = stop.criteria[0]
            assert isinstance(limit, TimeLimit)
            slow.seeds.append(self._seed)
            found.append((limit.end - limit.begin, sum(map(len, plan.routes))))
            return super().improve(scenario, plan, method, MaxIterations(1))

    monkeypatch.setattr("mrta_zoo.policies.classical.local_search.polish.EilsSolver", Spy)
    monkeypatch.setattr("mrta_zoo.policies.stop.time", SimpleNamespace(perf_counter=slow.clock))
    return found


def test_a_method_in_time_gives_the_search_its_plan_and_what_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    slow, scenario = Slow(0.25), small_scenario()
    assert isinstance(slow, SupportsTimeLimit)
    searches = spied(monkeypatch, slow)
    plan = PolishedSolver(slow, 0, 2.0).solve(scenario)
    assert plan.method == "slow+polish"
    assert slow.allowed == [METHOD_SHARE * 2.0]
    visits = sum(map(len, make_solver("edf").solve(scenario).routes))
    assert searches == [(1.75, visits)]


def test_a_method_that_takes_too_long_is_done_without_and_not_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    slow, scenario = Slow(5.0), small_scenario()
    searches = spied(monkeypatch, slow)
    solver = PolishedSolver(slow, 0, 2.0)
    first, second = solver.solve(scenario), solver.solve(scenario)
    assert first.method == second.method == "slow+polish"
    assert slow.allowed == [METHOD_SHARE * 2.0]
    assert [begun_with for _, begun_with in searches] == [0, 0]
    assert [budget for budget, _ in searches] == pytest.approx([2.0 - METHOD_SHARE * 2.0, 2.0])


def test_a_method_that_was_too_slow_is_tried_again_where_there_are_less_than_half_the_tasks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    slow, rng = Slow(5.0), np.random.default_rng(3)
    spied(monkeypatch, slow)
    solver = PolishedSolver(slow, 0, 2.0)
    for tasks, times_asked in ((40, 1), (30, 1), (19, 2)):
        solver.solve(TaptcGenerator(tasks=(tasks, tasks), robots=(2, 2))(rng))
        assert len(slow.allowed) == times_asked


def test_warming_up_tells_whether_there_is_time_for_the_method(monkeypatch: pytest.MonkeyPatch) -> None:
    slow, scenario = Slow(1.0), small_scenario()
    searches = spied(monkeypatch, slow)
    solver = PolishedSolver(slow, 0, 2.0)
    solver.warm_up(scenario)
    solver.solve(scenario)
    assert slow.allowed == [2.0]
    assert searches == [(2.0, 0)]


def test_without_a_budget_threads_change_nothing() -> None:
    case = TaptcGenerator(tasks=(40, 40), robots=(3, 3))(np.random.default_rng(3))
    for method in ("eils", "edf+polish"):
        assert make_solver(method, seed=4).solve(case) == make_solver(method, seed=4, threads=2).solve(case)


@pytest.mark.parametrize("method", ["eils", "nearest+polish"])
def test_several_searches_at_a_time(method: str) -> None:
    case = TaptcGenerator(tasks=(40, 40), robots=(3, 3))(np.random.default_rng(3))
    plan = make_solver(method, seed=4, threads=3, budget=0.2).solve(case)
    assert plan.method == method
    score = verify(case, plan)
    assert score.completed == sum(map(len, plan.routes)) > verify(case, make_solver("nearest").solve(case)).completed


def test_the_best_of_several_searches_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = Scenario(task_xy=[[10, 0], [20, 0]], deadline=[90, 90], workload=[0, 0], robot_xy=[[0, 0]], capacity=[1])
    problem = make_problem(scenario)
    routes = iter([[1], [1, 0], [0, 1]])  # 1 visit; 2 in 30; 2 in 20
    draws = []

    def search(*arguments: object) -> object:
        draws.append(arguments[2].random())  # type: ignore[attr-defined]
        return tours_of(problem, scenario, Plan.of([next(routes)]))

    monkeypatch.setattr(eils, "_search", search)
    assert EilsSolver(7, 1.0, threads=3).solve(scenario).routes == ((0, 1),)
    assert len(set(draws)) == 3


def test_other_threads_search_while_the_method_plans(monkeypatch: pytest.MonkeyPatch) -> None:
    scenario, slow = small_scenario(), Slow(0.25)
    searches = spied(monkeypatch, slow)
    plan = PolishedSolver(slow, 0, 2.0, threads=2).solve(scenario)
    assert plan.method == "slow+polish"
    visits = sum(map(len, make_solver("edf").solve(scenario).routes))
    assert sorted(searches) == [(1.75, visits), (2.0, 0)]
    assert sorted(slow.seeds) == [0, 1]


@pytest.mark.parametrize(("seconds", "left"), [(0.25, 1.75), (3.0, -1.0)])
def test_a_method_that_knows_no_time_limit_is_waited_for(
    seconds: float, left: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    slow, scenario = Slow(seconds), small_scenario()
    searches = spied(monkeypatch, slow)
    plan = PolishedSolver(SimpleNamespace(solve=slow.solve), 0, 2.0).solve(scenario)  # type: ignore[arg-type]
    assert plan.method == "edf+polish"
    assert searches == [(left, sum(map(len, make_solver("edf").solve(scenario).routes)))]
    assert slow.allowed == []
