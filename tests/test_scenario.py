"""A scenario is checked when made, and never changes after."""

import copy
import dataclasses
import pickle
import re
from typing import Any

import numpy as np
import pytest

from mrta_zoo import Scenario
from mrta_zoo.errors import MrtaError, ScenarioError

GOOD: dict[str, Any] = {
    "task_xy": [[1, 2], [3, 4], [5, 6]],
    "deadline": [10, 20, 30],
    "workload": [0, 5, 6],
    "robot_xy": [[0, 0], [100, 50]],
    "capacity": [1, 2],
    "map_size": (100, 50),
    "name": "good",
}


def make(**changes: Any) -> Scenario:
    return Scenario(**{**GOOD, **changes})


def test_good() -> None:
    scenario = make()
    assert (scenario.num_tasks, scenario.num_robots) == (3, 2)
    assert scenario.speed.tolist() == [1, 1]
    assert scenario.map_size == (100.0, 50.0)
    assert {array.dtype for array in (scenario.task_xy, scenario.deadline, scenario.capacity)} == {np.dtype("f8")}
    assert repr(scenario) == "Scenario('good', 3 tasks, 2 robots)"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"task_xy": [], "deadline": [], "workload": []}, "at least one task; got 0"),
        ({"robot_xy": [], "capacity": []}, "at least one robot; got 0"),
        ({"task_xy": [[1, 2], [3, 4]]}, "task_xy has shape (2, 2); with 3 deadlines and 2 capacities it"),
        ({"task_xy": [1, 2, 3]}, "task_xy has shape (3,)"),
        ({"task_xy": [[1, 2, 3]] * 3}, "task_xy has shape (3, 3)"),
        ({"workload": [1, 2]}, "workload has shape (2,)"),
        ({"deadline": [[10], [20], [30]]}, "deadline has shape (3, 1)"),
        ({"robot_xy": [[0, 0]]}, "robot_xy has shape (1, 2)"),
        ({"speed": [1, 1, 1]}, "speed has shape (3,)"),
        ({"capacity": ["a", "b"]}, "capacity must hold numbers"),
        ({"task_xy": [[1, 2], [3]]}, "task_xy must hold numbers"),
        ({"deadline": [10**400, 1]}, "deadline must hold numbers"),
        ({"map_size": (10**400, 1)}, "expected two finite numbers > 0"),
        ({"deadline": [None, 1, 2]}, "task 0 has deadline nan; expected a finite number > 0"),
        ({"deadline": [10, 0, 30]}, "task 1 has deadline 0; expected a finite number > 0"),
        ({"deadline": [10, np.nan, 30]}, "task 1 has deadline nan; expected"),
        ({"deadline": [10, 20, np.inf]}, "task 2 has deadline inf; expected"),
        ({"workload": [-1, 5, 6]}, "task 0 has workload -1; expected a finite number >= 0"),
        ({"capacity": [1, 0]}, "robot 1 has capacity 0; expected a finite number > 0"),
        ({"speed": [-1, 1]}, "robot 0 has speed -1; expected a finite number > 0"),
        ({"task_xy": [[1, 2], [3, 51], [5, 6]]}, "task 1 has y 51; expected a number from 0 to 50, inside"),
        ({"robot_xy": [[0, 0], [100.5, 50]]}, "robot 1 has x 100.5; expected a number from 0 to 100"),
        ({"robot_xy": [[0, np.nan], [100, 50]]}, "robot 0 has y nan; expected a number from 0 to 50"),
        ({"map_size": (0, 50)}, "map_size is (0, 50); expected two finite numbers > 0"),
        ({"map_size": (100, np.inf)}, "map_size is (100, inf); expected"),
        ({"map_size": (100, 50, 3)}, "map_size is (100, 50, 3); expected"),
    ],
)  # fmt: skip
def test_bad(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        make(**changes)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert isinstance(caught.value, MrtaError)
    assert isinstance(caught.value, ValueError)


def test_arrays_are_copies_and_cannot_be_written() -> None:
    deadline = np.array([10.0, 20.0, 30.0])
    scenario = make(deadline=deadline)
    deadline[0] = 99
    assert scenario.deadline[0] == 10
    for field in ("task_xy", "deadline", "workload", "robot_xy", "capacity", "speed"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(scenario, field)[0] = 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        scenario.name = "other"  # type: ignore[misc]


def test_equality_and_hash() -> None:
    assert make() == make()
    assert hash(make()) == hash(make())
    assert make(workload=[-0.0, 5, 6]) == make(workload=[0.0, 5, 6])
    assert make() != "good"
    changes: list[dict[str, Any]] = [
        {"name": "x"}, {"map_size": (100, 60)}, {"speed": [1, 2]}, {"deadline": [10, 20, 31]},
        {"workload": [0, 5, 7]}, {"capacity": [1, 3]}, {"task_xy": [[1, 2], [3, 4], [5, 7]]},
        {"robot_xy": [[0, 1], [100, 50]]},
    ]  # fmt: skip
    scenarios = {make(), *(make(**change) for change in changes)}
    assert len(scenarios) == 1 + len(changes)


def test_pickle_copy_and_replace() -> None:
    scenario = make(speed=[0.5, 2])
    for other in (
        pickle.loads(pickle.dumps(scenario)),
        copy.deepcopy(scenario),
        dataclasses.replace(scenario),
    ):
        assert other == scenario
    assert dataclasses.replace(scenario, name="other").name == "other"
    with pytest.raises(ScenarioError, match="robot 0 has capacity 0"):
        dataclasses.replace(scenario, capacity=[0, 1])


@pytest.mark.parametrize("changes", [{"deadline": 5}, {"capacity": None}])
def test_a_number_for_an_array(changes: dict[str, Any]) -> None:
    with pytest.raises(ScenarioError, match="shape"):
        make(**changes)


def test_a_pickled_scenario_is_still_read_only() -> None:
    scenario = pickle.loads(pickle.dumps(make()))
    with pytest.raises(ValueError, match="read-only"):
        scenario.deadline[0] = 1


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"deadline": [1e13, 2, 3]}, "task 0 has deadline 1e+13; expected a number > 0, from 1e-12 to 1e+12"),
        ({"speed": [1, 1e-13]}, "robot 1 has speed 1e-13; expected a number > 0, from 1e-12 to 1e+12"),
        ({"workload": [0, 1e300, 1]}, "task 1 has workload 1e+300; expected a number from 0 to 1e+12"),
    ],
)
def test_numbers_that_would_overflow_or_vanish_are_refused(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ScenarioError, match=re.escape(sentence)):
        make(**changes)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"task_names": ("a",)}, "task_names has 1 name; expected a different text for each of the 3 tasks"),
        ({"task_names": ("a", "b", "a")}, "task 2 has the name 'a', as task 0"),
        ({"task_names": ("a", "b", " ")}, "task 2 has the name ' '; expected text"),
        ({"task_names": ("a", "b", "c\nd")}, "task 2 has the name .c.nd."),
        ({"task_names": ("a", "b", 1.5)}, "task 2 has the name 1.5; expected text"),
        ({"task_names": "abc"}, "task_names is 'abc'; expected"),
        ({"map_origin": (0, 1, 2)}, r"map_origin is \(0, 1, 2\); expected two numbers"),
        ({"map_origin": (0, 2e12)}, "map_origin is .*; expected two numbers from -1e"),
        ({"map_origin": (50, 50)}, "has x .*; expected a number from 50 to 1[05]0, inside the map"),
    ],
)
def test_bad_names_and_maps(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ScenarioError, match=sentence):
        make(**changes)


def test_a_map_that_is_not_named_holds_everything() -> None:
    def map_of(*places: tuple[float, float], **named: Any) -> tuple[Any, Any]:
        made = Scenario(places[1:], [9.0] * (len(places) - 1), [1.0] * (len(places) - 1), places[:1], [1.0], **named)  # type: ignore[arg-type]
        return made.map_size, made.map_origin

    assert map_of((0, 0), (100, 100)) == ((100, 100), (0, 0))
    assert map_of((-80, 0), (15, 7)) == ((100, 100), (-80, 0))  # on which there is room for 95
    assert map_of((-80, 0), (80, 0)) == ((160, 160), (-80, 0))
    assert map_of((0, 0), (150.5, 0)) == ((151, 151), (0, 0))
    assert map_of((512_000, 5_403_000), (512_300, 5_403_000)) == ((300, 300), (512_000, 5_403_000))
    with pytest.raises(ScenarioError, match="task 0 has x nan"):
        map_of((0, 0), (float("nan"), 0))
    with pytest.raises(ScenarioError, match="map_origin is None; expected two numbers"):
        map_of((0, 0), (1, 1), map_origin=None)
    with pytest.raises(ScenarioError, match="map_origin is 5; expected two numbers"):
        map_of((0, 0), (1, 1), map_origin=5)


def test_names_for_people() -> None:
    named = make(task_names=["valve-A", 17, "x" * 99], robot_names=["Ann", "Ben"])
    assert [named.task_name(1), named.robot_name(0)] == ["17", "Ann"]
    numbered = make(task_names=["0", "1", "2"])  # which are their numbers anyway
    assert numbered == make()
    assert [numbered.task_name(1), numbered.robot_name(0)] == ["1", "robot 0"]
    assert named != numbered
