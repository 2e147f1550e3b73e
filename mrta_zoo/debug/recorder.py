"""Recording of whole episodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from mrta_zoo.debug.advisors import Advisor, make_advisor
from mrta_zoo.mission import Mission
from mrta_zoo.plan import Plan
from mrta_zoo.policies.protocol import Policy, Solver
from mrta_zoo.scenario import Scenario
from mrta_zoo.trace import Choice, Trace, apply_choice

LEAST, FEW = 1e-4, 10
"""Probabilities below `LEAST` are not recorded, unless they are among the `FEW` largest."""


def record(scenario: Scenario, method: str | Policy | Solver | Plan, **options: Any) -> Trace:
    """The episode in which this method decides, with its probabilities if it has some.

    Args:
        scenario: the mission.
        method: a name or path that `registry.make_solver` knows, a policy, a solver, or a plan.
        **options: see `advisors.make_advisor`.

    Raises:
        MrtaError: if there is no such method, it fails, or an option is out of range.
    """
    return play(scenario, make_advisor(scenario, method, **options))


def play(scenario: Scenario, advisor: Advisor, first: Sequence[Choice] = ()) -> Trace:
    """The episode in which the advisor decides, after some given choices.

    Args:
        scenario: the mission.
        advisor: asked at every decision.
        first: what to choose at the first decisions, whatever it advises. A memoryless advisor is asked only from the
            last of them on.

    Raises:
        PlanError: if a robot may not choose what it should.
        ActionError: if a policy's action is not the number of a task.
    """
    mission = Mission(scenario, advisor.mask_rule)
    state = advisor.begin()
    choices: list[Choice] = []
    while not mission.done:
        if advisor.memoryless and len(choices) + 1 < len(first):
            choice = first[len(choices)]
        else:
            choice, state = advisor.advise(mission, state)
            if len(choices) < len(first):
                choice = overrule(choice, first[len(choices)].task)
        apply_choice(mission, choice, len(choices))
        choices.append(recorded(choice))
    return Trace(
        scenario, tuple(choices), advisor.mask_rule, advisor.method, advisor.decode, advisor.seed, advisor.bound
    )


def recorded(choice: Choice) -> Choice:
    """A choice as recorded: without negligible probabilities, unless of the task chosen, the advice or the best."""
    if choice.probabilities is None:
        return choice
    likeliest = sorted(choice.probabilities.items(), key=lambda each: -each[1])  # ties stay in order
    kept = {
        task: probability
        for rank, (task, probability) in enumerate(likeliest)
        if rank < FEW or probability > LEAST or task in (choice.task, choice.advice)
    }
    return replace(choice, probabilities=kept)


def overrule(advice: Choice, task: int | None) -> Choice:
    """The choice of `task`, perhaps against the advice."""
    return advice if task == advice.task else replace(advice, task=task, advice=advice.task)
