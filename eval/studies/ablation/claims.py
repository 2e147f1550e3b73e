"""The paper's claims about CapAM, answered from the rows: whichever way they come out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from mrta_zoo.eval.report import wording
from mrta_zoo.eval.significance import SIGNIFICANT, holm
from mrta_zoo.eval.studies.ablation.design import CAPAM, ENCODER, MOMENTS, ROBOTS
from mrta_zoo.eval.studies.effects import Effect
from mrta_zoo.eval.studies.study import Study

Verdict = Literal["supported", "not supported", "undecided"]

MATTERS = 1.0
"""Percentage points below which an advantage is not worth speaking of."""
AM = "am"
ADVANTAGE = {CAPAM: 1.0, AM: -1.0}

GAP: dict[int, float] = {ROBOTS[0]: 1.0, ROBOTS[-1]: -1.0}
"""Weights of the numbers of robots: the gap at the most tasks a robot, minus that at the fewest."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Claim:
    """What the paper says, and what the study found.

    Attributes:
        name: in tables.
        says: the claim, and what is measured of it.
        effect: greater than 0 if it holds.
        adjusted: p-value, adjusted for the number of claims; None if there is none.
    """

    name: str
    says: str
    effect: Effect
    adjusted: float | None

    @property
    def verdict(self) -> Verdict:
        """Supported, if the effect is sure and as claimed; not supported, if an advantage of `MATTERS` is ruled out."""
        difference = self.effect.difference
        if self.adjusted is not None and self.adjusted < SIGNIFICANT and difference.mean > 0:
            return "supported"
        if difference.high is not None and difference.high < MATTERS:
            return "not supported"
        return "undecided"

    @property
    def sentence(self) -> str:
        """The answer in a line."""
        difference = self.effect.difference
        p = f", adjusted p {wording.equals(wording.p_value(self.adjusted))}" if self.adjusted is not None else ""
        interval = (
            f"{wording.INTERVAL} {wording.number(difference.low, signed=True)} to "
            f"{wording.number(difference.high, signed=True)}{p}"
            if difference.low is not None and difference.high is not None
            else f"no interval ({difference.note})"
        )
        return (
            f"{self.name}: {wording.number(difference.mean, signed=True)} points, {interval}: {self.verdict}. "
            f"({self.says})"
        )


def claims_of(study: Study) -> list[Claim]:
    """The claims that the study's questions can answer, in the paper's order."""
    found: list[tuple[str, str, Effect]] = []
    asked = study.design.questions
    if ENCODER in asked:
        found.append(
            (
                "CapAM over AM",
                "Paper: with 100 tasks CapAM completes 3 to 13.5 points more than AM. Here: capam minus am, mean over "
                f"{wording.listed([str(each) for each in ROBOTS])} robots.",
                study.effect(ADVANTAGE, among=ENCODER.arms),
            )
        )
    if MOMENTS in asked:
        found.append(
            (
                "P ≥ 2 over P = 1",
                "Paper: P = 1 is slightly poorer than P = 2 and 3, which hardly differ. Here: the mean of P = 2 and 3, "
                "minus P = 1.",
                study.effect({CAPAM: 0.5, "capam-p2": 0.5, "capam-p1": -1.0}, among=MOMENTS.arms),
            )
        )
    if ENCODER in asked:
        most, fewest = (f"{study.design.budget.tasks / robots:g}" for robots in GAP)
        found.append(
            (
                "The gap grows with tasks a robot",
                "Paper: CapAM is furthest ahead of AM where there are many tasks a robot. Here: capam minus am at "
                f"{most} tasks a robot, minus the same at {fewest}.",
                study.effect(ADVANTAGE, GAP, among=ENCODER.arms),
            )
        )
    adjusted = holm([effect.p for _, _, effect in found])
    return [
        Claim(name=name, says=says, effect=effect, adjusted=p)
        for (name, says, effect), p in zip(found, adjusted, strict=True)
    ]


def gap_by_robots(study: Study) -> list[tuple[int, Effect]]:
    """CapAM minus AM for each number of robots."""
    return [(robots, study.effect(ADVANTAGE, {robots: 1.0}, among=ENCODER.arms)) for robots in ROBOTS]


def verdicts(claims: Sequence[Claim]) -> str:
    """How a verdict comes about, for a caption; nothing if there are no claims."""
    return (
        f"Supported: the adjusted p-value is below {SIGNIFICANT:g} and the difference as claimed. Not supported: the "
        f"interval ends below +{MATTERS:g} point. Undecided: neither."
        if claims
        else ""
    )
