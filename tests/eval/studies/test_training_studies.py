"""What the commands that train for a study, `ablate` and `sharing`, have in common."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import Captured, fails

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.manifest import Manifest
from mrta_zoo.eval.plot_history import LearningCurve
from mrta_zoo.eval.significance import TOO_FEW, Estimate
from mrta_zoo.eval.studies.ablation import CLAIMS
from mrta_zoo.eval.studies.design import choose
from mrta_zoo.eval.studies.effects import Effect
from mrta_zoo.eval.studies.sharing import QUESTIONS, USUAL, sharing
from mrta_zoo.eval.studies.study import Answer, Study

BOTH = ("ablate", "sharing")


@pytest.mark.parametrize(
    ("command", "flags", "sentence"),
    [
        *(
            (command, flags, sentence)
            for command in BOTH
            for flags, sentence in (
                (["--seeds", "0"], "seeds is 0; expected a whole number from 1 to 1000"),
                (["--seeds", "9" * 20], "expected a whole number from 1 to 1000"),
                (["--held-out", "9" * 20], "expected 2 to 10,000 scenarios"),
                (["--workers", "0"], "workers is 0; expected a whole number from 1 to 1024"),
                (["--held-out", "1"], "held_out is 1; expected 2 to 10,000"),
                (["--samples", "1"], "samples is 1; expected at least 2"),
                (["--updates", "0"], "updates is 0; expected a whole number >= 1"),
            )
        ),
        ("sharing", ["--scenarios", "6"], "scenarios is 6; expected 4, 8, 12, …"),
        ("sharing", ["--only", "speed"], "there is no question 'speed'; expected some of episodes, decisions"),
    ],
)
def test_what_cannot_be_done_is_said(
    tmp_path: Path, capsys: Captured, command: str, flags: list[str], sentence: str
) -> None:
    assert sentence in fails(capsys, [command, "--out", str(tmp_path / "out"), *flags])
    assert not (tmp_path / "out").exists()


def test_questions_by_name() -> None:
    chosen = choose(["decisions", "episodes"], QUESTIONS)
    assert [question.name for question in chosen] == ["episodes", "decisions"]
    with pytest.raises(ConfigError, match="there is no question"):
        choose(["other"], QUESTIONS)


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
    effect = Effect(difference=Estimate(mean, low, high, 4, "" if low is not None else TOO_FEW), adjusted_p=adjusted)
    assert Answer(claim=CLAIMS[0], effect=effect).verdict == verdict


def test_the_gain_of_training() -> None:
    # 3.125 points, and 0 (the best counts, not the last): 1.5625 in the mean.
    curves = {
        ("capam", 0): LearningCurve("", (0, 8, 16), (0.25, 0.28125, 0.27)),
        ("capam", 1): LearningCurve("", (0, 8, 16), (0.5, 0.49, 0.48)),
        ("am", 0): LearningCurve("", (0, 8), (0.5, 0.6)),
    }
    design = sharing(["episodes"], 1, USUAL, 2)
    manifest = Manifest(command="sharing", settings={}, cases="", weights={})
    study = Study(design=design, manifest=manifest, machines=[], rows=[], curves=curves, folders={})
    assert study.gain("capam") == pytest.approx(1.5625)
