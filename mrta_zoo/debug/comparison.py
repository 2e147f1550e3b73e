"""Where two methods part on a mission, and what that costs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from mrta_zoo.debug.advisors import Advisor, make_advisor
from mrta_zoo.debug.outlook import Prospect, outlook
from mrta_zoo.debug.recorder import play
from mrta_zoo.plan import Plan
from mrta_zoo.policies.protocol import Policy, Solver
from mrta_zoo.rules import loosest
from mrta_zoo.scenario import Scenario
from mrta_zoo.trace import Choice, Decision, Trace
from mrta_zoo.verify import Visit, verify


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of an episode, by the verifier; fields as in `verify.Score`."""

    completed: int
    cost: float
    distance: float
    makespan: float


@dataclass(frozen=True, slots=True)
class Alternative:
    """One of the two choices where the methods part.

    Attributes:
        task: the task; None if the robot stays.
        distance: to it, in distance units; None if the robot stays, as for the next two.
        finish: when it is done.
        slack: deadline - finish; < 0 if it is late.
        probabilities: the first and the second method's of this task, None of one that has none.
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
        robot: whose it is.
        choices: of the first and the second method.
        otherwise: what comes if the first method takes the second's choice here and goes on by itself, and the same
            the other way round; None where the method's mask rule forbids that choice.
    """

    index: int
    time: float
    robot: int
    choices: tuple[Alternative, Alternative]
    otherwise: tuple[Outcome | None, Outcome | None]


@dataclass(frozen=True, slots=True)
class Disagreement:
    """A decision in the first method's episode at which the second, in its place, would choose otherwise."""

    index: int
    time: float
    robot: int
    chosen: int | None
    advised: int | None


@dataclass(frozen=True, slots=True)
class Turn:
    """The same turn of a robot in both episodes, where it takes different tasks.

    Attributes:
        robot: the robot.
        turn: which of its turns, from 0.
        tasks: what it takes in the first and in the second episode; None if it takes nothing more.
        finish: when it is done with it; None likewise.
    """

    robot: int
    turn: int
    tasks: tuple[int | None, int | None]
    finish: tuple[float | None, float | None]


@dataclass(frozen=True, slots=True)
class Fate:
    """A task that is completed in one episode only.

    Attributes:
        task: the task.
        deadline: of the task.
        robots: who takes it in the first and in the second episode, None if nobody does.
        finish: when it is done, None likewise.
        completed: whether in time; true for one of the two.
    """

    task: int
    deadline: float
    robots: tuple[int | None, int | None]
    finish: tuple[float | None, float | None]
    completed: tuple[bool, bool]


@dataclass(frozen=True, slots=True)
class Comparison:
    """Two methods on the same mission.

    Attributes:
        scenario: its name.
        tasks: number of its tasks.
        methods: names of the first and the second.
        outcomes: of their episodes.
        parting: where they part; None if they do the same throughout, when the three that follow are empty.
        disagreements: where the second would choose otherwise in the first one's place; what it would do after a plan
            has been left is said in `advisors.PlanAdvisor`.
        turns: turns in which a robot takes different tasks.
        fates: tasks that only one of them completes.
        traces: their episodes.
    """

    scenario: str
    tasks: int
    methods: tuple[str, str]
    outcomes: tuple[Outcome, Outcome]
    parting: Parting | None
    disagreements: tuple[Disagreement, ...]
    turns: tuple[Turn, ...]
    fates: tuple[Fate, ...]
    traces: tuple[Trace, Trace]


def compare(
    scenario: Scenario,
    first: str | Policy | Solver | Plan | Advisor,
    second: str | Policy | Solver | Plan | Advisor,
    **options: Any,
) -> Comparison:
    """Let two methods go through a mission, and find out where they part.

    Args:
        scenario: the mission.
        first: a name or path that `registry.make_solver` knows, a policy, a solver, a plan, or an advisor.
        second: likewise.
        **options: see `advisors.make_advisor`; for both.

    Raises:
        MrtaError: if there is no such method, it fails, or an option is out of range.
    """
    one, other = (
        method if isinstance(method, Advisor) else make_advisor(scenario, method, **options)
        for method in (first, second)
    )
    traces = play(scenario, one), play(scenario, other)
    outcomes = outcome(traces[0]), outcome(traces[1])
    return Comparison(
        scenario=scenario.name,
        tasks=scenario.num_tasks,
        methods=(one.method, other.method),
        outcomes=outcomes,
        parting=_parting(traces, (one, other)),
        disagreements=tuple(_disagreements(traces[0], other)),
        turns=tuple(_turns(scenario, traces)),
        fates=tuple(_fates(scenario, traces)),
        traces=traces,
    )


def outcome(trace: Trace) -> Outcome:
    """What has come of an episode."""
    score = verify(trace.scenario, trace.plan())
    return Outcome(score.completed, score.cost, score.distance, score.makespan)


def _parting(traces: tuple[Trace, Trace], advisors: tuple[Advisor, Advisor]) -> Parting | None:
    scenario = traces[0].scenario
    # Under one rule the same robot is to choose as long as all choices are the same. One that its own rule retires
    # stays here.
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
    # What a method makes of a task is known best where it took it.
    own_choices = [None if decision is None else decision.choice for decision in own]
    others = [
        choice if trace is None or decision is None else trace.choices[decision.index]
        for choice, trace, decision in zip(own_choices, otherwise, own, strict=True)
    ]
    first, second = (
        _alternative(None if task is None else prospects[task], thoughts)
        for task, thoughts in zip(tasks, ((own_choices[0], others[1]), (others[0], own_choices[1])), strict=True)
    )
    one, other = (None if trace is None else outcome(trace) for trace in otherwise)
    return Parting(index, found[0].time, robot, (first, second), (one, other))


def _own_decision(trace: Trace, robot: int, turn: int) -> Decision | None:
    """A robot's decision of that number; None if its rule leaves it none."""
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
    """The episode in which, at this decision of the trace, this task is taken, and then what its advisor says."""
    if decision is None:
        return None
    before = trace.choices[: decision.index]
    if task is not None and not trace.mission(decision.index).mask(decision.robot)[task]:
        return None
    return play(trace.scenario, advisor, (*before, Choice(task)))


def _disagreements(trace: Trace, advisor: Advisor) -> list[Disagreement]:
    found, state = [], advisor.begin()
    for mission, decision in trace.replay():
        advice, state = advisor.advise(mission, state)
        if advice.task != decision.choice.task:
            found.append(Disagreement(decision.index, decision.time, decision.robot, decision.choice.task, advice.task))
    return found


def _turns(scenario: Scenario, traces: tuple[Trace, Trace]) -> list[Turn]:
    one, other = (verify(scenario, trace.plan()).schedule for trace in traces)
    found = []
    for robot, (mine, theirs) in enumerate(zip(one, other, strict=True)):
        for turn in range(max(len(mine), len(theirs))):
            visits = [visits[turn] if turn < len(visits) else None for visits in (mine, theirs)]
            tasks = tuple(None if visit is None else visit.task for visit in visits)
            if tasks[0] != tasks[1]:
                a, b = (None if visit is None else visit.finish for visit in visits)
                found.append(Turn(robot, turn, (tasks[0], tasks[1]), (a, b)))
    return found


def _fates(scenario: Scenario, traces: tuple[Trace, Trace]) -> list[Fate]:
    fates: list[dict[int, tuple[int, Visit]]] = [
        {
            visit.task: (robot, visit)
            for robot, visits in enumerate(verify(scenario, trace.plan()).schedule)
            for visit in visits
        }
        for trace in traces
    ]
    found = []
    for task, deadline in enumerate(scenario.deadline.tolist()):
        one, other = (fate.get(task) for fate in fates)
        completed = one is not None and one[1].completed, other is not None and other[1].completed
        if completed[0] != completed[1]:
            robots = one and one[0], other and other[0]
            finish = one and one[1].finish, other and other[1].finish
            found.append(Fate(task, deadline, robots, finish, completed))
    return found
