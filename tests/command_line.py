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
