"""How the command line ends when it is used wrongly."""

from __future__ import annotations

import pytest

from mrta_zoo.cli.main import main

Captured = pytest.CaptureFixture[str]


def fails(capsys: Captured, arguments: list[str]) -> str:
    """Run a command that ends with code 2 and one line on standard error; that line."""
    capsys.readouterr()
    assert main(arguments) == 2
    output = capsys.readouterr()
    assert output.out == ""
    assert output.err.startswith("error: ")
    assert output.err.count("\n") == 1
    return output.err


def refused(capsys: Captured, arguments: list[str]) -> str:
    """Run a command whose flags are not understood; what standard error says."""
    capsys.readouterr()
    with pytest.raises(SystemExit) as exit_:
        main(arguments)
    assert exit_.value.code == 2
    output = capsys.readouterr()
    assert output.out == ""
    assert "Traceback" not in output.err
    return output.err


def changed(arguments: list[str], *flags: str) -> list[str]:
    """The arguments with other values: flags, each followed by its value, that take the place of those given before."""
    others = list(arguments)
    for flag, value in zip(flags[::2], flags[1::2], strict=True):
        if flag in others:
            others[others.index(flag) + 1] = value
        else:
            others += [flag, value]
    return others
