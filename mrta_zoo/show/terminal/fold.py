"""Text fit for a terminal: in lines of a given width, in which no word, and so no number, is broken."""

from __future__ import annotations

import shutil
import textwrap

NARROWEST, WIDEST = 40, 100
"""Columns between which help is easy to read; it has those of the terminal within these bounds."""

JOINERS = "\u200c\u200d\u200e\u200f"
"""Characters without a shape of their own that writing needs: joiners of letters or emoji, and marks of direction."""


def spelt_out(text: str) -> str:
    """The text with what would steer a terminal in the form that it has in Python."""
    return "".join(c if c.isprintable() or c in "\n\t" or c in JOINERS else ascii(c)[1:-1] for c in text)


def fold(text: str, width: int, indent: str = "") -> list[str]:
    """Lines of so many characters at most, unless a word is longer; one at least.

    Args:
        text: one line.
        width: of the lines, >= 1.
        indent: put before all lines but the first.
    """
    return textwrap.wrap(
        text, max(width, 1), subsequent_indent=indent, replace_whitespace=False, break_long_words=False,
        break_on_hyphens=False,
    ) or [""]  # fmt: skip


def help_width() -> int:
    """Columns for help."""
    return min(max(shutil.get_terminal_size().columns, NARROWEST), WIDEST)


def clipped(text: str, width: int) -> str:
    """As many words as there is room for, with a mark if these are not all."""
    if len(text) <= width:
        return text
    words = fold(text, width - 1)[0]
    if words[-1:].isdigit():  # which must not look cut
        words = fold(text, width - 2)[0] + " "
    return f"{words}…"
