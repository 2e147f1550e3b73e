"""The stepper: an episode one decision at a time, forwards and backwards, with the advice of a policy."""

from __future__ import annotations

from typing import Any

from mrta_zoo.debug.advice import Advice
from mrta_zoo.debug.advisors import Advisor, make_advisor
from mrta_zoo.debug.outlook import Prospect, SortKey, outlook, ranked
from mrta_zoo.debug.recorder import overrule, recorded
from mrta_zoo.errors import ActionError, MrtaError
from mrta_zoo.io import read_trace, write_trace
from mrta_zoo.io.text_files import StrPath
from mrta_zoo.mission import Mission
from mrta_zoo.plan import Plan
from mrta_zoo.policies.protocol import Policy, Solver
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import Scenario
from mrta_zoo.trace import Choice, Trace, apply_choice, mission_after
from mrta_zoo.wording import counted


class Stepper:
    """An episode under way, in which every decision can be looked at, taken back and made differently.

    It stands before one decision, or at the end. Choices made beyond it before going back are kept until another choice
    is made here. Everything it shows equals that of a fresh mission in which the same choices are made.

    >>> stepper = Stepper(scenario, "capam-plus")
    >>> stepper.follow()                  # the policy's choice
    >>> stepper.take(7)                   # another one
    >>> stepper.back()
    >>> for prospect in stepper.outlook()[:3]:
    ...     print(prospect.task, prospect.finish, prospect.slack, prospect.probability, prospect)

    Args:
        scenario: the mission.
        method: whose advice to show: a name or path that `registry.make_solver` knows, a policy, a solver, a plan, or
            an `Advisor`; None for no advice.
        **options: see `advisors.make_advisor`.

    Attributes:
        scenario: the scenario.
        mask_rule: what robots may choose.
        mission: as it stands before this decision. Do not change or keep it: `forward` moves the same object on.
        position: how many decisions have been made so far.

    Raises:
        MrtaError: if there is no such method, or an option is out of range.
    """

    def __init__(
        self, scenario: Scenario, method: str | Policy | Solver | Plan | Advisor | None = None, **options: Any
    ) -> None:
        advisor = method if isinstance(method, Advisor) or method is None else make_advisor(scenario, method, **options)
        rule: MaskRule = options.get("mask_rule") or ("feasible" if advisor is None else advisor.mask_rule)
        self._open(Trace(scenario, (), rule), advisor)

    @classmethod
    def resume(cls, trace: Trace, advisor: Advisor | None = None) -> Stepper:
        """Step through a recorded episode, from its bookmark or else from its start.

        Args:
            trace: the episode. Its probabilities are shown as recorded.
            advisor: asked where the trace holds no advice; None for no advice there.
        """
        stepper = cls.__new__(cls)
        stepper._open(trace, advisor)
        stepper.go_to(trace.bookmark or 0)
        return stepper

    @classmethod
    def load(cls, path: StrPath, advisor: Advisor | None = None) -> Stepper:
        """Continue a saved session, or any other trace.

        Raises:
            MrtaError: if the file is missing or malformed.
        """
        return cls.resume(read_trace(path), advisor)

    def _open(self, trace: Trace, advisor: Advisor | None) -> None:
        self.scenario, self.mask_rule = trace.scenario, trace.mask_rule
        self._trace, self._advisor, self._advice = trace, advisor, Advice(trace, advisor)
        self._choices = list(trace.choices)
        self.position = 0
        self.mission = Mission(self.scenario, self.mask_rule)

    def __len__(self) -> int:
        """The number of decisions made, including those beyond this one that were made before going back."""
        return len(self._choices)

    @property
    def method(self) -> str:
        """Name of the policy or solver that advises; empty if there is none."""
        return self._trace.method if self._advisor is None else self._advisor.method

    @property
    def robot(self) -> int:
        """The robot that is to choose; -1 at the end."""
        return self.mission.actor

    @property
    def done(self) -> bool:
        """Whether the mission is over."""
        return self.mission.done

    @property
    def made(self) -> Choice | None:
        """The choice made here before going back; None if none was."""
        return self._choices[self.position] if self.position < len(self._choices) else None

    @property
    def advice(self) -> Choice | None:
        """What the policy would choose; None at the end, or if there is no policy."""
        return self._advice.at(self.position, self.mission, self._choices)

    def outlook(self, robot: int | None = None, by: SortKey = "rank") -> list[Prospect]:
        """Every task as a robot sees it, by default the robot that is to choose.

        Raises:
            ActionError: at the end, if no robot is named.
            MrtaError: if there is no such robot or order.
        """
        if robot is None and self.done:
            raise ActionError("the mission is over, and no robot is to choose; name one, or go back")
        robot = self.robot if robot is None else robot
        advice = self.advice if robot == self.robot else None
        probabilities = None if advice is None else advice.probabilities
        return ranked(outlook(self.mission, robot, probabilities), by)

    def follow(self) -> Choice:
        """Choose as the policy would.

        Raises:
            ActionError: if the mission is over, or there is no policy.
        """
        self._check_not_over()
        if self.advice is None:
            raise ActionError("there is no policy to follow here; name a task")
        return self._choose(self.advice)

    def take(self, task: int) -> Choice:
        """Let the robot take this task, whatever the policy would do.

        Raises:
            ActionError: if the mission is over or the robot may not take it; nothing is changed then.
        """
        self._check_not_over()
        return self._choose(Choice(task) if self.advice is None else overrule(self.advice, task))

    def stay(self) -> Choice:
        """Let the robot stay where it is for good, which the environment does not offer.

        Raises:
            ActionError: if the mission is over.
        """
        self._check_not_over()
        return self._choose(Choice(None) if self.advice is None else overrule(self.advice, None))

    def back(self, decisions: int = 1) -> None:
        """Take back this many decisions, or all if there are fewer."""
        self.go_to(max(self.position - decisions, 0))

    def forward(self, decisions: int = 1) -> None:
        """Go on: repeat the choices made before going back, then follow the policy.

        Raises:
            ActionError: if the mission is over, or there is no policy to follow.
        """
        self._check_not_over()
        for _ in range(decisions):
            if self.done:
                return
            if (made := self.made) is None:
                self.follow()
            else:
                apply_choice(self.mission, made, self.position)
                self.position += 1

    def go_to(self, position: int) -> None:
        """Go to just before a decision, counted from 0, or to the end if the mission is over by then.

        Raises:
            ActionError: if the number is negative, or there is no policy to follow that far.
        """
        if position < 0:
            raise ActionError(f"there is no decision {position}; expected a number from 0")
        if position < self.position:
            self.mission = mission_after(self.scenario, self._choices[:position], self.mask_rule)
            self.position = position
        elif position > self.position and not self.done:
            self.forward(position - self.position)

    def jump(self, robot: int) -> None:
        """Go on to the next decision of this robot, or stay here if it has none.

        Raises:
            ActionError: if it has none, or there is no policy to follow that far.
        """
        if not 0 <= robot < self.scenario.num_robots:
            raise ActionError(f"there is no robot {robot}; expected a number from 0 to {self.scenario.num_robots - 1}")
        here = self.position
        try:
            while not self.done and not self.mission.retired[robot]:
                self.forward()
                if self.robot == robot:
                    return
        except MrtaError:
            self.go_to(here)
            raise
        self.go_to(here)
        raise ActionError(f"robot {self.scenario.robot_label(robot)} does not choose again after this")

    def finish(self) -> None:
        """Go on to the end of the mission.

        Raises:
            ActionError: if there is no policy to follow that far.
        """
        while not self.done:
            self.forward()

    def trace(self) -> Trace:
        """All decisions, with a bookmark at this one."""
        source = self._trace if self._advisor is None else self._advisor
        return Trace(
            self.scenario, tuple(self._choices), self.mask_rule, source.method, source.decode, source.seed,
            source.bound if all(choice.advice is None for choice in self._choices) else None, self.position,
        )  # fmt: skip

    def save(self, path: StrPath) -> None:
        """Write `trace` as JSON, for `load` and for everything else that reads traces.

        Raises:
            PlanError: if the file cannot be written.
        """
        write_trace(self.trace(), path)

    def _check_not_over(self) -> None:
        if self.done:
            raise ActionError(
                f"the mission is over, after {counted(self.position, 'decision')}; go back to choose otherwise"
            )

    def _choose(self, choice: Choice) -> Choice:
        made = self.made
        if choice.task is None:
            self.mission.stay()
        else:
            self.mission.assign(choice.task)
        if made is None or made.task != choice.task:  # the episode takes another course from here
            self._choices[self.position :] = [recorded(choice)]
            self._advice.forget_after(self.position)
        self.position += 1
        return choice
