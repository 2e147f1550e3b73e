"""Comparison of two methods on the same mission: where they part, what each does then, and what that costs."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import zip_longest
from typing import Any

from mrta_zoo.debug.advisors import Advisor, make_advisor
from mrta_zoo.debug.parting import Parting, parting_of
from mrta_zoo.debug.recorder import play
from mrta_zoo.plan import Plan
from mrta_zoo.policies.protocol import Policy, Solver
from mrta_zoo.scenario import Scenario
from mrta_zoo.trace import Trace
from mrta_zoo.verify import Score, Visit


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
        finish: when it finishes each; None likewise.
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
        deadline: its deadline.
        robots: who takes it in the first and in the second episode; None if nobody does.
        finish: when it is finished; None likewise.
        completed: whether that is in time; true for one of the two.
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
        scores: of their episodes.
        parting: where they part; None if they do the same throughout, and then the next three are empty.
        disagreements: where the second, in the first one's place, would choose otherwise; `advisors.PlanAdvisor` says
            what a plan advises once it has been left.
        turns: turns in which a robot takes different tasks.
        fates: tasks that only one of them completes.
        traces: their episodes.
    """

    scenario: str
    tasks: int
    methods: tuple[str, str]
    scores: tuple[Score, Score]
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
    """Run two methods on a mission and find where they part.

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
    return Comparison(
        scenario=scenario.name,
        tasks=scenario.num_tasks,
        methods=(one.method, other.method),
        scores=(traces[0].score, traces[1].score),
        parting=parting_of(traces, (one, other)),
        disagreements=tuple(_disagreements(traces[0], other)),
        turns=tuple(_turns(traces)),
        fates=tuple(_fates(traces)),
        traces=traces,
    )


def _disagreements(trace: Trace, advisor: Advisor) -> list[Disagreement]:
    found, state = [], advisor.begin()
    for mission, decision in trace.steps():
        advice, state = advisor.advise(mission, state)
        if advice.task != decision.choice.task:
            found.append(Disagreement(decision.index, decision.time, decision.robot, decision.choice.task, advice.task))
    return found


def _turns(traces: tuple[Trace, Trace]) -> list[Turn]:
    found = []
    for robot, pair in enumerate(zip(*(trace.score.schedule for trace in traces), strict=True)):
        for turn, visits in enumerate(zip_longest(*pair)):
            one, other = (None if visit is None else visit.task for visit in visits)
            if one != other:
                a, b = (None if visit is None else visit.finish for visit in visits)
                found.append(Turn(robot, turn, (one, other), (a, b)))
    return found


def _fates(traces: tuple[Trace, Trace]) -> list[Fate]:
    visits: list[dict[int, tuple[int, Visit]]] = [
        {visit.task: (robot, visit) for robot, route in enumerate(trace.score.schedule) for visit in route}
        for trace in traces
    ]
    found = []
    for task, deadline in enumerate(traces[0].scenario.deadline.tolist()):
        one, other = (each.get(task) for each in visits)
        completed = one is not None and one[1].completed, other is not None and other[1].completed
        if completed[0] != completed[1]:
            robots = one and one[0], other and other[0]
            finish = one and one[1].finish, other and other[1].finish
            found.append(Fate(task, deadline, robots, finish, completed))
    return found
