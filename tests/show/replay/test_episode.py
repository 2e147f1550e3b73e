"""What the replay page is told of an episode."""

from __future__ import annotations

import numpy as np
import pytest
from factories import named_scenario

from mrta_zoo import Plan, Scenario
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.rules import MaskReason
from mrta_zoo.show.render.whereabouts import whereabouts
from mrta_zoo.show.replay.episode import MOST_CANDIDATES, MOST_MASKED, VisitJson, episode_of, place_of
from mrta_zoo.trace import Choice, Trace

# On the x axis, robots at 0 (capacity 2) and 100. Task 0 is at 10, task 1 at 30, task 2 at 100, task 3 out of reach.
SCENARIO = Scenario(
    task_xy=[[10, 0], [30, 0], [100, 0], [0, 100]], deadline=[40, 50, 30, 50], workload=[6, 4, 20, 0],
    robot_xy=[[0, 0], [100, 0]], capacity=[2, 1], map_size=(100, 100), name="line",
)  # fmt: skip
# Robot 0: 10 of way and 6 / 2 of work, done at 13; 20 and 4 / 2, done at 35. Robot 1: no way, 20 of work.
TRACE = Trace(SCENARIO, (Choice(0, {0: 0.75, 1: 0.2}), Choice(2, advice=1), Choice(1)), method="mine")


def test_visits() -> None:
    episode = episode_of(TRACE)
    assert episode.routes == [
        # The line to task 1's deadline begins at 35, where that to task 0's, until 40, lies below it.
        [VisitJson(0, 0, 0.0, 10.0, 13.0, True, 0), VisitJson(1, 2, 13.0, 33.0, 35.0, True, 1)],
        [VisitJson(2, 1, 0.0, 100.0 - 100.0, 20.0, True, 0)],
    ]
    assert (episode.completed, episode.makespan, episode.method) == (3, 35.0, "mine")
    assert episode.cost == pytest.approx(50 / 50)  # task 3, which nobody took, counts as finished at its deadline


def test_decisions() -> None:
    first, second, third = episode_of(TRACE).decisions
    assert (first.time, first.robot, first.task, first.advice) == (0.0, 0, 0, None)
    assert (second.robot, second.task, second.advice) == (1, 2, 1)
    assert (third.time, third.robot, third.task) == (13.0, 0, 1)
    assert first.reasons == [2, 0, 0, 2]  # robot 0 can be at task 2 only at 100, at task 3 only at 100
    assert third.reasons == [1, 2, 0, 1]


def test_candidates() -> None:
    first, second, third = episode_of(TRACE).decisions
    assert [(each.task, each.probability) for each in first.candidates[:2]] == [(0, 0.75), (1, 0.2)]
    assert [(each.task, each.reason) for each in first.candidates[2:]] == [
        (2, MaskReason.TOO_LATE),
        (3, MaskReason.TOO_LATE),
    ]
    assert (first.candidates[1].distance, first.candidates[1].finish) == (30.0, 32.0)  # 30 of way, 4 / 2 of work
    assert all(each.probability is None for each in third.candidates)
    # Robot 1 could do task 2 from 0 to 20 and nothing else in time.
    assert (second.candidates[0].task, second.candidates[0].note) == (2, "nobody else in time")
    assert first.candidates[-1].note == "too late by 50.0"  # robot 0 is at task 3 at 100, which is due at 50
    taken = [(each.task, each.note) for each in second.candidates if each.reason == MaskReason.TAKEN]
    assert taken == [(0, "robot 0 on it until 13.0")]


def test_the_likeliest_are_listed_and_always_the_one_taken() -> None:
    scenario = UniformGenerator(tasks=(40, 40), robots=(3, 3))(np.random.default_rng(0))
    trace = Trace.of_plan(scenario, make_solver("random").solve(scenario))
    for shown, choice in zip(episode_of(trace).decisions, trace.choices, strict=True):
        tasks = [each.task for each in shown.candidates]
        assert choice.task in tasks
        assert len(tasks) == len(set(tasks)) <= MOST_CANDIDATES + 1 + MOST_MASKED
        assert sum(shown.reasons) == 40
        choosable = [each.finish for each in shown.candidates if each.reason == 0 and each.task != choice.task]
        assert choosable == sorted(choosable)


def test_a_robot_that_stays() -> None:
    episode = episode_of(Trace.of_plan(SCENARIO, Plan.of([(), (2,)])))
    assert [decision.task for decision in episode.decisions] == [None, 2]
    assert episode.routes[0] == []


def test_between_its_times_a_robot_is_on_the_straight_line_as_the_page_draws_it() -> None:
    scenario = UniformGenerator(tasks=(30, 30), robots=(4, 4), speed=(0.5, 2.0))(np.random.default_rng(1))
    trace = Trace.of_plan(scenario, make_solver("nearest").solve(scenario))
    routes = episode_of(trace).routes
    for mission, decision in trace.steps():
        for robot in range(4):
            here = whereabouts(mission, robot)
            expected = drawn_at(scenario, robot, routes[robot], decision.time, decision.index)
            assert (here.x, here.y) == pytest.approx(expected, abs=1e-3)


def drawn_at(scenario: Scenario, robot: int, route: list[VisitJson], time: float, made: int) -> tuple[float, float]:
    """Where the page draws a robot once `made` decisions have been made."""
    visits = [visit for visit in route if visit.decision < made]
    places = [scenario.robot_xy[robot], *(scenario.task_xy[visit.task] for visit in visits)]
    if not visits:
        return tuple(places[0])
    way = visits[-1].arrive - visits[-1].leave
    share = 1.0 if way == 0 else min(1.0, (time - visits[-1].leave) / way)
    return tuple(places[-2] + share * (places[-1] - places[-2]))


def test_names() -> None:
    named = named_scenario()
    place = place_of(named, 0.0)
    assert (place.task_names, place.robot_names) == (list(named.task_names), list(named.robot_names))
    assert place_of(SCENARIO, 0.0).task_names == ["0", "1", "2", "3"]
    assert place_of(SCENARIO, 0.0).robot_names == ["robot 0", "robot 1"]
    second = episode_of(Trace(named, (Choice(0), Choice(2)))).decisions[1]
    assert [each.note for each in second.candidates if each.task == 0] == ["Ann on it until 15.0"]
