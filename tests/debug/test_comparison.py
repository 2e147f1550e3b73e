"""Where two methods part, and what it costs."""

from __future__ import annotations

import pytest
from factories import small_scenario
from strategies import seeded_scenarios

from mrta_zoo.debug import Stepper, compare, record
from mrta_zoo.debug.comparison import Disagreement, Fate, Turn
from mrta_zoo.debug.parting import Alternative
from mrta_zoo.plan import Plan
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import Score, verify

# One robot at 0 with tasks at 3, 5 and 12 on a line: the nearest first is 3, 5, 12; the earliest deadline first is 12,
# where it is at 12 <= 13, then 5 at 12 + 7 = 19 <= 20, then 3 at 21 > 20.
LINE = Scenario(
    [[3, 0], [5, 0], [12, 0]], [20.0, 20.0, 13.0], [0.0] * 3, [[0, 0]], [1.0], map_size=(12, 12), name="line"
)  # type: ignore[arg-type]


def figures(score: Score | None) -> tuple[float, ...] | None:
    return score and (score.completed, score.cost, score.distance, score.makespan)


def test_by_hand() -> None:
    found = compare(LINE, "nearest", Plan(((2, 1),), "line", "plan"))
    assert (found.scenario, found.tasks, found.methods) == ("line", 3, ("nearest", "plan"))
    # Nearest: 3 at 3, 5 at 5, 12 at 12: all three. The plan leaves task 0, at the end of the mission at 19 or its
    # deadline, 20: cost 20 / 20.
    assert list(map(figures, found.scores)) == [(3, 0.0, 12.0, 12.0), (2, 1.0, 19.0, 19.0)]
    parting = found.parting
    assert parting is not None
    assert (parting.index, parting.time, parting.robot) == (0, 0.0, 0)
    assert parting.choices == (
        Alternative(0, 3.0, 3.0, 17.0, (None, None)),
        Alternative(2, 12.0, 12.0, 1.0, (None, None)),
    )
    # Nearest after 12: 5 at 19; then 3 at 21 is too late. The plan after 3: 12 at 12, then 5 at 19.
    assert list(map(figures, parting.otherwise)) == [(2, 1.0, 19.0, 19.0), (3, 0.0, 19.0, 19.0)]
    # In the place of nearest the plan goes for 12, for 12 again, and for 12, where both go.
    assert found.disagreements == (Disagreement(0, 0.0, 0, 0, 2), Disagreement(1, 3.0, 0, 1, 2))
    assert found.turns == (
        Turn(0, 0, (0, 2), (3.0, 12.0)),
        Turn(0, 2, (2, None), (12.0, None)),
    )
    assert found.fates == (Fate(0, 20.0, (0, None), (3.0, None), (True, False)),)


def test_methods_that_do_the_same_do_not_part() -> None:
    scenario = small_scenario(3)
    found = compare(scenario, "nearest", make_solver("nearest").solve(scenario))
    assert (found.parting, found.disagreements, found.turns, found.fates) == (None, (), (), ())
    assert found.scores[0] == found.scores[1]


def test_what_is_said_of_the_parting_is_what_a_stepper_finds() -> None:
    parted = 0
    for seed, scenario in enumerate(seeded_scenarios(21, 25)):
        found = compare(scenario, "random", "edf", seed=seed)
        one, other = record(scenario, "random", seed=seed), record(scenario, "edf", seed=seed)
        assert found.traces == (one, other)
        parting = found.parting
        if parting is None:
            assert one.plan().routes == other.plan().routes
            continue
        parted += 1
        assert one.choices[: parting.index] == other.choices[: parting.index]
        for index, name in enumerate(("random", "edf")):
            stepper = Stepper(scenario, name, seed=seed)
            stepper.go_to(parting.index)
            assert (stepper.robot, stepper.mission.time) == (parting.robot, parting.time)
            task = parting.choices[1 - index].task
            assert task is not None
            stepper.take(task)
            stepper.finish()
            assert parting.otherwise[index] == stepper.trace().score
        asked = Stepper(scenario, "edf")
        differing = []
        for choice in one.choices:
            advice = asked.advice
            assert advice is not None
            if advice.task != choice.task:
                differing.append(asked.position)
            assert choice.task is not None
            asked.take(choice.task)
        assert [each.index for each in found.disagreements] == differing
    assert parted > 10


def test_tasks_that_only_one_completes_are_those_of_the_verifier() -> None:
    for seed, scenario in enumerate(seeded_scenarios(22, 20)):
        found = compare(scenario, "random", "nearest", seed=seed, mask_rule="unvisited")
        done = [
            {visit.task for visits in verify(scenario, trace.plan()).schedule for visit in visits if visit.completed}
            for trace in found.traces
        ]
        for index in (0, 1):
            assert {fate.task for fate in found.fates if fate.completed[index]} == done[index] - done[1 - index]
        for fate in found.fates:
            for robot, trace in zip(fate.robots, found.traces, strict=True):
                where = [number for number, route in enumerate(trace.plan().routes) if fate.task in route]
                assert where == ([] if robot is None else [robot])


def test_methods_under_different_rules() -> None:
    # The plan goes on to 3, late at 21, where the rule of nearest would have retired the robot: so after 12 and 5,
    # robot 0 stays in the one and takes task 0 in the other.
    found = compare(LINE, Plan(((2, 1),)), Plan(((2, 1, 0),)))
    parting = found.parting
    assert parting is not None
    assert [trace.mask_rule for trace in found.traces] == ["feasible", "active"]
    assert (parting.index, parting.time, [each.task for each in parting.choices]) == (2, 19.0, [None, 0])
    # The first may not have it; the second stays: task 0 counts as finished at 20, its deadline.
    assert list(map(figures, parting.otherwise)) == [None, (2, 1.0, 19.0, 19.0)]


def test_probabilities_of_both_are_shown() -> None:
    pytest.importorskip("torch")
    scenario = small_scenario(2, tasks=20, robots=3)
    found = compare(scenario, "capam", "capam-plus")
    assert found.parting is not None
    for choice in found.parting.choices:
        assert all(share is not None and 0 <= share <= 1 for share in choice.probabilities)
    (mine, _), (_, theirs) = (choice.probabilities for choice in found.parting.choices)
    assert mine == max((found.traces[0].choices[found.parting.index].probabilities or {}).values())
    assert theirs == max((found.traces[1].choices[found.parting.index].probabilities or {}).values())
