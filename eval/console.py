"""Where the command line prints: full width and plain if it is not a terminal; on one, lines break between words."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from mrta_zoo.fold import fold

PIPED_WIDTH = 1000
"""Columns when piped: wide enough for any table here, so that lines are not folded."""
BAR_WIDTH = 72
"""Columns that a progress bar with times and rates needs."""


def results_console() -> Console:
    """Standard output, for results. Text is printed as it is: no markup, no highlighting."""
    width = None if sys.stdout.isatty() else PIPED_WIDTH
    return Console(file=sys.stdout, width=width, markup=False, highlight=False, emoji=False)


def say(console: Console, text: str) -> None:
    """Print sentences as they are; on a terminal folded between words, of which one that is too long runs over."""
    for line in text.split("\n"):
        folded = fold(line, console.width) if console.is_terminal else [line]
        for each in folded:
            console.print(Text(each), soft_wrap=True)


def preparing(what: str = "preparing") -> AbstractContextManager[object]:
    """A sign of life on standard error while methods are made ready, if that is a terminal.

    Args:
        what: is going on.
    """
    console = Console(file=sys.stderr, markup=False, highlight=False, emoji=False)
    if not console.is_terminal:
        return nullcontext()
    return console.status(f"{what} (local search, if any, is compiled at its first use, which can take a minute)")


def fitting(columns: Sequence[ProgressColumn], console: Console) -> Sequence[ProgressColumn]:
    """The columns of a progress bar or, where a terminal has no room for them, the first alone."""
    return columns if console.width >= BAR_WIDTH else columns[:1]


def progress_bar() -> Progress:
    """A bar on standard error that goes away when done; nothing at all if that is no terminal."""
    console = Console(file=sys.stderr, markup=False, highlight=False, emoji=False)
    columns = (
        MofNCompleteColumn(),
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    return Progress(
        *fitting(columns, console),
        console=console,
        disable=not console.is_terminal,
        transient=True,
    )


def warn(sentence: str) -> None:
    """Say on standard error what is no error, but may be a mistake."""
    print(f"warning: {sentence}", file=sys.stderr)
