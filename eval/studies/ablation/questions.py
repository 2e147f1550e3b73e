"""What the study asks: which variants are compared with which, and on which scenarios."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mrta_zoo.eval.studies.ablation.variants import CAPAM, REFERENCE
from mrta_zoo.eval.studies.held_out import Distribution


@dataclass(frozen=True, slots=True, kw_only=True)
class Question:
    """A family of comparisons: p-values are adjusted for their number within it.

    Attributes:
        name: for the flag, and in tables.
        title: for people.
        reference: the variant that the others are compared with.
        others: the variants that differ from it in one thing.
        distributions: of the held-out scenarios that count.
    """

    name: str
    title: str
    reference: str
    others: tuple[str, ...]
    distributions: tuple[Distribution, ...] = ("taptc",)

    @property
    def variants(self) -> tuple[str, ...]:
        """All of them, the reference first."""
        return (self.reference, *self.others)


ENCODER = Question(
    name="encoder", title="Encoder, with the paper’s decoder", reference=CAPAM, others=("am-1", "am", "capam-none")
)
MOMENTS = Question(
    name="moments",
    title="P, with the paper’s decoder",
    reference=CAPAM,
    others=("capam-p2", "capam-p1"),
)
QUESTIONS: dict[str, Question] = {
    question.name: question
    for question in (
        ENCODER,
        MOMENTS,
        Question(
            name="plus-encoder",
            title="Encoder, with the candidate decoder",
            reference=REFERENCE,
            others=("plus-am", "plus-none"),
        ),
        Question(name="decoder", title="Decoder", reference=REFERENCE, others=("paper-decoder", "no-layers")),
        Question(name="baseline", title="Baseline", reference=REFERENCE, others=("rollout", "exponential")),
        Question(name="mask-rule", title="Mask rule", reference=REFERENCE, others=("active", "unvisited")),
        Question(
            name="distribution",
            title="Training distribution",
            reference=REFERENCE,
            others=("uniform", "mixture"),
            distributions=("taptc", "uniform"),
        ),
    )
}


def needed(questions: Sequence[Question]) -> dict[str, tuple[Distribution, ...]]:
    """The variants that these questions compare, with the distributions that each is evaluated on."""
    found: dict[str, tuple[Distribution, ...]] = {}
    for question in questions:
        for name in question.variants:
            found[name] = tuple(dict.fromkeys((*found.get(name, ()), *question.distributions)))
    return found
