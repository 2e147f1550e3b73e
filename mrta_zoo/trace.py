"""Traces: episodes, decision by decision, with what each robot chose and what its policy would have chosen."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from mrta_zoo.errors import ActionError, PlanError
from mrta_zoo.mission import Mission
from mrta_zoo.plan import Plan
from mrta_zoo.rules import MASK_RULES, MaskRule, check_mask_rule, may_choose
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import Score, verify
from mrta_zoo.wording import counted

TOLERANCE = 1e-3
"""By how much probabilities may add up to more than 1, as they are rounded."""


@dataclass(frozen=True, slots=True)
class Choice:
    """What was chosen at one decision. Who chose, and when, follows from the choices before it.

    Attributes:
        task: the task taken; None if the robot stays where it is for good, although it may choose. The environment
            has no such action, but a plan may end a robot's route at any time.
        probabilities: the policy's, by task, each from 0 to 1; negligible ones may be left out. None if the policy has
            none.
        advice: the task that the policy would have taken, where somebody else decided; None where it decided itself.

    Raises:
        PlanError: if a probability is out of range, or they add up to more than 1.
    """

    task: int | None
    probabilities: Mapping[int, float] | None = field(default=None, hash=False)
    advice: int | None = None

    def __post_init__(self) -> None:
        if self.probabilities is None:
            return
        for task, probability in self.probabilities.items():
            if not 0 <= probability <= 1:
                raise PlanError(f"the probability of task {task} is {probability:g}; expected a number from 0 to 1")
        if (total := sum(self.probabilities.values())) > 1 + TOLERANCE:
            raise PlanError(f"the probabilities add up to {total:g}; expected at most 1")


@dataclass(frozen=True, slots=True)
class Decision:
    """A choice, with what follows from the choices before it.

    Attributes:
        index: number of the decision, from 0.
        time: when it was made, in time units.
        robot: who made it.
        choice: what was chosen.
    """

    index: int
    time: float
    robot: int
    choice: Choice


@dataclass(frozen=True)  # without slots, so that it can cache what follows from its choices
class Trace:
    """The scenario of an episode and every choice made in it, from the start but perhaps not to the end.

    Arrivals, statuses, masks and their reasons are not stored: `steps` shows the mission before each decision.

    Attributes:
        scenario: the scenario.
        choices: in the order in which they were made.
        mask_rule: which untaken tasks robots could choose, see `rules.MaskRule`.
        method: name of the policy or solver that chose, or advised; empty if none did.
        decode: how a learned policy chose, such as "greedy"; empty if there is nothing to say.
        seed: of all random draws, None if none was given.
        bound: as in `Plan`.
        bookmark: the decision to look at first, from 0 to the number of choices; None if there is none.

    Raises:
        PlanError: if a robot could not choose what it did; the message names the decision.
        ConfigError: if there is no such mask rule.
    """

    scenario: Scenario
    choices: tuple[Choice, ...]
    mask_rule: MaskRule = "feasible"
    method: str = ""
    decode: str = ""
    seed: int | None = None
    bound: int | None = None
    bookmark: int | None = None

    def __post_init__(self) -> None:
        check_mask_rule(self.mask_rule)
        object.__setattr__(self, "choices", tuple(self.choices))
        tasks = range(self.scenario.num_tasks)
        for index, choice in enumerate(self.choices):
            for task in (choice.advice, *(choice.probabilities or ())):
                if task is not None and task not in tasks:
                    raise PlanError(f"decision {index} names task {task}; tasks are numbered 0 to {len(tasks) - 1}")
        decisions = tuple(decision for _, decision in self.steps())  # every choice must be legal
        object.__setattr__(self, "_decisions", decisions)
        if self.bookmark is not None and not 0 <= self.bookmark <= len(self.choices):
            raise PlanError(f"the bookmark is {self.bookmark}; expected a number from 0 to {len(self.choices)}")

    @classmethod
    def of_plan(cls, scenario: Scenario, plan: Plan, mask_rule: MaskRule | None = None) -> Trace:
        """The episode in which every robot follows its route, and stays where it ends.

        Args:
            scenario: what was planned.
            plan: the plan.
            mask_rule: by default the tightest that allows what the plan does.

        Raises:
            PlanError: if the plan does not fit the scenario, or the rule forbids a part of it.
        """
        mission = Mission(scenario, tightest_rule(scenario, plan) if mask_rule is None else mask_rule)
        choices: list[Choice] = []
        while not mission.done:
            robot = mission.actor
            done = len(mission.routes[robot])
            choice = Choice(plan.routes[robot][done] if done < len(plan.routes[robot]) else None)
            apply_choice(mission, choice, len(choices))
            choices.append(choice)
        left = [robot for robot, route in enumerate(plan.routes) if len(mission.routes[robot]) < len(route)]
        if left:
            robot = left[0]
            task = plan.routes[robot][len(mission.routes[robot])]
            raise PlanError(
                f"mask rule {mission.mask_rule!r} leaves robot {scenario.robot_label(robot)} nothing to choose where "
                f"the plan goes on with task {scenario.task_label(task)}; expected a rule that the plan keeps to"
            )
        return cls(scenario, tuple(choices), mission.mask_rule, plan.method, bound=plan.bound)

    def steps(self) -> Iterator[tuple[Mission, Decision]]:
        """The mission before each decision, and the decision. It is one mission that moves on: do not keep it."""
        mission = Mission(self.scenario, self.mask_rule)
        for index, choice in enumerate(self.choices):
            if mission.done:
                raise PlanError(
                    f"decision {index} comes after the end of the mission; expected {counted(index, 'decision')}"
                )
            yield mission, Decision(index, mission.time, mission.actor, choice)
            apply_choice(mission, choice, index)

    def decisions(self) -> tuple[Decision, ...]:
        """Every decision."""
        decisions: tuple[Decision, ...] = vars(self)["_decisions"]
        return decisions

    def mission(self, index: int | None = None) -> Mission:
        """A fresh mission as it stood before decision `index`; by default after the last one."""
        return mission_after(self.scenario, self.choices[:index], self.mask_rule)

    def plan(self) -> Plan:
        """The routes taken, as a plan."""
        routes: list[list[int]] = [[] for _ in range(self.scenario.num_robots)]
        for decision in self.decisions():
            if decision.choice.task is not None:
                routes[decision.robot].append(decision.choice.task)
        return Plan(tuple(map(tuple, routes)), self.scenario.name, self.method, self.bound)

    @cached_property
    def score(self) -> Score:
        """The verifier's score of `plan`."""
        return verify(self.scenario, self.plan())


def mission_after(scenario: Scenario, choices: Sequence[Choice], mask_rule: MaskRule) -> Mission:
    """A fresh mission in which these choices have been made.

    Raises:
        PlanError: if a robot could not choose what it should.
    """
    mission = Mission(scenario, mask_rule)
    for index, choice in enumerate(choices):
        apply_choice(mission, choice, index)
    return mission


def apply_choice(mission: Mission, choice: Choice, index: int) -> None:
    """Make the acting robot's choice and move on to the next decision.

    Raises:
        PlanError: if the robot may not choose that; the message names the decision by its index.
    """
    try:
        if choice.task is None:
            mission.stay()
        else:
            mission.assign(choice.task)
    except ActionError as error:
        raise PlanError(f"decision {index}: {error}") from None


def tightest_rule(scenario: Scenario, plan: Plan) -> MaskRule:
    """The tightest mask rule that allows every visit of the plan.

    Raises:
        PlanError: if the plan does not fit the scenario.
    """
    schedule = verify(scenario, plan).schedule
    visits = [
        (visit.finish, ready, visit.deadline)
        for route in schedule
        for visit, ready in zip(route, (0.0, *(visit.finish for visit in route)), strict=False)
    ]
    return next(rule for rule in MASK_RULES if all(may_choose(rule, *visit) for visit in visits))
