"""What a robot sees: every column by hand, for one small mission under way."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from strategies import seeded_chooser, seeded_scenarios

from mrta_zoo.env.observation import (
    EGO_FEATURES,
    MISSION_FEATURES,
    ROBOT_FEATURES,
    TASK_FEATURES,
    Observer,
    observation_space,
)
from mrta_zoo.mission import Mission
from mrta_zoo.scales import Scales
from mrta_zoo.scenario import Scenario

# Scales: L = 75, T = 40, W = 8, C = 2, V = 5. The frame is the map: no margin is over a quarter of 60, the extent.
SCENARIO = Scenario(
    task_xy=np.array([[3, 4], [30, 40], [6, 4], [60, 0]]),
    deadline=np.array([10, 40, 4, 6]),
    workload=np.array([4, 8, 1, 2]),
    robot_xy=np.array([[0, 0], [6, 8]]),
    capacity=np.array([2.0, 1.0]),
    speed=np.array([1.0, 5.0]),
    map_size=(75, 50),
)


def look(mission: Mission, robot: int, max_tasks: int = 5, max_robots: int = 3) -> dict[str, Any]:
    return Observer(mission.scenario, max_tasks, max_robots, mission.mask_rule).observe(mission, robot)


def under_way() -> Mission:
    """Robot 0 took task 0, free at 5 + 4/2 = 7. Robot 1 did task 2 until 4/5 + 1/1 = 1.8, and is to act."""
    mission = Mission(SCENARIO, "unvisited")
    mission.assign(0)
    mission.assign(2)
    assert (mission.time, mission.actor) == (1.8, 1)
    return mission


def equal(seen: np.ndarray, want: list[Any]) -> bool:
    return seen.dtype == np.float32 and np.array_equal(seen, np.array(want, dtype=np.float32))


def test_the_names_are_the_columns() -> None:
    assert TASK_FEATURES == ("x", "y", "deadline", "workload", "active", "assigned", "completed", "missed")
    assert ROBOT_FEATURES == ("x", "y", "capacity", "speed", "ready", "working", "is_ego")
    assert EGO_FEATURES == ("x", "y", "capacity", "speed", "ready")
    assert MISSION_FEATURES == ("elapsed", "crossing_ratio", "work_ratio")


def test_tasks() -> None:
    assert equal(
        look(under_way(), 1)["observation"]["tasks"],
        [
            [3 / 75, 4 / 75, 10 / 40, 4 / 8, 0, 1, 0, 0],  # robot 0 is on its way
            [30 / 75, 40 / 75, 40 / 40, 8 / 8, 1, 0, 0, 0],
            [6 / 75, 4 / 75, 4 / 40, 1 / 8, 0, 0, 1, 0],
            [60 / 75, 0 / 75, 6 / 40, 2 / 8, 1, 0, 0, 0],
            [0] * 8,  # padding
        ],
    )


def test_tasks_at_the_end() -> None:
    mission = under_way()
    # Robot 1: (6, 4) to (60, 0) is 54² + 4² = 2932, 54.15 / 5 + 2 = 12.83 after 1.8, late for 6.
    mission.assign(3)
    mission.assign(1)
    status = look(mission, 0)["observation"]["tasks"][:4, 4:]
    # Robot 0: (3, 4) to (30, 40) is 45: 7 + 45 + 8/2 = 56, late for 40.
    assert status.tolist() == [[0, 0, 1, 0], [0, 0, 0, 1], [0, 0, 1, 0], [0, 0, 0, 1]]


def test_robots() -> None:
    for robot in (0, 1):
        assert equal(
            look(under_way(), robot)["observation"]["robots"],
            [
                [3 / 75, 4 / 75, 2 / 2, 1 / 5, 7 / 40, 1, robot == 0],
                [6 / 75, 4 / 75, 1 / 2, 5 / 5, 1.8 / 40, 1, robot == 1],
                [0] * 7,  # padding
            ],
        )


def test_ego_is_the_observers_row() -> None:
    mission = under_way()
    assert equal(look(mission, 0)["observation"]["ego"], [3 / 75, 4 / 75, 2 / 2, 1 / 5, 7 / 40])
    assert equal(look(mission, 1)["observation"]["ego"], [6 / 75, 4 / 75, 1 / 2, 5 / 5, 1.8 / 40])


def test_mission() -> None:
    # L/V/T = 80 / 5 / 40 = 0.4 → 0.375 / 1.375; W/C/T = 8 / 2 / 40 = 0.1 → 0.1 / 1.1.
    assert look(under_way(), 1)["observation"]["mission"] == pytest.approx(
        [1.8 / 40, 0.375 / 1.375, 0.1 / 1.1], abs=1e-7
    )


def test_times_after_the_last_deadline_show_as_one() -> None:
    mission = under_way()
    mission.assign(3)
    mission.assign(1)
    seen = look(mission, 0)["observation"]
    assert mission.time == 56.0
    assert seen["mission"][0] == 1.0
    assert seen["robots"][0, 4] == seen["ego"][4] == 1.0
    assert seen["robots"][:2, 5].tolist() == [0, 0], "retired robots do not work any more"


def test_action_mask() -> None:
    mission = under_way()
    for robot in (0, 1):
        mask = look(mission, robot)["action_mask"]
        assert mask.dtype == np.int8
        assert mask.tolist() == [0, 1, 0, 1, 0]
    # Feasible: robot 1 needs 40/5 = 8 from (6, 8) to (30, 40) and 8/1 = 8 there, 16 <= 40;
    # task 3 is 54² + 8² = 2980, 54.59 away, 54.59/5 + 2/1 = 12.92 > 6.
    assert look(Mission(SCENARIO), 1)["action_mask"].tolist() == [1, 1, 1, 0, 0]


def test_an_observation_is_the_callers_own() -> None:
    mission = under_way()
    observer = Observer(SCENARIO, 5, 3, "unvisited")
    first, second = observer.observe(mission, 1), observer.observe(mission, 1)
    for part in first["observation"].values():
        part[:] = 77
    first["action_mask"][:] = 77
    third = observer.observe(mission, 1)
    for name in second["observation"]:
        assert np.array_equal(second["observation"][name], third["observation"][name]), name
    assert np.array_equal(second["action_mask"], third["action_mask"])


def test_an_observation_does_not_change_with_the_mission() -> None:
    mission = under_way()
    observer = Observer(SCENARIO, 5, 3, "unvisited")
    seen = observer.observe(mission, 1)
    before = {name: part.copy() for name, part in seen["observation"].items()}
    mission.assign(3)
    mission.assign(1)
    observer.observe(mission, 0)
    for name, part in seen["observation"].items():
        assert np.array_equal(part, before[name]), name
    assert seen["action_mask"].tolist() == [0, 1, 0, 1, 0]


def test_a_long_lived_observer_sees_what_a_new_one_sees() -> None:
    for seed, scenario in enumerate(seeded_scenarios(40, 40)):
        mission, chooser = Mission(scenario, "active"), seeded_chooser(seed)
        observer = Observer(scenario, 12, 4, mission.mask_rule)
        while not mission.done:
            mission.assign(chooser(mission.mask(mission.actor)))
            for robot in range(scenario.num_robots):
                old, new = observer.observe(mission, robot), look(mission, robot, 12, 4)
                assert np.array_equal(old["action_mask"], new["action_mask"])
                for name, part in old["observation"].items():
                    assert np.array_equal(part, new["observation"][name]), name


def test_every_observation_is_in_its_space() -> None:
    space = observation_space(12, 4)
    for seed, scenario in enumerate(seeded_scenarios(50, 100)):
        mission, chooser = Mission(scenario, "unvisited"), seeded_chooser(seed)
        while True:
            for robot in range(scenario.num_robots):
                seen = look(mission, robot, 12, 4)
                assert space.contains(seen)
                assert seen["observation"]["tasks"][: scenario.num_tasks, 4:].sum(1).tolist() == [1.0] * len(
                    scenario.deadline
                )
            if mission.done:
                break
            mission.assign(chooser(mission.mask(mission.actor)))


def test_scales() -> None:
    scales = Scales.of(SCENARIO, "unvisited")
    assert (scales.length, scales.time, scales.work, scales.capacity, scales.speed) == (75.0, 40.0, 8.0, 2.0, 5.0)
    assert scales.crossing_ratio == pytest.approx(0.375 / 1.375)
    assert scales.work_ratio == pytest.approx(0.1 / 1.1)


def test_no_work_at_all_has_scale_one() -> None:
    visits = Scenario(
        np.array([[3, 4]]), np.array([9]), np.array([0]), np.array([[0, 0]]), np.array([2]), map_size=(4, 4)
    )
    assert Scales.of(visits).work == 1.0
    seen = look(Mission(visits), 0, 1, 1)["observation"]
    assert equal(seen["tasks"], [[3 / 4, 4 / 4, 1, 0, 1, 0, 0, 0]])
    assert observation_space(1, 1).contains(look(Mission(visits), 0, 1, 1))
