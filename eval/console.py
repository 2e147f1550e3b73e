"""Where the command line prints: full width and plain if it is not a terminal."""

from __future__ import annotations

import sys
from contextlib import AbstractContextManager, nullcontext

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

PIPED_WIDTH = 1000
"""Columns when piped: wide enough for any table here, so that lines are not folded."""


def results_console() -> Console:
    """Standard output, for results. Text is printed as it is: no markup, no highlighting."""
    width = None if sys.stdout.isatty() else PIPED_WIDTH
    return Console(file=sys.stdout, width=width, markup=False, highlight=False, emoji=False)


def preparing(what: str = "preparing") -> AbstractContextManager[object]:
    """A sign of life on standard error while methods are made ready, if that is a terminal.

    Args:
        what: is going on.
    """
    console = Console(file=sys.stderr, markup=False, highlight=False, emoji=False)
    if not console.is_terminal:
        return nullcontext()
    return console.status(f"{what} (local search, if any, is compiled at its first use, which can take a minute)")


def progress_bar() -> Progress:
    """A bar on standard error that goes away when done; nothing at all if that is no terminal."""
    console = Console(file=sys.stderr, markup=False, highlight=False, emoji=False)
    return Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
        console=console,
        disable=not console.is_terminal,
        transient=True,
    )


def warn(sentence: str) -> None:
    """Say on standard error what is no error, but may be a mistake."""
    print(f"warning: {sentence}", file=sys.stderr)
