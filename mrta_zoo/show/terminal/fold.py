"""Text folded for a terminal: lines of a given width in which no word, and so no number, is broken."""

from __future__ import annotations

import shutil
import textwrap

NARROWEST, WIDEST = 40, 100
"""Widths between which help is easy to read, in columns; within these bounds it is as wide as the terminal."""

JOINERS = "\u200c\u200d\u200e\u200f"
"""Characters without a shape of their own that writing needs: joiners of letters or emoji, and marks of direction."""


def spelt_out(text: str) -> str:
    """The text with characters that would control a terminal written as Python escapes."""
    return "".join(c if c.isprintable() or c in "\n\t" or c in JOINERS else ascii(c)[1:-1] for c in text)


def fold(text: str, width: int, indent: str = "") -> list[str]:
    """Lines of at most `width` characters, unless a word is longer; at least one line.

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
    """The width of help, in columns."""
    return min(max(shutil.get_terminal_size().columns, NARROWEST), WIDEST)


def clipped(text: str, width: int) -> str:
    """As many words as there is room for, with an ellipsis if these are not all."""
    if len(text) <= width:
        return text
    words = fold(text, width - 1)[0]
    if words[-1:].isdigit():  # a number must not look cut
        words = fold(text, width - 2)[0] + " "
    return f"{words}…"
