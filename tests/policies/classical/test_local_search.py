"""ILS and EILS-style search: tours by hand, invariants on random missions, and what the searches reach."""

from __future__ import annotations

import math

import numpy as np
import pytest
from factories import hopeless_scenario, small_scenario
from hypothesis import given
from strategies import scenarios

from mrta_zoo import Scenario
from mrta_zoo.errors import ConfigError, PlanError
from mrta_zoo.generators import TaptcGenerator, UniformGenerator
from mrta_zoo.plan import Plan
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.verify import verify

pytest.importorskip("numba")

from mrta_zoo.policies.classical.local_search import eils
from mrta_zoo.policies.classical.local_search.annealing import Annealing, Moves, anneal
from mrta_zoo.policies.classical.local_search.eils import EilsConfig, EilsSolver
from mrta_zoo.policies.classical.local_search.ils import IlsSolver, shake
from mrta_zoo.policies.classical.local_search.insertion import fill, fill_by_deadline
from mrta_zoo.policies.classical.local_search.problem import Problem, make_problem
from mrta_zoo.policies.classical.local_search.tours import Tours, copy_tours, empty_tours, insert, remove, tours_of

LINE = Scenario(
    task_xy=[[10, 0], [20, 0], [40, 0]],
    deadline=[30, 40, 50],
    workload=[4, 2, 0],
    robot_xy=[[0, 0]],
    capacity=[2],
    speed=[2],
)
"""One robot of capacity 2 and speed 2 to the left of three tasks."""


def begun(scenario: Scenario, *routes: list[int]) -> tuple[Problem, Tours]:
    problem = make_problem(scenario)
    return problem, tours_of(problem, scenario, Plan.of(routes))


def route(tours: Tours, robot: int = 0) -> list[int]:
    tasks: list[int] = tours.tasks[robot, : tours.size[robot]].tolist()
    return tasks


def test_times_of_a_tour() -> None:
    _, tours = begun(LINE, [0, 1, 2])
    # 10/2 + 4/2 = 7, 7 + 10/2 + 2/2 = 13, 13 + 20/2 + 0 = 23
    assert tours.finish[0, :3].tolist() == [7, 13, 23]
    # 50 - 23 = 27; min(40 - 13, 27) = 27; min(30 - 7, 27) = 23
    assert tours.max_shift[0, :3].tolist() == [23, 27, 27]
    assert tours.leg[0, :3].tolist() == [5, 5, 10]


def test_the_least_weighted_shift_is_inserted_first() -> None:
    # Task 0 before task 2: 10/2 + 4/2 + 30/2 - 40/2 = 2; task 1 there: 20/2 + 2/2 + 20/2 - 40/2 = 1. Task 2 is finished
    # after 40/2 = 20 at the earliest and due at 22, so one of them fits, not both.
    tight = Scenario(
        task_xy=LINE.task_xy, deadline=[30, 15, 22], workload=LINE.workload, robot_xy=[[0, 0]], capacity=[2], speed=[2]
    )
    for weight, expected in (([1.0, 1.0, 1.0], [1, 2]), ([0.4, 1.0, 1.0], [0, 2])):
        problem, tours = begun(tight, [2])
        fill(problem, tours, np.empty(problem.work.shape), np.array([True]), np.array(weight))
        assert route(tours) == expected


def test_an_insertion_that_makes_another_task_late_is_undone() -> None:
    tight = Scenario(
        task_xy=LINE.task_xy, deadline=[30, 40, 21], workload=LINE.workload, robot_xy=[[0, 0]], capacity=[2], speed=[2]
    )
    problem, tours = begun(tight, [2])
    before = [array.copy() for array in tours]
    assert not insert(problem, tours, 0, 0, 0)  # 20 + 2 > 21
    assert route(tours) == [2]
    assert tours.robot.tolist() == [-1, -1, 0]
    assert tours.finish[0, 0] == before[1][0, 0]
    assert insert(problem, tours, 1, 0, 0)  # 20 + 1 = 21, to the last bit
    assert route(tours) == [1, 2]


def test_shake_goes_on_at_the_beginning_of_a_tour() -> None:
    problem, tours = begun(LINE, [0, 1, 2])
    shake(problem, tours, 2, 2)  # the third visit, then the first
    assert route(tours) == [1]
    shake(problem, tours, 0, 5)
    assert route(tours) == []
    shake(problem, tours, 3, 1)  # nothing left to remove
    assert tours.robot.tolist() == [-1, -1, -1]


def test_a_late_visit_of_the_plan_to_improve_is_dropped() -> None:
    # Backwards: 40/2 = 20, + 20/2 + 1 = 31, + 10/2 + 2 = 38 > 30.
    _, tours = begun(LINE, [2, 1, 0])
    assert route(tours) == [2, 1]
    with pytest.raises(PlanError, match="2 routes"):
        EilsSolver().improve(LINE, Plan(((), ())), "x")


def check(problem: Problem, scenario: Scenario, tours: Tours) -> None:
    """What must always hold of tours, against the independent verifier."""
    score = verify(scenario, Plan.of([route(tours, robot) for robot in range(scenario.num_robots)]))
    assert score.completed == tours.size.sum()
    for robot, visits in enumerate(score.schedule):
        size = len(visits)
        assert [visit.finish for visit in visits] == tours.finish[robot, :size].tolist()
        slack = [visit.deadline - visit.finish for visit in visits]
        assert tours.max_shift[robot, :size].tolist() == [min(slack[position:]) for position in range(size)]
        assert all(tours.robot[visit.task] == robot for visit in visits)
    assert (tours.robot >= 0).sum() == score.completed


@given(scenarios())
def test_tours_are_what_the_verifier_says_after_any_change(scenario: Scenario) -> None:
    rng = np.random.default_rng(1)
    problem = make_problem(scenario)
    tours, positions = empty_tours(problem), np.empty(problem.work.shape)
    for _ in range(6):
        fill(problem, tours, positions, rng.random(scenario.num_robots) < 0.7, rng.uniform(1, 2, scenario.num_tasks))
        check(problem, scenario, tours)
        fill_by_deadline(problem, tours, rng.random(scenario.num_robots) < 0.7, 0.1, rng)
        check(problem, scenario, tours)
        robot = int(rng.integers(scenario.num_robots))
        if size := int(tours.size[robot]):
            first = int(rng.integers(size))
            remove(problem, tours, robot, first, int(rng.integers(1, size - first + 1)))
            check(problem, scenario, tours)
    trial, best = empty_tours(problem), empty_tours(problem)
    copy_tours(tours, trial)
    copy_tours(tours, best)
    state = Annealing(tours, trial, best, positions, np.ones(scenario.num_tasks))
    moves = Moves(temperature=5.0, removals=4.0, noise=0.5, by_deadline=0.5, blink=0.1, reward=100.0)
    anneal(problem, state, 20, moves, rng)
    for each in (tours, trial, best):
        check(problem, scenario, each)
    assert route(trial) == route(tours)


@given(scenarios())
def test_after_filling_nothing_fits(scenario: Scenario) -> None:
    problem = make_problem(scenario)
    tours = empty_tours(problem)
    fill(
        problem,
        tours,
        np.empty(problem.work.shape),
        np.ones(scenario.num_robots, dtype=bool),
        np.ones(scenario.num_tasks),
    )
    routes = [route(tours, robot) for robot in range(scenario.num_robots)]
    completed = verify(scenario, Plan.of(routes)).completed
    for task in np.flatnonzero(tours.robot < 0).tolist():
        for robot, old in enumerate(routes):
            for position in range(len(old) + 1):
                longer = [*routes[:robot], [*old[:position], task, *old[position:]], *routes[robot + 1 :]]
                assert verify(scenario, Plan.of(longer)).completed <= completed


def insertions(scenario: Scenario, routes: list[list[int]], task: int) -> list[tuple[float, int, int]]:
    """Shift, robot and position of each insertion of a task that makes nothing late, by the verifier's times."""
    before = verify(scenario, Plan.of(routes))
    possible = []
    for robot, old in enumerate(routes):
        end = before.schedule[robot][-1].finish if old else 0.0
        for position in range(len(old) + 1):
            tried = [*routes[:robot], [*old[:position], task, *old[position:]], *routes[robot + 1 :]]
            after = verify(scenario, Plan.of(tried))
            if after.completed == before.completed + 1:
                possible.append((after.schedule[robot][-1].finish - end, robot, position))
    return possible


def filled_by_hand(scenario: Scenario, weight: np.ndarray) -> list[list[int]]:
    """Routes of the insertion step, every Shift computed anew before each insertion."""
    routes: list[list[int]] = [[] for _ in range(scenario.num_robots)]
    while True:
        unvisited = set(range(scenario.num_tasks)) - {task for each in routes for task in each}
        options = [
            (shift * weight[task], robot, task, position)
            for task in unvisited
            for shift, robot, position in insertions(scenario, routes, task)
        ]
        if not options:
            return routes
        _, robot, task, position = min(options)
        routes[robot].insert(position, task)


def test_filling_takes_the_least_weighted_shift_each_time() -> None:
    for seed in range(12):
        scenario = small_scenario(seed, tasks=14, robots=3, latest=160.0)
        weight = np.random.default_rng(seed).uniform(1, 2, 14)
        problem = make_problem(scenario)
        tours = empty_tours(problem)
        fill(problem, tours, np.empty(problem.work.shape), np.ones(3, dtype=bool), weight)
        assert [route(tours, robot) for robot in range(3)] == filled_by_hand(scenario, weight)


def test_filling_by_deadline_inserts_the_earliest_first() -> None:
    reached = []
    for seed in range(12):
        scenario = small_scenario(seed, tasks=14, robots=3, latest=160.0)
        problem = make_problem(scenario)
        tours = empty_tours(problem)
        fill_by_deadline(problem, tours, np.array([True, False, True]), 0.0, np.random.default_rng(0))
        by_hand: list[list[int]] = [[], [], []]
        for task in sorted(range(14), key=lambda task: scenario.deadline[task]):
            possible = [each for each in insertions(scenario, by_hand, task) if each[1] != 1]  # its tour is closed
            if possible:
                _, robot, position = min(possible)
                by_hand[robot].insert(position, task)
        assert [route(tours, robot) for robot in range(3)] == by_hand
        reached.append(int(tours.size.sum()))
    assert min(reached) < 14  # what did not fit is passed over


def test_blinks_pass_over_tours() -> None:
    scenario = small_scenario(0, tasks=14, robots=3, latest=160.0)
    problem = make_problem(scenario)
    found = {}
    for blink in (0.0, 0.5, 1.0):
        tours = empty_tours(problem)
        fill_by_deadline(problem, tours, np.ones(3, dtype=bool), blink, np.random.default_rng(0))
        check(problem, scenario, tours)
        found[blink] = [route(tours, robot) for robot in range(3)]
    assert found[1.0] == [[], [], []]
    assert found[0.0] != found[0.5] != found[1.0]


def test_refilling_by_deadline_helps_where_most_tasks_can_be_done() -> None:
    rng = np.random.default_rng(9)
    cases = [UniformGenerator(tasks=(60, 60), robots=(4, 4))(rng) for _ in range(6)]
    without, usual = (
        sum(len(tour) for case in cases for tour in EilsSolver(config=config).solve(case).routes)
        for config in (EilsConfig(by_deadline=0.0), EilsConfig())
    )
    assert usual > without


@pytest.mark.parametrize("solver", [IlsSolver(), EilsSolver(), EilsSolver(seed=3)], ids=["ils", "eils", "eils 3"])
def test_exact_ties_are_used_and_nothing_is_late(solver: IlsSolver | EilsSolver) -> None:
    for seed in range(30):
        free = small_scenario(seed, tasks=12, latest=1e6)
        # All deadlines are the very times at which one plan finishes, so that this plan just holds.
        visits = verify(free, IlsSolver().solve(free)).schedule
        deadline = free.deadline.copy()
        for visit in (visit for tour in visits for visit in tour):
            deadline[visit.task] = visit.finish
        tight = Scenario(
            task_xy=free.task_xy, deadline=deadline, workload=free.workload, robot_xy=free.robot_xy,
            capacity=free.capacity, speed=free.speed, map_size=free.map_size,
        )  # fmt: skip
        plan = Plan.of([[visit.task for visit in tour] for tour in visits])
        assert verify(tight, plan).completed == 12
        assert verify(tight, EilsSolver().improve(tight, plan, "eils")).completed == 12
        found = solver.solve(tight)
        assert verify(tight, found).completed == sum(map(len, found.routes))


@pytest.mark.parametrize("method", ["ils", "eils"])
def test_hopeless_and_extreme_missions(method: str) -> None:
    solver = make_solver(method)
    assert solver.solve(hopeless_scenario()).routes == ((), ())
    for scale in (1e-9, 1e9):
        small = small_scenario(2, tasks=15)
        scaled = Scenario(
            task_xy=small.task_xy * scale, deadline=small.deadline * scale, workload=small.workload * scale,
            robot_xy=small.robot_xy * scale, capacity=small.capacity, speed=small.speed,
            map_size=(50 * scale, 50 * scale),
        )  # fmt: skip
        reached = verify(scaled, solver.solve(scaled)).completed
        assert reached == verify(small, solver.solve(small)).completed > 0


def test_the_searches_do_better_than_the_nearest_task_and_eils_better_than_ils() -> None:
    rng = np.random.default_rng(5)
    cases = [TaptcGenerator(tasks=(60, 60), robots=(4, 4))(rng) for _ in range(10)]
    reached = {
        method: [verify(case, make_solver(method).solve(case)).completed for case in cases]
        for method in ("nearest", "ils", "eils")
    }
    assert sum(reached["nearest"]) < sum(reached["ils"]) < sum(reached["eils"])


def test_a_plan_is_only_improved() -> None:
    rng = np.random.default_rng(6)
    for _ in range(5):
        case = TaptcGenerator(tasks=(40, 40), robots=(3, 3))(rng)
        nearest = make_solver("nearest").solve(case)
        better = EilsSolver(config=EilsConfig(least_iterations=50)).improve(case, nearest, "polished")
        assert better.method == "polished"
        assert verify(case, better).completed >= verify(case, nearest).completed


def test_a_seed_gives_the_same_plan_and_another_a_different_one() -> None:
    case = TaptcGenerator(tasks=(50, 50), robots=(3, 3))(np.random.default_rng(7))
    assert EilsSolver(seed=1).solve(case) == EilsSolver(seed=1).solve(case)
    assert EilsSolver(seed=1).solve(case) != EilsSolver(seed=2).solve(case)
    assert IlsSolver().solve(case) == IlsSolver().solve(case)


@pytest.mark.parametrize("solver", [IlsSolver(budget=2.0), EilsSolver(budget=2.0)], ids=["ils", "eils"])
def test_the_budget_ends_the_search(solver: IlsSolver | EilsSolver, monkeypatch: pytest.MonkeyPatch) -> None:
    looks = iter(np.arange(0.0, 100.0, 0.5))  # half a second passes between two looks at the clock
    monkeypatch.setattr("time.perf_counter", lambda: float(next(looks)))
    solver.solve(small_scenario())
    assert next(looks) == 2.5  # 0.0 at the beginning, then 0.5 … 2.0


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("iterations_per_task", 0),
        ("least_iterations", 0),
        ("removals", math.nan),
        ("noise", -1.0),
        ("by_deadline", 1.5),
        ("blink", math.nan),
        ("reward", 0.0),
        ("hot", math.inf),
    ],
)
def test_bad_settings(option: str, value: float) -> None:
    with pytest.raises(ConfigError, match=f"{option} is {value}; expected a number"):
        EilsConfig(**{option: value})  # type: ignore[arg-type]


def test_the_search_is_compiled_once() -> None:
    EilsSolver()
    before = eils.anneal.signatures
    EilsSolver(budget=0.01).solve(small_scenario())
    assert eils.anneal.signatures == before
    assert len(before) == 1


def on_a_line(places: list[float], last_deadline: float) -> Scenario:
    """A robot at 0 and tasks without work in a row."""
    return Scenario(
        task_xy=[[place, 0] for place in places],
        deadline=[9.0] * (len(places) - 1) + [last_deadline],
        workload=[0.0] * len(places),
        robot_xy=[[0, 0]],
        capacity=[1],
    )


def test_a_visit_that_rounding_makes_late_without_its_detour_is_dropped() -> None:
    rng = np.random.default_rng(0)
    for _ in range(1000):  # until the way by all places is shorter than the straight one, by rounding
        places = np.sort(rng.exponential(size=6)).tolist()
        by_all = verify(on_a_line(places, 9.0), Plan.of([range(6)])).makespan
        if by_all < verify(on_a_line(places, 9.0), Plan.of([[5]])).makespan:
            break
    scenario = on_a_line(places, by_all)
    problem, tours = begun(scenario, list(range(6)))
    assert route(tours) == [0, 1, 2, 3, 4, 5]
    remove(problem, tours, 0, 0, 5)
    assert route(tours) == []
    check(problem, scenario, tours)


def test_a_better_plan_than_can_be_kept_without_its_late_visits_is_left_as_it_is() -> None:
    start = [1.4742614404622973, 0.7371307202311487]
    scenario = Scenario(
        task_xy=[start, [3.6856536011557433, 1.8428265005778716], [2.9485228809245947, 1.4742614404622973]],
        deadline=[4.944823196220684, 2.472411598110342, 1.6482743987402277],
        workload=[0, 0, 0],
        robot_xy=[start, start],
        capacity=[1, 1],
    )
    for routes in ([[0], [2, 1]], [[2, 1], [0]]):
        plan = Plan.of(routes)
        better = EilsSolver().improve(scenario, plan, "x")
        assert verify(scenario, better).completed >= verify(scenario, plan).completed


@pytest.mark.parametrize("solver", [IlsSolver(), EilsSolver()], ids=["ils", "eils"])
def test_one_deadline_far_beyond_the_others_changes_little(solver: IlsSolver | EilsSolver) -> None:
    before, after = 0, 0
    for seed in range(8, 12):
        case = TaptcGenerator(tasks=(60, 60), robots=(3, 3))(np.random.default_rng(seed))
        deadline = case.deadline.copy()
        deadline[0] = 1e12
        mixed = Scenario(
            task_xy=case.task_xy, deadline=deadline, workload=case.workload, robot_xy=case.robot_xy,
            capacity=case.capacity, speed=case.speed, map_size=case.map_size,
        )  # fmt: skip
        before += verify(case, solver.solve(case)).completed
        after += verify(mixed, solver.solve(mixed)).completed
        problem = make_problem(mixed)
        assert (problem.latest[:, 1:] - (deadline - problem.work)[:, 1:] < 1e-6).all()
    assert after >= before - 1
