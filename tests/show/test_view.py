"""Pictures show where and when the mission is."""

from __future__ import annotations

from dataclasses import replace

import pytest

from mrta_zoo import Scenario
from mrta_zoo.show.view import shown_box, shown_time

SCENARIO = Scenario(
    task_xy=[[10, 0], [30, 0], [100, 80]], deadline=[20, 38, 90], workload=[5, 5, 5],
    robot_xy=[[0, 0], [90, 90]], capacity=[1, 1],
)  # fmt: skip


def box(scenario: Scenario) -> list[float]:
    low, size = shown_box(scenario)
    return [*low, *size]


def test_where() -> None:
    assert box(SCENARIO) == [0, 0, 100, 100]  # the map
    far = (-40.0, 5403000.0)
    moved = replace(SCENARIO, task_xy=SCENARIO.task_xy + far, robot_xy=SCENARIO.robot_xy + far, map_origin=far)
    assert box(moved) == [*far, 100, 100]
    assert box(replace(SCENARIO, map_size=(250, 200))) == [0, 0, 250, 200]
    assert box(replace(SCENARIO, map_size=(512010, 5403010))) == [0, 0, 100, 90]  # where tasks and robots are
    line = replace(SCENARIO, task_xy=[[5, 0], [5, 40], [5, 80]], robot_xy=[[5, 0], [5, 80]], map_size=(1000, 1000))
    assert box(line) == [-5, 0, 20, 80]


def test_until_when() -> None:
    assert shown_time(SCENARIO, 120) == 120
    assert shown_time(SCENARIO, 60) == 90
    assert shown_time(SCENARIO, 40) == 80
    assert shown_time(SCENARIO, 0) == 90
    lasting = replace(SCENARIO, deadline=[20, 38, 1e9])
    # From 20 on, the two robots could do one task each: across the map, and half of all work and of the heaviest.
    assert shown_time(lasting, 0) == pytest.approx(20 + 100 * 2**0.5 + 10 / 2 + 5 / 2)
