"""The parting of two methods: the first decision at which they differ, and what the other's choice would lead to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mrta_zoo.debug.advisors import Advisor
from mrta_zoo.debug.outlook import Prospect, outlook
from mrta_zoo.debug.recorder import play
from mrta_zoo.rules import loosest
from mrta_zoo.trace import Choice, Decision, Trace
from mrta_zoo.verify import Score


@dataclass(frozen=True, slots=True)
class Alternative:
    """One of the two choices where the methods part.

    Attributes:
        task: the task; None if the robot stays.
        distance: to it, in distance units; None if the robot stays, as for the next two.
        finish: when it is done.
        slack: deadline - finish; < 0 if it is late.
        probabilities: of this task, by the first and by the second method; None for one that has none.
    """

    task: int | None
    distance: float | None
    finish: float | None
    slack: float | None
    probabilities: tuple[float | None, float | None]


@dataclass(frozen=True, slots=True)
class Parting:
    """The first decision at which two methods choose differently; until then all is the same.

    Attributes:
        index: number of the decision, from 0.
        time: when it is made.
        robot: who makes it.
        choices: of the first and the second method.
        otherwise: the score if the first method takes the second's choice here and goes on by itself, and the same
            the other way round; None where the method's mask rule forbids that choice.
    """

    index: int
    time: float
    robot: int
    choices: tuple[Alternative, Alternative]
    otherwise: tuple[Score | None, Score | None]


def parting_of(traces: tuple[Trace, Trace], advisors: tuple[Advisor, Advisor]) -> Parting | None:
    """Where the episodes of two methods part; None if they are the same.

    Args:
        traces: the first and the second method's episode of the same scenario.
        advisors: the methods.
    """
    scenario = traces[0].scenario
    # Under one common rule the same robot chooses as long as all choices are the same. A robot that its method's own
    # rule retires stays instead.
    rule = loosest(trace.mask_rule for trace in traces)
    common = [Trace.of_plan(scenario, trace.plan(), rule) for trace in traces]
    pairs = zip(common[0].decisions(), common[1].decisions(), strict=False)
    found = next((pair for pair in pairs if pair[0].choice.task != pair[1].choice.task), None)
    if found is None:
        return None
    index, robot = found[0].index, found[0].robot
    mission = common[0].mission(index)
    prospects = outlook(mission, robot)
    turn = len(mission.routes[robot])
    own = [_own_decision(trace, robot, turn) for trace in traces]
    tasks = found[0].choice.task, found[1].choice.task
    otherwise = [
        _otherwise(trace, advisor, decision, task)
        for trace, advisor, decision, task in zip(traces, advisors, own, tasks[::-1], strict=True)
    ]
    # A method's probabilities for a task are best read from the episode in which it took that task.
    own_choices = [None if decision is None else decision.choice for decision in own]
    others = [
        choice if trace is None or decision is None else trace.choices[decision.index]
        for choice, trace, decision in zip(own_choices, otherwise, own, strict=True)
    ]
    first, second = (
        _alternative(None if task is None else prospects[task], thoughts)
        for task, thoughts in zip(tasks, ((own_choices[0], others[1]), (others[0], own_choices[1])), strict=True)
    )
    one, other = (None if trace is None else trace.score for trace in otherwise)
    return Parting(index, found[0].time, robot, (first, second), (one, other))


def _own_decision(trace: Trace, robot: int, turn: int) -> Decision | None:
    """A robot's decision in its turn `turn`, from 0; None if its mask rule leaves it none."""
    turns = [decision for decision in trace.decisions() if decision.robot == robot]
    return turns[turn] if turn < len(turns) else None


def _alternative(prospect: Prospect | None, thoughts: Sequence[Choice | None]) -> Alternative:
    if prospect is None:
        return Alternative(None, None, None, None, (None, None))
    likely = _probability(thoughts[0], prospect.task), _probability(thoughts[1], prospect.task)
    return Alternative(prospect.task, prospect.distance, prospect.finish, prospect.slack, likely)


def _probability(choice: Choice | None, task: int) -> float | None:
    return None if choice is None or choice.probabilities is None else choice.probabilities.get(task, 0.0)


def _otherwise(trace: Trace, advisor: Advisor, decision: Decision | None, task: int | None) -> Trace | None:
    """The episode that takes this task at this decision of the trace and then follows the advisor."""
    if decision is None:
        return None
    before = trace.choices[: decision.index]
    if task is not None and not trace.mission(decision.index).mask(decision.robot)[task]:
        return None
    return play(trace.scenario, advisor, (*before, Choice(task)))
