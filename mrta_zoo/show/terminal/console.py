"""Where the command line prints: text as it is, without markup; full width and plain if it is not a terminal.

On a terminal, lines break between words.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from typing import Any, NoReturn

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

from mrta_zoo.show.terminal.fold import fold, spelt_out

PIPED_WIDTH = 1000
"""Columns when piped: wide enough for any table here, so that lines are not folded."""
BAR_WIDTH = 72
"""Columns that a progress bar with times and rates needs."""


class LiteralConsole(Console):
    """A console that prints text as it is: names may look like markup, and control characters in them are spelt out.

    Args:
        options: of rich's `Console`.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__(markup=False, highlight=False, emoji=False, **options)

    def render_str(self, text: str, **options: Any) -> Text:
        """The text, for every string that is printed or stands in a table."""
        return super().render_str(spelt_out(text), **options)

    def on_broken_pipe(self) -> NoReturn:
        """Leave to the command what becomes of a reader that has gone, where rich would end the process."""
        raise  # the BrokenPipeError that is being handled


def results_console() -> LiteralConsole:
    """Standard output, for results."""
    return LiteralConsole(file=sys.stdout, width=None if sys.stdout.isatty() else PIPED_WIDTH)


def messages_console() -> LiteralConsole:
    """Standard error, for progress and remarks."""
    return LiteralConsole(file=sys.stderr)


def say(console: Console, text: str) -> None:
    """Print sentences as they are; on a terminal folded between words, of which one that is too long runs over."""
    for line in text.split("\n"):
        folded = fold(line, console.width) if console.is_terminal else [line]
        for each in folded:
            console.print(Text(spelt_out(each)), soft_wrap=True)


def preparing(what: str = "preparing") -> AbstractContextManager[object]:
    """A sign of life on standard error while methods are made ready, if that is a terminal.

    Args:
        what: is going on.
    """
    console = messages_console()
    if not console.is_terminal:
        return nullcontext()
    # A string would be read as markup here, whatever the console.
    return console.status(Text(f"{what} (local search, if any, is compiled at its first use, which can take a minute)"))


def fitting(columns: Sequence[ProgressColumn], console: Console) -> Sequence[ProgressColumn]:
    """The columns of a progress bar or, where a terminal has no room for them, the first alone."""
    return columns if console.width >= BAR_WIDTH else columns[:1]


def progress_bar() -> Progress:
    """A bar on standard error that goes away when done; nothing at all if that is no terminal."""
    console = messages_console()
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
