"""What an advisor says at each decision of an episode: asked when it is wanted, and kept while the choices last."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mrta_zoo.debug.advisors import Advisor
from mrta_zoo.mission import Mission
from mrta_zoo.trace import Choice, Trace, after, make


class Advice:
    """The advice for one episode, in which somebody goes back and forth and may choose otherwise.

    Args:
        trace: choices that there are already, with the advice that was given then.
        advisor: is asked about the others; None for nobody.
    """

    def __init__(self, trace: Trace, advisor: Advisor | None) -> None:
        self._advisor = advisor
        # By decision: the advice, and the state in which the decision finds the advisor.
        self._advice = {index: _advice_in(choice) for index, choice in enumerate(trace.choices)}
        self._states: dict[int, Any] = {} if advisor is None else {0: advisor.begin()}

    def at(self, position: int, mission: Mission, choices: Sequence[Choice]) -> Choice | None:
        """The advice for a decision; None if the mission is over, or there is nobody to ask.

        Args:
            position: the decision, counted from 0.
            mission: as it stands before it.
            choices: those made before it, and maybe more.
        """
        if position not in self._advice:
            if mission.done or self._advisor is None:
                return None
            self._ask(self._advisor, position, mission, choices)
        return self._advice[position]

    def forget_after(self, position: int) -> None:
        """Forget what was said at later decisions, as something else is chosen at this one."""
        self._advice = {index: advice for index, advice in self._advice.items() if index <= position}
        self._states = {index: state for index, state in self._states.items() if index <= position + 1}

    def _ask(self, advisor: Advisor, position: int, mission: Mission, choices: Sequence[Choice]) -> None:
        """Ask about this decision; an advisor that remembers, first about those that it was not asked about."""
        if advisor.memoryless:
            self._advice[position], state = advisor.advise(mission, self._states[max(self._states)])
            self._states = {0: state}
            return
        begin = max(index for index in self._states if index <= position)
        earlier = after(mission.scenario, choices[:begin], mission.mask_rule)
        for index in range(begin, position + 1):
            advice, self._states[index + 1] = advisor.advise(earlier, self._states[index])
            self._advice.setdefault(index, advice)
            if index < position:
                make(earlier, choices[index], index)


def _advice_in(choice: Choice) -> Choice:
    """What was said at a decision that was recorded."""
    return choice if choice.advice is None else Choice(choice.advice, choice.probabilities)
