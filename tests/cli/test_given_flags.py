"""Flags that are unknown, repeated or empty get a sentence that names the right ones; help fits the terminal."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

import pytest
from command_line import Captured, fails

from mrta_zoo.cli.given_flags import check_flags
from mrta_zoo.cli.main import COMMANDS, main

TRAINED = {"train", "ablate", "sharing"}
REPORTED = {"reproduce", "converge", "ablate", "sharing"}


def need(command: str) -> None:
    for module, commands in (("torch", TRAINED), ("pandas", REPORTED)):
        if command in commands:
            pytest.importorskip(module)


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


@pytest.mark.parametrize("module", ["eval.plot_history", "eval.benchmarks.aec_turns", "train.aec_reinforce"])
def test_modules_that_are_run(module: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    pytest.importorskip("matplotlib" if module == "eval.plot_history" else "torch")
    monkeypatch.setattr(sys, "argv", [module, "--ou", "3"])
    monkeypatch.delitem(sys.modules, f"mrta_zoo.{module}", raising=False)
    with pytest.raises(SystemExit) as exit_:
        runpy.run_module(f"mrta_zoo.{module}", run_name="__main__")
    assert exit_.value.code == 2
    assert "--ou" in capsys.readouterr().err


@pytest.mark.parametrize("width", [1, 5, 24, 40, 57, 80, 200])
def test_help_fits_the_terminal(width: int, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    """No line is longer than that, or than what is easy to read."""
    monkeypatch.setenv("COLUMNS", str(width))
    fits = min(max(width, 40), 100)
    assert main(["--help"]) == 0
    assert max(map(len, capsys.readouterr().out.splitlines())) <= fits
    for command in ("solve", "eval", "demo", "generate"):
        with pytest.raises(SystemExit) as exit_:
            main([command, "--help"])
        assert exit_.value.code == 0
        lines = capsys.readouterr().out.splitlines()
        assert max(map(len, lines)) <= fits
        assert lines[0].startswith(f"usage: mrta-zoo {command} [-h]")


@pytest.mark.parametrize(
    ("command", "line"),
    [
        ("solve", "compare. For eils and +polish"),
        ("eval", "or .json or .csv scenarios), or"),
        ("train", '"uniform" (paper §IV-A), or "mixture" (both, see'),
        ("train", "best policy by validation; usable as"),
    ],
)
def test_help_keeps_no_line_breaks_of_the_source(
    command: str, line: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    need(command)
    monkeypatch.setenv("COLUMNS", "100")
    with pytest.raises(SystemExit):
        main([command, "--help"])
    assert line in capsys.readouterr().out
