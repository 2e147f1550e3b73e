"""Help fits the terminal, and is easy to read at any width."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from command_line import Captured, need

from mrta_zoo.cli.flags import parse
from mrta_zoo.cli.main import main


@dataclass
class Flags:
    """A command."""

    number: int = 0
    """A line, then
    "a quoted one",
    - a dashed one, and
    7 words."""


def test_a_text_is_one_paragraph(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    with pytest.raises(SystemExit):
        parse(Flags, ["--help"], "test")
    assert 'A line, then "a quoted one", - a dashed one, and 7 words. (default: 0)' in capsys.readouterr().out


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
