"""Flags that are unknown, repeated or empty get a sentence that names the right ones."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import Captured, fails, need

from mrta_zoo.cli.given_flags import check_flags
from mrta_zoo.cli.main import COMMANDS


@pytest.mark.parametrize("command", list(COMMANDS))
def test_every_command_names_what_it_knows(command: str, capsys: Captured) -> None:
    need(command)
    complaint = fails(capsys, [command, "--outt", "x"])
    assert "there is no flag --outt; expected one of --" in complaint
    assert "--out" in complaint.split("expected")[1] or command == "step"


@pytest.mark.parametrize(
    ("line", "names"),
    [
        ("converge --budget 3", "--budgets"),
        ("eval --case builtin", "--cases"),
        ("eval --cases builtin --method_s nearest", "--methods"),
        ("solve m.csv --time-limit 3", "--budget"),
        ("solve m.csv --metod nearest", "--method"),
        ("solve m.csv -m nearest", "--method"),
        ("solve m.csv --picture=p.png", "--plot"),
        ("solve --scenario m.csv", "or TASKFILE without a flag"),
        ("replay --plan p.json", "or SCENARIO|PLAN.json|TRACE.json without a flag"),
        ("generate --number 3", "--count"),
    ],
)
def test_the_right_flag_is_named(line: str, names: str, capsys: Captured) -> None:
    need(line.split()[0])
    assert names in fails(capsys, line.split()).split("expected")[1]


@pytest.mark.parametrize("flag", ["--method", "--methods", "--policy", "--policies"])
@pytest.mark.parametrize(
    "line", ["eval --cases .", "solve m.csv", "replay m.csv", "demo", "step m.csv", "compare m.csv"]
)
def test_every_name_of_the_flag_for_methods(line: str, flag: str, capsys: Captured, tmp_path: Path) -> None:
    assert "is empty; expected a value" in fails(capsys, [*line.split(), f"{flag}="])


@pytest.mark.parametrize(
    ("line", "flag"),
    [
        ("eval --cases . --methods nearest --methods edf", "--methods"),
        ("eval --cases . --method nearest --policy edf", "--methods"),
        ("solve m.csv --seed=1 --out p.json --seed 1", "--seed"),
        ("solve m.csv --mask-rule active --mask_rule active", "--mask-rule"),
        ("train --out r --resume --no-resume", "--resume"),
        ("train --out r --tasks 10 20 --tasks 30", "--tasks"),
    ],
)
def test_nothing_is_given_twice(
    line: str, flag: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    need(line.split()[0])
    monkeypatch.chdir(tmp_path)
    if "--resume" in line:
        from mrta_zoo.train import checkpoint
        from mrta_zoo.train.config import TrainConfig

        checkpoint.start(tmp_path / "r", TrainConfig())
    assert f"{flag} is given twice; expected it once" in fails(capsys, line.split())


@pytest.mark.parametrize("given", [["--out="], ["--out", ""], ["--out", "None"], ["--no-such-thing=", "--out"]])
@pytest.mark.parametrize("command", ["solve", "eval", "generate", "train"])
def test_nothing_is_empty(command: str, given: list[str], capsys: Captured) -> None:
    need(command)
    complaint = fails(capsys, [command, *given])
    assert "; expected " in complaint
    assert ("--out is " in complaint) == (given[0] != "--no-such-thing=")


def test_what_stands_without_a_flag_is_not_empty(capsys: Captured) -> None:
    assert "an argument is empty; expected a value" in fails(capsys, ["solve", "", "--method", "nearest"])


def test_values_are_no_flags() -> None:
    check_flags(["-1", "-inf", "-", "a=b", "--out=--x", "--", "--y", ""], {"--out": "--out"})
