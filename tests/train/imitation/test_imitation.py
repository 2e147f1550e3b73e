"""Following plans: the decisions are the plan's, in the simulator's order, and no others."""

from __future__ import annotations

from dataclasses import fields
from itertools import pairwise

import numpy as np
import pytest
import torch
from strategies import seeded_chooser, seeded_scenarios

from mrta_zoo.mission import Mission
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.local_search.eils import EilsConfig, EilsSolver
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.rollout import Segment
from mrta_zoo.policies.neural.sharing import build_network
from mrta_zoo.scales import Scales
from mrta_zoo.scenario import Scenario
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.imitation.decisions import PlanBatch, follow, turned
from mrta_zoo.train.imitation.experts import ExpertPlan, Routes
from mrta_zoo.verify import verify

PLUS = NetworkConfig(embedding=8, heads=2, decoder="candidates", decision_layers=0, candidates=4, peers=1)
CPU = torch.device("cpu")


def eils_routes(scenario: Scenario) -> Routes:
    config = EilsConfig(iterations_per_task=1, least_iterations=30)
    return EilsSolver(config=config).solve(scenario).routes


def random_routes(scenario: Scenario, seed: int) -> Routes:
    """A legal mission at random, whose robots stop early at random, though they could go on."""
    mission, choose, rng = Mission(scenario), seeded_chooser(seed), np.random.default_rng(seed)
    while not mission.done:
        mission.assign(choose(mission.mask(mission.actor)))
    return tuple(tuple(route[: rng.integers(len(route) + 1)]) for route in mission.routes)


def simulated(scenario: Scenario, routes: Routes) -> list[tuple[int, int, float, list[bool]]]:
    """Robot, task, time, and who still works, of each decision: whoever is free first, then the lowest number."""
    left = [list(route) for route in routes]
    ready = [0.0] * len(routes)
    finish = {v.task: v.finish for route in verify(scenario, Plan(routes)).schedule for v in route}
    decisions = []
    while any(left):
        now, robot = min((ready[robot], robot) for robot, route in enumerate(left) if route)
        working = [bool(route) or (ready[other], other) > (now, robot) for other, route in enumerate(left)]
        task = left[robot].pop(0)
        ready[robot] = finish[task]
        decisions.append((robot, task, now, working))
    return decisions


def check_followed(scenarios: list[Scenario], routes: list[Routes], segments: list[Segment]) -> int:
    """The decisions in the segments are the simulated ones; how many there are."""
    followed: list[list[tuple[int, int]]] = [[] for _ in scenarios]
    want = [simulated(*each) for each in zip(scenarios, routes, strict=True)]
    for segment in segments:
        for row, b in enumerate(segment.scenarios.tolist()):
            m = scenarios[b].num_robots
            for q in segment.live[row].nonzero().flatten().tolist():
                robot, task = int(segment.states.ego[row, q]), int(segment.actions[row, q])
                assert segment.states.mask[row, q, task], "what a plan takes is legal"
                *_, now, working = want[b][len(followed[b])]
                elapsed = float(segment.states.elapsed[row, q])
                assert elapsed == pytest.approx(min(1.0, now / Scales.of(scenarios[b]).time), rel=1e-6)
                assert segment.states.working[row, q, :m].tolist() == working
                assert not segment.states.working[row, q, m:].any()
                followed[b].append((robot, task))
    assert followed == [[(robot, task) for robot, task, *_ in each] for each in want]
    return sum(map(len, followed))


@pytest.mark.parametrize("decoder", ["attention", "candidates"])
def test_decisions_are_those_of_the_plans(decoder: str) -> None:
    config = PLUS if decoder == "candidates" else NetworkConfig(embedding=8, heads=2)
    network = build_network(config, "shared", 1, seed=0)
    cases = seeded_scenarios(50, 120)
    for plans in ([eils_routes(each) for each in cases], [random_routes(each, b) for b, each in enumerate(cases)]):
        batch = PlanBatch([ExpertPlan(*each) for each in zip(cases, plans, strict=True)], CPU)
        assert len(batch) == len(cases)
        segments = follow(network, batch.scenarios, batch.routes)
        decisions = check_followed(cases, plans, segments)
        assert decisions == sum(len(route) for plan in plans for route in plan) > 150
        for segment in segments:
            assert (segment.features is not None) == (decoder == "candidates")


def test_a_robot_at_the_end_of_its_route_retires() -> None:
    # Both robots could do all three tasks; the plan gives robot 1 one of them, and robot 0 nothing.
    scenario = Scenario([[1, 0], [2, 0], [3, 0]], [90, 90, 90], [1, 1, 1], [[0, 0], [0, 0]], [1, 1])  # type: ignore[arg-type]
    plans = PlanBatch([ExpertPlan(scenario, ((), (1,)))], CPU)
    assert plans.routes.tolist() == [[[-1, -1], [1, -1]]]
    (segment,) = follow(build_network(PLUS, "shared", 1, seed=0), plans.scenarios, plans.routes)
    # Step 0: robot 0 retires. Step 1: robot 1 takes task 1. Step 2: it retires, and the mission is over.
    assert segment.live[0].nonzero().flatten().tolist() == [1]
    assert segment.states.ego[0, 1] == 1
    assert segment.actions[0, 1] == 1
    assert segment.states.working[0, 1].tolist() == [False, True]
    assert segment.states.mask[0, 1].tolist() == [True, True, True]


def test_plans_without_any_task_leave_nothing_to_decide() -> None:
    scenario = Scenario([[1, 0]], [90], [1], [[0, 0]], [1])  # type: ignore[arg-type]
    plans = PlanBatch([ExpertPlan(scenario, ((),))], CPU)
    (segment,) = follow(build_network(PLUS, "shared", 1, seed=0), plans.scenarios, plans.routes)
    assert not segment.live.any()


def test_symmetries_by_hand() -> None:
    three = {"deadline": [900, 900, 900], "workload": [1, 1, 1], "robot_xy": [[0, 40]], "capacity": [1]}
    square = Scenario(task_xy=[[10, 30], [99, 5], [50, 90]], map_size=(100, 100), **three)  # type: ignore[arg-type]
    wide = Scenario(task_xy=[[10, 30], [190, 5], [50, 90]], map_size=(200, 100), **three)  # type: ignore[arg-type]
    moved = Scenario([[10, 30], [12, 34]], [90, 90], [1, 1], [[10, 34]], [1], map_size=(200, 100))  # type: ignore[arg-type]
    batch = ScenarioBatch.of([square, wide])
    # The frame of the third is 2 wide and 4 high from 10, 30 on: its corner goes to the right, and up.
    seen = turned(ScenarioBatch.of([moved]), torch.tensor([1])), turned(ScenarioBatch.of([moved]), torch.tensor([2]))
    assert [each.task_xy[0].tolist() for each in seen] == [[[12, 30], [10, 34]], [[10, 34], [12, 30]]]
    places = [turned(batch, torch.full((2,), symmetry)).task_xy[:, 0].tolist() for symmetry in range(8)]
    assert [place for place, _ in places] == [
        [10, 30], [90, 30], [10, 70], [90, 70], [30, 10], [30, 90], [70, 10], [70, 90]
    ]  # fmt: skip
    assert [place for _, place in places] == [[10, 30], [190, 30], [10, 70], [190, 70]] * 2
    assert turned(batch, torch.tensor([5, 5])).robot_xy[:, 0].tolist() == [[40, 100], [200, 40]]
    assert turned(batch, torch.tensor([5, 2])).robot_xy[:, 0].tolist() == [[40, 100], [0, 60]]


def test_symmetries_keep_distances_and_everything_else() -> None:
    cases = [each for each in seeded_scenarios(51, 40) if each.num_tasks > 1]
    batch = ScenarioBatch.of(cases, mask_rule="active")  # by which all places are in the frame

    def distances(scenarios: ScenarioBatch, row: int) -> torch.Tensor:
        case = cases[row]
        points = torch.cat((scenarios.task_xy[row, : case.num_tasks], scenarios.robot_xy[row, : case.num_robots]))
        return torch.cdist(points, points)

    for symmetry in range(8):
        seen = turned(batch, torch.full((len(cases),), symmetry))
        for row, case in enumerate(cases):
            size = max(case.map_end)
            torch.testing.assert_close(distances(seen, row), distances(batch, row), rtol=0, atol=1e-9 * size)
            xy = seen.task_xy[row, : case.num_tasks]
            assert (xy >= torch.tensor(case.map_origin) - 1e-9 * size).all()
            assert (xy <= torch.tensor(case.map_end) + 1e-9 * size).all()
        for each in fields(batch):
            if each.name not in ("task_xy", "robot_xy", "scales"):
                assert torch.equal(getattr(seen, each.name), getattr(batch, each.name)), each.name
        if symmetry < 4:  # flips
            again = turned(seen, torch.full((len(cases),), symmetry))
            size = batch.scales.length[:, None, None]
            assert ((again.task_xy - batch.task_xy).abs() <= 1e-12 * size).all()
            assert ((again.robot_xy - batch.robot_xy).abs() <= 1e-12 * size).all()


def test_the_eight_symmetries_differ() -> None:
    scenario = Scenario([[10, 30], [90, 90], [50, 5]], [900] * 3, [1] * 3, [[0, 40]], [1])  # type: ignore[arg-type]
    batch = ScenarioBatch.of([scenario])
    images = sorted(tuple(turned(batch, torch.tensor([symmetry])).task_xy.flatten().tolist()) for symmetry in range(8))
    assert all(one != other for one, other in pairwise(images))
