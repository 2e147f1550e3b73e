"""What is printed at terminals of any width: no number, and no word, is cut or torn."""

from __future__ import annotations

import io
import re
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from mrta_zoo.cli.main import main
from mrta_zoo.debug import Stepper
from mrta_zoo.debug.screen import screen
from mrta_zoo.debug.session import Session
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.io import write_scenario
from mrta_zoo.show.terminal.console import LiteralConsole, fitting, say
from mrta_zoo.show.terminal.fold import clipped, fold
from mrta_zoo.show.terminal.sheet import Sheet

SCENARIO = TaptcGenerator(tasks=(40, 40), robots=(11, 11))(np.random.default_rng(3), "narrow")
WIDTHS = (80, 47, 40, 30, 20)
SHEET = Sheet(
    "Tasks completed, mean %", ("robot", "capam-plus", "why"),
    (("robot 0", "1234567.25", "it was the nearest of all"), ("robot 10", "-0.5", "")), left=("robot", "why"),
    ends=(1,), prose="why",
)  # fmt: skip


class Terminal(io.StringIO):
    """Standard output that says it is a terminal."""

    def isatty(self) -> bool:
        return True


def tokens(text: str) -> list[str]:
    """Words and numbers, without colours, lines drawn, and commas."""
    return re.sub(r"\x1b\[[0-9;]*m|[─,]", " ", text).split()


def printed(what: object, width: int) -> str:
    console = Console(file=io.StringIO(), width=width, markup=False, highlight=False)
    with console.capture() as captured:
        console.print(what, crop=False)
    return captured.get()


@pytest.mark.parametrize("width", [*WIDTHS, 12, 5])
def test_a_sheet_keeps_all_its_words(width: int) -> None:
    words = tokens(printed(SHEET, width))
    for row in SHEET.rows:
        for cell in row:
            assert set(tokens(cell)) <= set(words)
    assert set(tokens(SHEET.title)) | {"capam-plus", "why"} <= set(words)
    if width >= 20:
        assert max(map(len, printed(SHEET, width).split("\n"))) <= width


def test_the_three_forms() -> None:
    assert printed(SHEET, 60).split("\n")[2].split() == ["robot", "capam-plus", "why"]
    assert "robot 0  1234567.25 it was the" in printed(SHEET, 30)
    assert printed(SHEET, 24).split("\n")[1:6] == [
        "robot 0,", "  capam-plus 1234567.25,", "  why it was the nearest", "  of all", "robot 10,",
    ]  # fmt: skip


def test_folding() -> None:
    assert fold("cost 46.899, distance 782.2", 14, "  ") == ["cost 46.899,", "  distance", "  782.2"]
    assert fold("", 5) == [""]
    assert fold("/a/long/path-to-it is there", 4) == ["/a/long/path-to-it", "is", "there"]
    assert (clipped("time 100.5", 10), clipped("time 100.5", 9)) == ("time 100.5", "time…")


@pytest.mark.parametrize("width", WIDTHS)
def test_commands(width: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_scenario(SCENARIO, tmp_path / "narrow.json")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("mrta_zoo.eval.runner.time.perf_counter", lambda: 0.0)
    for arguments in (
        ["solve", "narrow.json", "--method", "nearest"],
        ["eval", "--cases", ".", "--methods", "nearest,edf,random,big-mrta"],
        ["compare", "narrow.json", "--methods", "nearest,edf"],
    ):
        outputs = []
        for columns, stream in ((None, io.StringIO()), (width, Terminal())):
            monkeypatch.setenv("COLUMNS", str(columns)) if columns else monkeypatch.delenv("COLUMNS", raising=False)
            monkeypatch.setattr("sys.stdout", stream)
            assert main(arguments) == 0
            outputs.append(stream.getvalue())
        piped, narrow = outputs
        assert "…" not in piped + narrow
        assert set(tokens(piped)) == set(tokens(narrow))
        lines = re.sub(r"\x1b\[[0-9;]*m", "", narrow).split("\n")
        assert max(map(len, lines)) <= width


@pytest.mark.parametrize("width", WIDTHS)
def test_the_screen_of_step(width: int) -> None:
    steps = Session(Stepper(SCENARIO, "nearest"))
    for command in ("goto 5", "tasks 1", "robots", "log", "end"):
        said = steps.do(command)
        whole = set(tokens(printed(screen(steps, 50, 1000, said), 1000)))
        seen = printed(screen(steps, 50, width, said), width)
        assert {token for token in tokens(seen) if re.search("[0-9]", token)} <= whole
        assert max(len(line.rstrip()) for line in seen.split("\n")) <= width


def test_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    from rich.progress import BarColumn, MofNCompleteColumn

    columns = (MofNCompleteColumn(), BarColumn())
    assert fitting(columns, Console(width=80)) == columns
    assert fitting(columns, Console(width=40)) == columns[:1]
    line = "update     40  episodes     1,280  validation completion 61.25 %"
    for terminal, expected in ((False, [line]), (True, fold(line, 20))):
        output = io.StringIO()
        say(Console(file=output, width=20, force_terminal=terminal, color_system=None), line)
        assert output.getvalue().split("\n")[:-1] == expected


def test_nothing_in_a_cell_steers_the_terminal() -> None:
    printed = io.StringIO()
    LiteralConsole(file=printed, width=80).print(Sheet("a\x1b[31m", ("b\x1b[31m", "c"), [("\u202e1", "2")]))
    assert "\x1b" not in printed.getvalue()
    assert "\u202e" not in printed.getvalue()
