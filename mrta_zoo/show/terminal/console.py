"""Consoles of the command line: text printed literally, plain and at full width if they are not terminals.

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
    """A console that prints text literally: names may look like markup, and control characters in them are spelt out.

    Args:
        options: of rich's `Console`.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__(markup=False, highlight=False, emoji=False, **options)

    def render_str(self, text: str, **options: Any) -> Text:
        """The text of every string that is printed or stands in a table."""
        return super().render_str(spelt_out(text), **options)

    def on_broken_pipe(self) -> NoReturn:
        """Let the command handle a reader that has gone, where rich would end the process."""
        raise  # the BrokenPipeError that is being handled


def results_console() -> LiteralConsole:
    """Standard output, for results."""
    return LiteralConsole(file=sys.stdout, width=None if sys.stdout.isatty() else PIPED_WIDTH)


def messages_console() -> LiteralConsole:
    """Standard error, for progress and remarks."""
    return LiteralConsole(file=sys.stderr)


def say(console: Console, text: str) -> None:
    """Print sentences literally; on a terminal, lines break between words, and a word that is too long runs over."""
    for line in text.split("\n"):
        folded = fold(line, console.width) if console.is_terminal else [line]
        for each in folded:
            console.print(Text(spelt_out(each)), soft_wrap=True)


def preparing(what: str = "preparing") -> AbstractContextManager[object]:
    """A sign of life on standard error while methods are made ready, if that is a terminal.

    Args:
        what: what is going on.
    """
    console = messages_console()
    if not console.is_terminal:
        return nullcontext()
    # A string would be read as markup here, whatever the console.
    return console.status(Text(f"{what} (local search, if any, is compiled at its first use, which can take a minute)"))


def fitting(columns: Sequence[ProgressColumn], console: Console) -> Sequence[ProgressColumn]:
    """The columns of a progress bar or, if a terminal has no room for them, only the first."""
    return columns if console.width >= BAR_WIDTH else columns[:1]


def progress_bar() -> Progress:
    """A bar on standard error that disappears when done; nothing at all if that is not a terminal."""
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
    """Warn on standard error of something that may be a mistake."""
    print(f"warning: {sentence}", file=sys.stderr)
