"""What the commands that train for a study, `ablate` and `sharing`, have in common."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import Captured, fails

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.studies.design import choose
from mrta_zoo.eval.studies.sharing.design import QUESTIONS

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
