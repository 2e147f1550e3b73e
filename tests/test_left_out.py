"""What a plan leaves out, and why."""

from __future__ import annotations

import pytest
from factories import hopeless_scenario, named_scenario, small_scenario

from mrta_zoo.left_out import LeftOut, left_out
from mrta_zoo.plan import Plan
from mrta_zoo.reach import in_time
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify


def test_reasons() -> None:
    named = named_scenario()
    # Bob & Co could do $x$ until 21 of 25, or Ann pump #3 until 40 of 50; nobody 弁[red].
    assert left_out(named, Plan.of([[0, 1], [2]])) == (
        LeftOut(3, "out of reach"),
        LeftOut(4, "others were worth more"),
    )
    assert left_out(named, Plan.of([[0], [4]])) == (
        LeftOut(1, "others were worth more"),
        LeftOut(2, "others were worth more"),
        LeftOut(3, "out of reach"),
    )
    assert left_out(named, Plan.of([[0, 1, 2, 3], [4]])) == ()  # late is not left out
    assert left_out(hopeless_scenario(), Plan.of([[], []])) == (LeftOut(0, "out of reach"),)


def test_just_in_time_is_within_reach() -> None:
    for deadline, reached in ((15.0, True), (14.999, False)):  # 10 of way, 5 of work
        scenario = Scenario([[10, 0]], [deadline], [5], [[0, 0]], [1])  # type: ignore[arg-type,list-item]
        assert in_time(scenario).tolist() == [[reached]]


@pytest.mark.parametrize("seed", range(5))
def test_reach_is_what_the_verifier_finds(seed: int) -> None:
    scenario = small_scenario(seed, tasks=30, robots=3, latest=40.0)

    def alone(robot: int, task: int) -> int:
        routes = [[task] if each == robot else [] for each in range(3)]
        return verify(scenario, Plan.of(routes)).completed

    found = [[bool(alone(robot, task)) for task in range(30)] for robot in range(3)]
    assert in_time(scenario).tolist() == found
    assert 0 < sum(map(any, zip(*found, strict=True))) < 30
