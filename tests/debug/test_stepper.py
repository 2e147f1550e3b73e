"""Stepping forth and back: whatever the way, the state is that of a fresh mission with the same choices."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from factories import hopeless_scenario, small_scenario
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from strategies import scenarios, seeded_scenarios

from mrta_zoo.debug import Stepper, make_advisor, record
from mrta_zoo.env.observation import Observation
from mrta_zoo.errors import ActionError, ConfigError, PlanError
from mrta_zoo.io import read_trace
from mrta_zoo.mission import Mission
from mrta_zoo.plan import Plan
from mrta_zoo.rules import MaskReason
from mrta_zoo.scenario import Scenario
from mrta_zoo.trace import Choice, Trace

SCENARIO = small_scenario(2, tasks=12, robots=3)
MOVES = ("follow", "take", "stay", "back", "forward", "goto", "jump", "finish", "advice")


def state(mission: Mission) -> dict[str, Any]:
    """All of a mission, to be compared."""
    return {
        name: value.tobytes() if isinstance(value, np.ndarray) else copy.deepcopy(value)
        for name, value in vars(mission).items()
        if name != "scenario"
    }


def move(stepper: Stepper, name: str, number: int) -> None:
    """One of `MOVES`; nothing happens where it cannot be made."""
    try:
        match name:
            case "take":
                legal = np.flatnonzero(stepper.mission.mask(stepper.robot)) if not stepper.done else [0]
                stepper.take(int(legal[number % len(legal)]))
            case "back" | "forward":
                getattr(stepper, name)(number % 4 + 1)
            case "goto":
                stepper.go_to(number % (len(stepper) + 1))
            case "jump":
                stepper.jump(number % stepper.scenario.num_robots)
            case "advice":
                assert (stepper.advice is None) == stepper.done
            case _:
                getattr(stepper, name)()
    except ActionError:
        pass


@pytest.mark.parametrize("method", ["random", "nearest"])
@settings(max_examples=50, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(scenario=scenarios(), moves=st.lists(st.tuples(st.sampled_from(MOVES), st.integers(0, 30)), max_size=25))
def test_any_way_leads_to_the_state_of_a_fresh_replay(
    method: str, scenario: Scenario, moves: list[tuple[str, int]]
) -> None:
    stepper = Stepper(scenario, method, seed=3)
    heard: dict[tuple[int | None, ...], Choice | None] = {}
    for name, number in moves:
        before, here = state(stepper.mission), stepper.position
        move(stepper, name, number)
        trace = stepper.trace()
        assert trace.bookmark == stepper.position
        assert state(stepper.mission) == state(trace.mission(stepper.position))
        if stepper.position == here and name not in ("follow", "take", "stay"):
            assert state(stepper.mission) == before
        # The advice depends on the choices before, and on nothing that was seen or done in between.
        line = tuple(choice.task for choice in trace.choices[: stepper.position])
        assert heard.setdefault(line, stepper.advice) == stepper.advice
    stepper.finish()
    assert stepper.done


def test_following_is_what_the_method_does() -> None:
    for method in ("random", "edf", "big-mrta"):
        stepper = Stepper(SCENARIO, method, seed=4)
        stepper.finish()
        stepper.go_to(5)
        stepper.back(3)
        stepper.finish()
        assert stepper.trace().plan() == record(SCENARIO, method, seed=4).plan()


def test_a_learned_policy_that_samples_gives_the_same_advice_again() -> None:
    pytest.importorskip("torch")
    from mrta_zoo.policies.neural.policy import load_policy

    stepper = Stepper(SCENARIO, load_policy("capam", decode="sample", seed=1))
    stepper.finish()
    first = stepper.trace()
    stepper.go_to(3)
    other = int(np.flatnonzero(stepper.mission.mask(stepper.robot))[-1])
    stepper.take(other)  # from here on another line
    stepper.finish()
    stepper.go_to(3)
    made = first.choices[3].task
    assert made is not None
    assert made != other
    stepper.take(made)  # and back on the first
    stepper.finish()
    assert [choice.task for choice in stepper.trace().choices] == [choice.task for choice in first.choices]


class Flip:
    """Takes the first and the last task in turns: a policy that remembers being asked."""

    def __init__(self) -> None:
        self.asked = 0

    def act(self, observation: Observation, agent: str) -> int:
        self.asked += 1
        return int(np.flatnonzero(observation["action_mask"])[-(self.asked % 2)])


def test_a_policy_with_a_memory_is_asked_as_if_for_the_first_time() -> None:
    for scenario in seeded_scenarios(8, 20):
        policy = Flip()
        stepper = Stepper(scenario, policy)
        if stepper.done:
            continue
        stepper.finish()
        assert stepper.trace().choices == record(scenario, Flip()).choices
        stepper.back(len(stepper))
        stepper.stay()
        assert policy.asked == 0
        # Resumed, it is first asked for the decisions that the trace already has.
        resumed = Stepper.resume(stepper.trace(), make_advisor(scenario, Flip()))
        stepper.finish()
        resumed.finish()
        assert resumed.trace() == stepper.trace()


def test_another_choice_drops_what_came_after_and_the_same_keeps_it() -> None:
    stepper = Stepper(SCENARIO, "nearest")
    stepper.finish()
    length = len(stepper)
    stepper.go_to(2)
    assert stepper.made == stepper.follow()
    assert len(stepper) == length
    stepper.back()
    advised = stepper.advice
    assert advised is not None
    other = next(p.task for p in stepper.outlook() if p.task != advised.task and p.reason == MaskReason.CHOOSABLE)
    assert stepper.take(other) == Choice(other, advice=advised.task)
    assert (stepper.position, len(stepper), stepper.made) == (3, 3, None)


def test_an_illegal_choice_changes_nothing() -> None:
    stepper = Stepper(SCENARIO, "nearest")
    stepper.forward(4)
    stepper.back()
    taken = next(p.task for p in stepper.outlook() if p.reason == MaskReason.TAKEN)
    before = state(stepper.mission), stepper.trace()
    with pytest.raises(ActionError, match=f"may not choose task {taken} at time .*: taken"):
        stepper.take(taken)
    with pytest.raises(ActionError, match="there is no robot 3"):
        stepper.jump(3)
    with pytest.raises(ActionError, match="there is no decision -1"):
        stepper.go_to(-1)
    with pytest.raises(ConfigError, match="there is no robot 9"):
        stepper.outlook(9)
    assert (state(stepper.mission), stepper.trace()) == before


def test_jumping_to_a_robots_next_turn() -> None:
    stepper = Stepper(SCENARIO, "nearest")
    turns = [decision.index for decision in record(SCENARIO, "nearest").decisions() if decision.robot == 1]
    stepper.jump(1)
    for turn in turns:
        assert (stepper.robot, stepper.position) == (1, turn)
        if turn != turns[-1]:
            stepper.jump(1)
    with pytest.raises(ActionError, match="robot 1 does not choose again after this"):
        stepper.jump(1)
    assert stepper.position == turns[-1]


def test_without_a_policy_one_chooses_oneself() -> None:
    stepper = Stepper(SCENARIO)
    assert stepper.advice is None
    for step in (stepper.follow, stepper.forward, stepper.finish):
        with pytest.raises(ActionError, match="there is no policy to follow here; name a task"):
            step()
    stepper.take(int(np.flatnonzero(stepper.mission.mask(0))[0]))
    with pytest.raises(ActionError, match="no policy"):
        stepper.jump(0)
    assert stepper.position == 1


def test_a_mission_in_which_nothing_can_be_done() -> None:
    stepper = Stepper(hopeless_scenario(), "nearest")
    assert stepper.done
    assert stepper.advice is None
    assert str(stepper.outlook(0)[0]) == "too late by 54.00"  # 50 + 5 - 1
    for act in (stepper.follow, stepper.stay, stepper.forward, lambda: stepper.take(0)):
        with pytest.raises(ActionError, match="the mission is over, after 0 decisions"):
            act()
    with pytest.raises(ActionError, match="no robot is to choose"):
        stepper.outlook()
    stepper.finish()
    stepper.back()
    assert stepper.position == 0


def test_what_is_saved_is_loaded(tmp_path: Path) -> None:
    path = tmp_path / "session.json"
    stepper = Stepper(SCENARIO, "random", seed=2)
    stepper.finish()
    stepper.go_to(4)
    stepper.save(path)
    loaded = Stepper.load(path, make_advisor(SCENARIO, "random", seed=2))
    assert (loaded.position, len(loaded), loaded.trace()) == (4, len(stepper), stepper.trace())
    assert loaded.advice == stepper.advice
    loaded.take(int(np.flatnonzero(loaded.mission.mask(loaded.robot))[0]))
    stepper.take(int(np.flatnonzero(stepper.mission.mask(stepper.robot))[0]))
    loaded.finish()
    stepper.finish()
    assert loaded.trace() == stepper.trace()
    assert read_trace(path).seed == 2
    with pytest.raises(PlanError, match="no such file"):
        Stepper.load(tmp_path / "none.json")


def test_a_plan_is_stepped_as_it_is_and_keeps_its_bound() -> None:
    routes = record(SCENARIO, "nearest").plan().routes
    plan = Plan((routes[0][:1], (), routes[2]), "small", "hand", 9)
    stepper = Stepper(SCENARIO, plan)
    stepper.finish()
    assert stepper.trace() == Trace(
        SCENARIO, Trace.of_plan(SCENARIO, plan).choices, "feasible", "hand", bound=9, bookmark=len(stepper)
    )


def test_the_outlook_by_hand() -> None:
    # Robot 0 at (0, 0) with speed 2 and capacity 4, robot 1 at (6, 8) with speed and capacity 1. Tasks at (6, 8) with
    # workload 4 and at (0, 8) with workload 2.
    scenario = Scenario([[6, 8], [0, 8]], [20.0, 7.0], [4.0, 2.0], [[0, 0], [6, 8]], [4.0, 1.0], [2.0, 1.0], (10, 10))  # type: ignore[arg-type]
    stepper = Stepper(scenario, "nearest")
    second, first = stepper.outlook()[::-1]
    # Task 1: 8 away, 4 to travel, 0.5 to work, 2.5 before its deadline; robot 1 would need 6 + 2 > 7.
    assert (first.task, first.distance, first.travel, first.finish, first.slack) == (1, 8, 4, 4.5, 2.5)
    assert (first.rival, str(first)) == (None, "nobody else in time")
    # Task 0: 10 away, 5 to travel, 1 to work; robot 1 is there and needs 4.
    assert (second.task, second.distance, second.travel, second.finish, second.slack) == (0, 10, 5, 6, 14)
    assert (second.rival, second.rival_finish, str(second)) == (1, 4, "robot 1 could by 4.00")
    stepper.take(1)
    stepper.take(0)
    # At 4 robot 1 is done with task 0, has nothing left and retires; robot 0 too, at 4.5.
    assert stepper.done
    assert [str(each) for each in stepper.outlook(0, "task")] == ["done by robot 1 at 4.00", "done by robot 0 at 4.50"]
    stepper.back()
    # Robot 0 would go 6 back from (0, 8), in 3, and work for 1.
    assert [str(each) for each in stepper.outlook(by="task")] == ["robot 0 could by 8.50", "robot 0 on it until 4.50"]
    # Task 1 is due first, but taken: what may be chosen comes first.
    assert [each.task for each in stepper.outlook(by="deadline")] == [0, 1]
    with pytest.raises(ConfigError, match="there is no order 'name'; expected one of rank, distance"):
        stepper.outlook(by="name")  # type: ignore[arg-type]


@pytest.mark.parametrize("task", [None, 1.5, -1, 12])
def test_a_policy_that_chooses_no_task_is_named(task: Any) -> None:
    class Odd:
        def act(self, observation: Observation, agent: str) -> int:
            return task  # type: ignore[no-any-return]

    with pytest.raises(ActionError, match=f"robot_0 sent action {task!r}; expected a whole number from 0 to 11"):
        record(SCENARIO, Odd())
