"""By what a mission is measured: by hand, and untouched by where it lies, how large its map is, and one odd value."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from strategies import seeded_scenarios

from mrta_zoo import Scenario
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.scales import Scales, frame_of
from mrta_zoo.verify import verify

LINE = Scenario(
    task_xy=[[0, 0], [30, 0], [0, 40]],
    deadline=[10, 60, 90],
    workload=[0, 6, 3],
    robot_xy=[[0, 0]],
    capacity=[2],
    speed=[5],
    map_size=(40, 50),
)
"""The frame is the map: no margin is over a quarter of 40, the longer extent."""


def moved(scenario: Scenario, dx: float, dy: float) -> Scenario:
    """The mission elsewhere, on a map that still begins at 0 and 0, or before that."""
    offset, (width, height) = np.array([dx, dy]), scenario.map_size
    return replace(
        scenario,
        task_xy=scenario.task_xy + offset,
        robot_xy=scenario.robot_xy + offset,
        map_size=(width + abs(dx), height + abs(dy)),
        map_origin=(min(dx, 0.0), min(dy, 0.0)),
    )


def with_odd(scenario: Scenario, what: str, factor: float) -> Scenario:
    """One value multiplied: of task 0, or of robot 0."""
    values = getattr(scenario, what).copy()
    values[0] *= factor
    return replace(scenario, **{what: values})


def test_the_frame_by_hand() -> None:
    assert [each.tolist() for each in frame_of(LINE)] == [[0, 0], [40, 50]]
    # 11 to the right of everything is more than a quarter of 40.
    assert [each.tolist() for each in frame_of(replace(LINE, map_size=(41, 50)))] == [[0, 0], [30, 40]]
    assert [each.tolist() for each in frame_of(moved(LINE, 7000, 11))] == [[7000, 11], [30, 40]]
    alone = replace(LINE, task_xy=[[0, 0]] * 3)  # all at one place, which has no extent
    assert [each.tolist() for each in frame_of(alone)] == [[0, 0], [40, 50]]


def test_a_place_that_nobody_can_get_to_is_not_in_the_frame() -> None:
    far = [[0, 0], [30, 0], [0, 40], [4000, 0]]  # due at 90; 4000 away takes 800
    mission = replace(LINE, task_xy=far, deadline=[10, 60, 90, 90], workload=[0, 6, 3, 0], map_size=(5000, 5000))
    assert [each.tolist() for each in frame_of(mission)] == [[0, 0], [30, 40]]
    # By a rule that lets robots go there all the same, it counts.
    assert Scales.of(mission, "active").extent.tolist() == [4000, 40]
    # With all the time in the world somebody can get there.
    assert [each.tolist() for each in frame_of(replace(mission, deadline=[10, 60, 90, 900]))] == [[0, 0], [4000, 40]]
    # A robot out there can do nothing, either.
    robots = replace(LINE, robot_xy=[[0, 0], [4000, 0]], capacity=[2, 2], speed=[5, 5], map_size=(5000, 5000))
    assert [each.tolist() for each in frame_of(robots)] == [[0, 0], [30, 40]]


def test_the_time_that_can_matter_by_hand() -> None:
    # The frame is crossed in hypot(40, 50) / 5 = 12.81; works take 0, 3 and 1.5.
    # From 10 on: tasks 1 and 2, 10 + 2 · 12.81 + 4.5 = 40.1 (2 · 64.03 is less than (√4 + 1.75) · 50 + 64.03 of way);
    # from 60 on: task 2, 60 + 12.81 + 1.5. Or from 90 on, none.
    assert Scales.of(LINE).time == pytest.approx(10 + 2 * np.hypot(40, 50) / 5 + 4.5)
    # With a slow robot all could not wait so long: 10 + 2 · 128.1 + 4.5 and 60 + 128.1 + 1.5 are beyond 90.
    assert Scales.of(replace(LINE, speed=[0.5])).time == 90
    # 40 of 79 robots could do 80 tasks, two each, in 2 · 12.81; of 80 · 2 / 2 = 80 of work a 40th each, and 39/40 of 1.
    many = Scenario(
        task_xy=[[0, 0], *[[40, 50]] * 80], deadline=[10, *[900] * 80], workload=[0, *[2] * 80],
        robot_xy=[[0, 0]] * 79, capacity=[2] * 79, speed=[5] * 79, map_size=(40, 50),
    )  # fmt: skip
    assert Scales.of(many).time == pytest.approx(10 + 2 * np.hypot(40, 50) / 5 + 80 / 40 + 39 / 40)


def test_odd_values_by_hand() -> None:
    many = Scenario(
        task_xy=[[0, 0], [100, 100], [0, 100], [100, 0]],
        deadline=[90, 90, 90, 90],
        workload=[10, 15, 20, 700],
        robot_xy=[[0, 0], [0, 0], [0, 0]],
        capacity=[1, 10, 10.5],
        speed=[1, 3, 60],
    )
    scales = Scales.of(many)
    # 60 is more than 10 times 3, and crosses the frame 60 · 90/100 = 54 times until 90: enough. And 10 is not more than
    # 10 times 1. 700 are done in 700/10.5 = 66.7 <= 90, so W is 4 times the median of 10, 15, 20, 700, the lower one.
    assert (scales.capacity, scales.speed, scales.work) == (10.5, 3, 60)
    # 1000/10.5 = 95.2 > 90: nobody can do it, so it does not count.
    assert Scales.of(replace(many, workload=[10, 15, 20, 1000])).work == 20
    assert Scales.of(replace(many, speed=[1, 3, 50])).speed == 50  # 45 times are not enough
    # 1000 do 60 in 0.06, a 555th of the 33.3 that a crossing takes: more than enough. 200 are, too, beside 10.
    assert Scales.of(replace(many, capacity=[1, 10, 1000])).capacity == 10
    assert Scales.of(replace(many, capacity=[15, 150, 1000])).capacity == 1000
    # The weak do not make the strong odd, however many and weak they are.
    assert Scales.of(replace(many, capacity=[0.2, 0.2, 5])).capacity == 5
    # A robot that can do nothing in time does not count.
    assert Scales.of(replace(many, capacity=[1, 5, 5], robot_xy=[[0, 0]] * 3, speed=[1, 3, 1e-3])).speed == 3


def test_ordinary_missions_have_the_largest_of_everything_as_scales() -> None:
    for seed in range(20):
        scenario = TaptcGenerator()(np.random.default_rng(seed))
        scales = Scales.of(scenario)
        assert (scales.origin.tolist(), scales.extent.tolist(), scales.length) == ([0, 0], [100, 100], 100)
        assert scales.time == scenario.deadline.max()
        assert (scales.work, scales.capacity, scales.speed) == (20, scenario.capacity.max(), 1)


def test_no_plan_needs_more_time_than_can_matter() -> None:
    """Clipping all deadlines there costs no task of an optimal plan."""
    exact = make_solver("exact")
    clipped = 0
    for scenario in seeded_scenarios(60, 80):
        if scenario.num_tasks > 7:
            continue
        latest = Scales.of(scenario).time
        if latest < scenario.deadline.max():
            clipped += 1
            short = replace(scenario, deadline=np.minimum(scenario.deadline, latest))
            counts = [verify(each, exact.solve(each)).completed for each in (scenario, short)]
            assert counts[0] == counts[1], scenario.name
    assert clipped > 5


CASES = [TaptcGenerator(tasks=(40, 40), robots=(m, m))(np.random.default_rng(m)) for m in (2, 3, 5)]
ELSEWHERE = [(100, 100), (-30, -2000), (512_000, 5_403_000)]


@pytest.mark.parametrize("place", ELSEWHERE)
@pytest.mark.parametrize("method", ["nearest", "edf", "big-mrta", "ils", "eils"])
def test_classical_methods_do_the_same_anywhere(method: str, place: tuple[float, float]) -> None:
    """Whole coordinates, so that moving them loses no digits."""
    solver = make_solver(method)
    for scenario in CASES:
        assert solver.solve(moved(scenario, *place)).routes == solver.solve(scenario).routes


def completed(method: str, scenarios: list[Scenario]) -> int:
    solver = make_solver(method)
    return sum(verify(each, solver.solve(each)).completed for each in scenarios)


@pytest.mark.parametrize("method", ["capam", "capam-plus"])
def test_networks_do_as_well_anywhere(method: str) -> None:
    as_it_was = completed(method, CASES)
    for place in ELSEWHERE[::2]:
        there = completed(method, [moved(each, *place) for each in CASES])
        assert abs(there - as_it_was) <= 0.05 * as_it_was


@pytest.mark.parametrize("map_size", [(1e3, 1e3), (1e9, 1e5)])
def test_the_size_of_the_map_does_not_matter(map_size: tuple[float, float]) -> None:
    wide = [replace(each, map_size=map_size) for each in CASES]
    for method in ("nearest", "big-mrta"):
        assert completed(method, wide) == completed(method, CASES)
    assert completed("capam", wide) >= 0.95 * completed("capam", CASES)


ODD: list[tuple[str, float]] = [
    ("deadline", 1e3), ("deadline", 1e9), ("deadline", 1e-9),
    ("workload", 30), ("workload", 1e9),
    ("capacity", 1e9), ("capacity", 1e-9), ("speed", 1e9), ("speed", 1e-9),
]  # fmt: skip


@pytest.mark.parametrize(("what", "factor"), ODD)
def test_one_odd_value_does_not_spoil_what_a_network_does_with_the_rest(what: str, factor: float) -> None:
    """Measured against a rule that has no scales: the policy keeps its lead over the nearest task."""
    odd = [with_odd(each, what, factor) for each in CASES]
    assert completed("capam", odd) >= 0.98 * completed("nearest", odd)


@pytest.mark.parametrize("method", ["nearest", "big-mrta", "capam"])
def test_one_far_place_does_not_spoil_what_is_done_with_the_rest(method: str) -> None:
    """Task 0 is out of reach before and after."""
    for scenario in CASES:
        wide, deadline, task_xy = (1e7, 1e7), scenario.deadline.copy(), scenario.task_xy.copy()
        deadline[0] = 1e-3
        before = replace(scenario, deadline=deadline, map_size=wide)
        task_xy[0] = (9e6, 9e6)
        after = replace(scenario, task_xy=task_xy, map_size=wide)
        routes = [make_solver(method).solve(each).routes for each in (before, after)]
        if method == "capam":  # the encoder sees it elsewhere
            done = [sum(map(len, each)) for each in routes]
            assert abs(done[0] - done[1]) <= 2
        else:
            assert routes[0] == routes[1]


@pytest.mark.parametrize("latest", [1e4, 1e9])
def test_one_late_deadline_changes_no_route_of_a_rule(latest: float) -> None:
    """The task that can wait is one that was done anyway; only when may change, as nobody looks at what may wait."""
    for scenario in CASES:
        deadline = scenario.deadline.copy()
        deadline[deadline.argmax()] = latest
        for method in ("nearest", "big-mrta"):
            first = make_solver(method).solve(replace(scenario, deadline=deadline))
            last = make_solver(method).solve(replace(scenario, deadline=np.minimum(deadline, 2e3)))
            assert first.routes == last.routes


def test_pyvrp_keeps_its_digits() -> None:
    mission: dict[str, Any] = {
        "task_xy": [[10 * (j + 1), 0] for j in range(9)],
        "deadline": [15.0 * (j + 1) for j in range(8)] + [1e9],
        "workload": [5] * 9,
        "robot_xy": [[0, 0]],
        "capacity": [1],
    }
    # One after the other: task j is done at 10 (j + 1) + 5 (j + 1) = 15 (j + 1), its deadline.
    plan = make_solver("pyvrp", budget=1).solve(Scenario(**mission))
    assert verify(Scenario(**mission), plan).completed == 9
