"""Exact plans against trying everything, bounds against optimal plans, and every other method against both."""

from __future__ import annotations

from functools import cache
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from installed import skip_unless_installed
from strategies import scenarios, seeded_scenarios

pytest.importorskip("scipy")
pytest.importorskip("numba")

from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import TaptcGenerator, UniformGenerator
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.exact.relaxation import most_completable
from mrta_zoo.policies.classical.exact.selection import Team, select_sets
from mrta_zoo.policies.classical.exact.solver import ExactSolver
from mrta_zoo.policies.registry import METHODS, make_solver, method_names
from mrta_zoo.policies.stop import TimeLimit
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify


def most_by_trying(scenario: Scenario) -> int:
    """The most tasks that any of all plans for one or two robots completes: every order of the tasks, cut anywhere.

    Tasks that are left out need not be tried: they can as well come last, late.
    """
    best = 0
    for order in permutations(range(scenario.num_tasks)):
        cuts = range(scenario.num_tasks + 1) if scenario.num_robots == 2 else [scenario.num_tasks]
        for cut in cuts:
            routes = [order[:cut], order[cut:]][: scenario.num_robots]
            best = max(best, verify(scenario, Plan.of(routes)).completed)
    return best


def check_optimal(scenario: Scenario) -> None:
    plan = ExactSolver().solve(scenario)
    score = verify(scenario, plan)
    assert score.completed == plan.bound == most_by_trying(scenario)
    assert score.completed == sum(map(len, plan.routes)), "it plans only what is in time"


def test_optimal_on_many_scenarios_with_ties() -> None:
    for scenario in seeded_scenarios(21, 250, max_tasks=4, max_robots=2):
        check_optimal(scenario)
    for scenario in seeded_scenarios(22, 25, max_tasks=5, max_robots=2):
        check_optimal(scenario)


@settings(max_examples=60, derandomize=True)
@given(scenario=scenarios(4, 2))
def test_hypothesis_finds_none_better(scenario: Scenario) -> None:
    check_optimal(scenario)


def line(tasks: list[float], deadlines: list[float], robots: list[float]) -> Scenario:
    """Everything on a line, no workloads, speed 1: a robot finishes after as much time as it travels distance."""
    return Scenario(
        task_xy=[[x, 0.0] for x in tasks],  # type: ignore[arg-type]
        deadline=np.array(deadlines),
        workload=np.zeros(len(tasks)),
        robot_xy=[[x, 0.0] for x in robots],  # type: ignore[arg-type]
        capacity=np.ones(len(robots)),
    )


def test_by_hand_one_robot() -> None:
    # From 50: task 1 at 40 is 10 away and due at 10, task 0 at 52 is 2 away, due at 70, task 2 at 90 due at 60.
    # 1, then 0: 10, 10 + 12 = 22, then 2: 22 + 38 = 60 <= 60. Starting with the nearest, 0, loses task 1: 2 + 12 > 10.
    scenario = line([52, 40, 90], [70, 10, 60], [50])
    plan = ExactSolver().solve(scenario)
    assert (plan.routes, plan.bound) == (((1, 0, 2),), 3)
    assert (plan.scenario, plan.method) == ("scenario", "exact")
    # With task 2 due a moment earlier it is one of 1 and 2 and the one on the way.
    assert ExactSolver().solve(line([52, 40, 90], [70, 10, 59.999], [50])).bound == 2


def test_by_hand_two_robots() -> None:
    # Robots at 0 and 100. Tasks at 10 (due 10), 20 (due 20), 90 (due 10), 50 (due 50), 51 (due 48).
    # Robot 0: 10, 20, 50 (f = 10, 20, 50). Robot 1: 90 at 10. Nobody is in time for 51: robot 1 is there at 49 > 48,
    # robot 0 at 51. So 4 tasks.
    scenario = line([10, 20, 90, 50, 51], [10, 20, 10, 50, 48], [0, 100])
    plan = ExactSolver().solve(scenario)
    assert plan.bound == verify(scenario, plan).completed == 4


def test_alike_robots_each_get_a_route() -> None:
    # Three robots at 50; four tasks 10 away or more, in four corners of time: each robot has time for one side only.
    scenario = line([40, 60, 38, 62, 50], [10, 10, 12, 12, 1], [50, 50, 50])
    # Left: 40 at 10, 38 at 12. Right: 60 at 10, 62 at 12. Task 4 is where they stand.
    plan = ExactSolver().solve(scenario)
    assert plan.bound == verify(scenario, plan).completed == 5


def rounding_trap() -> Scenario:
    """Task 0 lies on robot 0's way to task 1 and on robot 1's way to task 2, both due when they get there by that way.
    Without the stop they are later, by rounding. Nobody is in time for the other's task."""
    rng = np.random.default_rng(0)
    for _ in range(10_000):
        stop, angle, steps = rng.uniform(40, 60, 2), rng.uniform(0, 6, 2), rng.uniform(0.1, 1, 4)
        far, near = np.array([np.cos(angle), np.sin(angle)]).T
        task_xy = np.array([stop, stop + 30 * steps[1] * far, stop - steps[3] * near])
        robot_xy = np.array([stop - 30 * far, stop + steps[2] * near])
        work = np.array([0.0, 1.0, 0.0])
        scenario = Scenario(task_xy, np.full(3, 1e4), work, robot_xy, np.array([1.0, 1e-3]))
        direct = [verify(scenario, Plan.of(routes)).makespan for routes in ([[1], []], [[], [2]])]
        due = [verify(scenario, Plan.of(routes)).makespan for routes in ([[0, 1], []], [[], [0, 2]])]
        if direct[0] > due[0] and direct[1] > due[1]:
            return Scenario(task_xy, np.array([60.0, *due]), work, robot_xy, scenario.capacity)
    raise AssertionError("no such scenario among many")


def test_a_part_of_a_set_may_be_late_by_rounding() -> None:
    scenario = rounding_trap()
    assert most_by_trying(scenario) == 2  # although each robot can complete two, with task 0 in both
    check_optimal(scenario)


def test_choice_of_sets() -> None:
    # Robots 0 and 2 are alike: {0, 1} or {2}; robot 1: {1, 2} or {3}.
    pairs, others = np.array([[0, 1], [2, -1]]), np.array([[1, 2], [3, -1]])
    selection = select_sets([Team([0, 2], pairs), Team([1], others)], 4, disjoint=True, limit=TimeLimit.of(5.0))
    assert (selection.routes, selection.bound) == ({0: [0, 1], 2: [2], 1: [3]}, 4)
    # Robot 0 has {0, 1}, robot 1 {1, 2}: three tasks, but not apart.
    teams = [Team([0], pairs[:1]), Team([1], others[:1])]
    assert select_sets(teams, 4, disjoint=False, limit=TimeLimit.of(5.0)).bound == 3
    assert select_sets(teams, 4, disjoint=True, limit=TimeLimit.of(5.0)).bound == 2
    # Nothing to choose from, and no time.
    assert (
        select_sets([Team([0], np.empty((0, 1), dtype=np.int64))], 4, disjoint=False, limit=TimeLimit.of(5.0)).bound
        == 0
    )
    assert select_sets(teams, 4, disjoint=True, limit=TimeLimit.of(0.0)).bound == 4


@pytest.mark.parametrize("cut", [{"budget": 1e-9}, {"max_states": 0}, {"max_states": 6}])
def test_cut_off_it_still_plans_and_bounds(cut: dict[str, float]) -> None:
    proven = 0
    for scenario in seeded_scenarios(23, 120, max_tasks=4, max_robots=2):
        plan = ExactSolver(**cut).solve(scenario)  # type: ignore[arg-type]
        score, most = verify(scenario, plan), most_by_trying(scenario)
        assert plan.bound is not None
        assert score.completed <= most <= plan.bound
        assert score.completed == sum(map(len, plan.routes))
        nearest = verify(scenario, make_solver("nearest").solve(scenario))
        assert score.completed >= nearest.completed
        proven += plan.bound == score.completed
    assert proven >= 60  # where the heuristics reach the bound


def test_the_relaxation_bounds_what_can_be_completed() -> None:
    below = 0
    for scenario in seeded_scenarios(24, 200, max_tasks=4, max_robots=2):
        bound = most_completable(scenario)
        assert most_by_trying(scenario) <= bound <= scenario.num_tasks
        below += bound < scenario.num_tasks
    assert below >= 100
    # 9 tasks at 1, 2, ..., 9 with 10 units of work, all due at 35: by then a robot of capacity 1 has time for
    # 35 / (1 + 10) = 3.2 tasks, for one at least a way of 1 away from the next.
    scenario = Scenario(
        [[x, 0] for x in range(1, 10)],
        np.full(9, 35.0),
        np.full(9, 10.0),
        [[0, 0]],
        [1.0],  # type: ignore[arg-type]
    )
    assert most_completable(scenario) == 3
    assert ExactSolver(max_states=0).solve(scenario).bound == 3


def test_a_large_scenario_gets_a_plan_and_a_bound() -> None:
    scenario = TaptcGenerator(robots=(5, 5), group="tight")(np.random.default_rng(1))
    plan = ExactSolver(budget=5).solve(scenario)
    score = verify(scenario, plan)
    assert plan.bound is not None
    assert verify(scenario, make_solver("nearest").solve(scenario)).completed <= score.completed <= plan.bound
    assert plan.bound < 90  # of 100; PyVRP finds some 55


def test_the_same_plan_each_time() -> None:
    for scenario in compared_scenarios()[:10]:
        assert ExactSolver().solve(scenario) == ExactSolver().solve(scenario)


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        ({"budget": 0.0}, "budget is 0; expected a number of seconds > 0"),
        ({"budget": float("inf")}, "budget is inf"),
        ({"max_states": -1}, "max_states is -1; expected a whole number >= 0"),
    ],
)
def test_bad_arguments(arguments: dict[str, float], complaint: str) -> None:
    with pytest.raises(ConfigError, match=complaint):
        ExactSolver(**arguments)  # type: ignore[arg-type]


@cache
def compared_scenarios() -> list[Scenario]:
    """66 scenarios with up to 9 tasks and 3 robots, in which some tasks must be left out."""
    rng = np.random.default_rng(7)
    drawn = [UniformGenerator(tasks=(5, 9), robots=(1, 3), deadline=(25, 140))(rng) for _ in range(50)]
    return [*drawn, *seeded_scenarios(25, 16, max_tasks=9, max_robots=3)]


@cache
def optimal(index: int) -> Plan:
    return ExactSolver().solve(compared_scenarios()[index])


def test_the_optimum_is_proven_and_no_triviality() -> None:
    partial = 0
    for index, scenario in enumerate(compared_scenarios()):
        assert verify(scenario, optimal(index)).completed == optimal(index).bound
        partial += 0 < (optimal(index).bound or 0) < scenario.num_tasks
    assert partial >= 40


@pytest.mark.parametrize("name", method_names())
def test_no_method_beats_the_optimum(name: str) -> None:
    if name in METHODS:
        skip_unless_installed(name)
    else:
        pytest.importorskip("torch")
    solver = make_solver(name, seed=1, budget=0.03 if name in METHODS else None)  # plenty for so few tasks
    for index, scenario in enumerate(compared_scenarios()):
        completed = verify(scenario, solver.solve(scenario)).completed
        assert completed <= verify(scenario, optimal(index)).completed


def test_the_local_search_is_compiled_before_the_clock_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    from mrta_zoo.policies.classical.local_search import eils

    compiled: list[str] = []
    monkeypatch.setattr(eils, "compile_once", lambda: compiled.append("now"))
    solver = ExactSolver()
    assert compiled
    compiled.clear()
    solver.solve(line([52, 40, 90], [70, 10, 60], [50]))
    assert not compiled
