"""Running the command line in tests, and checking how it refuses."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from factories import small_scenario

from mrta_zoo.cli.main import COMMANDS, Command, main

Captured = pytest.CaptureFixture[str]
REPORTED = {"reproduce", "converge", "ablate", "sharing"}
SCENARIO = small_scenario(2, tasks=12, robots=3)


def need(command: str) -> None:
    """Skip a test whose command needs an extra that is not installed."""
    for module, commands in (("torch", {"train", "ablate", "sharing"}), ("pandas", REPORTED)):
        if command in commands:
            pytest.importorskip(module)


def script(folder: Path, text: str) -> str:
    """A file of commands for the stepper."""
    (folder / "commands.txt").write_text(text)
    return str(folder / "commands.txt")


def fails(capsys: Captured, arguments: list[str]) -> str:
    """Run a command that must end with code 2 and one line on standard error; returns that line."""
    capsys.readouterr()
    assert main(arguments) == 2
    output = capsys.readouterr()
    assert output.out == ""
    assert output.err.startswith("error: ")
    assert output.err.count("\n") == 1
    return output.err


def refused(capsys: Captured, arguments: list[str]) -> str:
    """Run a command whose flags must be refused; returns its standard error."""
    capsys.readouterr()
    with pytest.raises(SystemExit) as exit_:
        main(arguments)
    assert exit_.value.code == 2
    output = capsys.readouterr()
    assert output.out == ""
    assert "Traceback" not in output.err
    return output.err


def changed(arguments: list[str], *flags: str) -> list[str]:
    """The arguments with these flags, each followed by its value, in place of the values given before."""
    others = list(arguments)
    for flag, value in zip(flags[::2], flags[1::2], strict=True):
        if flag in others:
            others[others.index(flag) + 1] = value
        else:
            others += [flag, value]
    return others


def stand_in(name: str, run: Callable[[list[str]], None], monkeypatch: pytest.MonkeyPatch) -> None:
    """Make `run` the command of that name, whether or not there is one."""
    monkeypatch.setitem(COMMANDS, name, Command(""))
    monkeypatch.setitem(sys.modules, f"mrta_zoo.cli.{name}", SimpleNamespace(**{f"{name}_command": run}))
