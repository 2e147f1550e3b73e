"""Advice: what an advisor says at each decision of an episode, asked on demand and kept until a choice changes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mrta_zoo.debug.advisors import Advisor
from mrta_zoo.mission import Mission
from mrta_zoo.trace import Choice, Trace, apply_choice, mission_after


class Advice:
    """The advice for one episode, in which a user goes back and forth and may choose otherwise.

    Args:
        trace: the choices made so far, with the advice given at the time.
        advisor: asked at all other decisions; None for no advice there.
    """

    def __init__(self, trace: Trace, advisor: Advisor | None) -> None:
        self._advisor = advisor
        # By decision: the advice, and the advisor's state before it.
        self._advice = {index: _advice_in(choice) for index, choice in enumerate(trace.choices)}
        self._states: dict[int, Any] = {} if advisor is None else {0: advisor.begin()}

    def at(self, position: int, mission: Mission, choices: Sequence[Choice]) -> Choice | None:
        """The advice for a decision; None if the mission is over, or there is nobody to ask.

        Args:
            position: the decision, counted from 0.
            mission: as it stands before the decision.
            choices: those made before it, and perhaps later ones.
        """
        if position not in self._advice:
            if mission.done or self._advisor is None:
                return None
            self._ask(self._advisor, position, mission, choices)
        return self._advice[position]

    def forget_after(self, position: int) -> None:
        """Forget the advice at later decisions, as the choice at this one has changed."""
        self._advice = {index: advice for index, advice in self._advice.items() if index <= position}
        self._states = {index: state for index, state in self._states.items() if index <= position + 1}

    def _ask(self, advisor: Advisor, position: int, mission: Mission, choices: Sequence[Choice]) -> None:
        """Ask about this decision; an advisor with memory is first asked about the earlier ones that it missed."""
        if advisor.memoryless:
            self._advice[position], state = advisor.advise(mission, self._states[max(self._states)])
            self._states = {0: state}
            return
        begin = max(index for index in self._states if index <= position)
        earlier = mission_after(mission.scenario, choices[:begin], mission.mask_rule)
        for index in range(begin, position + 1):
            advice, self._states[index + 1] = advisor.advise(earlier, self._states[index])
            self._advice.setdefault(index, advice)
            if index < position:
                apply_choice(earlier, choices[index], index)


def _advice_in(choice: Choice) -> Choice:
    """The advice given at a recorded decision."""
    return choice if choice.advice is None else Choice(choice.advice, choice.probabilities)
