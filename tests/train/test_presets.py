"""Presets and flags."""

from __future__ import annotations

from pathlib import Path

import pytest

from mrta_zoo.cli.train import parse, train_command
from mrta_zoo.errors import ConfigError
from mrta_zoo.train.presets import PRESETS


def test_paper_preset_is_table_1() -> None:
    paper = PRESETS["paper"]
    assert paper.baseline == "rollout"
    assert paper.updates // paper.epoch == 100  # epochs
    assert paper.epoch * paper.scenarios * paper.samples == 500_000  # training samples an epoch
    assert paper.scenarios * paper.samples == 500  # training frequency
    assert paper.validation_scenarios == 10_000
    assert paper.learning_rate == paper.final_learning_rate == 1e-4
    assert (paper.network.hops, paper.network.moments, paper.network.layers, paper.network.heads) == (
        2,
        3,
        1,
        8,
    )
    assert (paper.tasks, paper.min_robots, paper.max_robots, paper.generator) == ((100,), 2, 7, "uniform")


def test_flags_override_the_preset() -> None:
    command = parse(["--preset", "smoke", "--out", "x", "--moments", "2", "--learning-rate", "0.01", "--no-normalise"])
    assert command.config.network.moments == 2
    assert command.config.network.embedding == PRESETS["smoke"].network.embedding
    assert command.config.learning_rate == 0.01
    assert not command.config.normalise


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--preset", "smoky", "--out", "x"], "there is no preset 'smoky'; expected one of paper, fast"),
        (["--preset", "smoke", "--out", "x", "--threads", "-1"], "threads is -1"),
        (["--preset", "smoke", "--out", "x", "--threads", "99999999999"], "expected a whole number from 0 to 1024"),
        (["--out", "nowhere", "--resume"], "nowhere holds no run to resume"),
    ],
)
def test_bad_flags_are_told_in_a_sentence(arguments: list[str], sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence):
        train_command(arguments)


def test_resume_keeps_the_configuration(tmp_path: Path) -> None:
    from mrta_zoo.train import checkpoint

    checkpoint.start(tmp_path, PRESETS["smoke"])
    sentence = f"--resume keeps the run's configuration; updates is 240 in .*, not 5; .* --initial {tmp_path}, another"
    with pytest.raises(ConfigError, match=sentence):
        train_command(["--out", str(tmp_path), "--resume", "--updates", "5"])


def test_resume_with_another_preset_is_refused(tmp_path: Path) -> None:
    from mrta_zoo.train import checkpoint

    checkpoint.start(tmp_path, PRESETS["smoke"])
    with pytest.raises(ConfigError, match="--resume keeps the run's configuration"):
        train_command(["--out", str(tmp_path), "--resume", "--preset", "fast"])


def test_impossible_value_is_told_with_exit_code_2(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        train_command(["--preset", "smoke", "--out", "x", "--heads", "7"])
    assert stopped.value.code == 2
    assert "embedding is 64; expected a multiple of heads" in capsys.readouterr().err
