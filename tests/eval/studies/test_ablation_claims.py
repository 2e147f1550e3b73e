"""The paper's claims, answered from differences."""

from __future__ import annotations

import pytest

from mrta_zoo.eval.significance import TOO_FEW, Estimate
from mrta_zoo.eval.studies.ablation.claims import Claim
from mrta_zoo.eval.studies.effects import Effect


@pytest.mark.parametrize(
    ("mean", "low", "high", "adjusted", "verdict"),
    [
        (3.0, 1.0, 5.0, 0.01, "supported"),
        (3.0, 1.0, 5.0, 0.06, "undecided"),  # sure alone, not among three claims
        (3.0, -1.0, 7.0, 0.2, "undecided"),
        (-3.0, -5.0, -1.0, 0.01, "not supported"),  # the opposite is sure
        (0.0, -0.9, 0.9, 0.9, "not supported"),  # at most 0.9 points, which is next to nothing
        (0.5, 0.2, 0.8, 0.01, "supported"),  # little, but there
        (3.0, None, None, None, "undecided"),  # one run
    ],
)
def test_verdicts(mean: float, low: float | None, high: float | None, adjusted: float | None, verdict: str) -> None:
    effect = Effect(difference=Estimate(mean, low, high, 4, "" if low is not None else TOO_FEW), p=adjusted)
    claim = Claim(name="A over B", says="As said.", effect=effect, adjusted=adjusted)
    assert claim.verdict == verdict
    assert f": {verdict}. (As said.)" in claim.sentence


def test_an_answer_says_its_numbers() -> None:
    effect = Effect(difference=Estimate(-1.25, -3.0, 0.5, 4), p=0.1)
    claim = Claim(name="CapAM over AM", says="As said.", effect=effect, adjusted=0.3)
    assert claim.sentence == (
        "CapAM over AM: −1.2 points, 95 % interval −3.0 to +0.5, adjusted p = 0.3: not supported. (As said.)"
    )
