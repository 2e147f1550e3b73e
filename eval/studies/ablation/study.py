"""A study: what was asked for, and the rows that came of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mrta_zoo.eval.plot_history import LearningCurve
from mrta_zoo.eval.significance import SIGNIFICANT, holm
from mrta_zoo.eval.studies.ablation.questions import Question
from mrta_zoo.eval.studies.ablation.variants import ROBOTS, Budget, Variant
from mrta_zoo.eval.studies.effects import Effect, Runs, arrange, effect_of, equal_weights
from mrta_zoo.eval.studies.rows import RunRow


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """One variant against its reference.

    Attributes:
        question: that it belongs to.
        distribution: of the held-out scenarios.
        variant: its name.
        effect: variant minus reference.
        adjusted: p-value, adjusted for the comparisons of the question; None if there is none.
    """

    question: Question
    distribution: str
    variant: str
    effect: Effect
    adjusted: float | None

    @property
    def sure(self) -> bool:
        """Whether there is a difference after adjustment."""
        return self.adjusted is not None and self.adjusted < SIGNIFICANT


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """All of it.

    Attributes:
        questions: that were asked.
        variants: that were trained, by name.
        budget: of each run.
        seeds: number of runs of each variant.
        rows: in order.
        curves: of each (variant, seed).
    """

    questions: Sequence[Question]
    variants: Mapping[str, Variant]
    budget: Budget
    seeds: int
    rows: Sequence[RunRow]
    curves: Mapping[tuple[str, int], LearningCurve]

    @property
    def decoders(self) -> dict[str, str]:
        """Of each variant: runs with the same one are taken to scatter alike."""
        return {name: variant.config.network.decoder for name, variant in self.variants.items()}

    def runs(self, question: Question, distribution: str) -> dict[str, Runs]:
        """The runs of a question's variants."""
        found = arrange(row for row in self.rows if row.distribution == distribution)
        return {name: found[name, distribution] for name in question.variants}

    def comparisons(self) -> list[Comparison]:
        """Every variant of every question against its reference."""
        return [each for question in self.questions for each in self._comparisons(question)]

    def _comparisons(self, question: Question) -> list[Comparison]:
        found = []
        for distribution in question.distributions:
            pool = self.runs(question, distribution)
            for variant in question.others:
                coefficients = {variant: 1.0, question.reference: -1.0}
                effect = effect_of(pool, coefficients, equal_weights(ROBOTS), self.decoders)
                found.append((distribution, variant, effect))
        adjusted = holm([effect.p for _, _, effect in found])
        return [
            Comparison(question=question, distribution=distribution, variant=variant, effect=effect, adjusted=p)
            for (distribution, variant, effect), p in zip(found, adjusted, strict=True)
        ]
