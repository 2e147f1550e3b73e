"""Help that is easy to read at any width of the terminal.

It is tyro's. But tyro keeps line breaks of the source before lines that begin with a quote, bracket, dash or digit,
does not wrap the description, and has no greatest width.
"""

from __future__ import annotations

import inspect
import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from dataclasses import fields, is_dataclass
from io import StringIO
from types import MappingProxyType
from typing import Any, TextIO, get_type_hints

import docstring_parser
from rich.console import Console
from rich.text import Text

from mrta_zoo.show.terminal.fold import help_width


def description_of(command: Callable[..., object]) -> str:
    """The description of a command, one line per paragraph."""
    return _unfolded(docstring_parser.parse_from_object(command).description or "")


def unfold_fields(of: Any) -> None:
    """Give the fields of a dataclass their docstrings without line breaks, as metadata, which tyro prefers."""
    if not is_dataclass(of):
        return
    texts = {each.arg_name: each.description for each in docstring_parser.parse_from_object(of).params}
    hints = get_type_hints(of)
    for field in fields(of):
        unfold_fields(hints[field.name])
        if text := texts.get(field.name):
            field.metadata = MappingProxyType({**field.metadata, "help": _unfolded(text)})


def _unfolded(text: str) -> str:
    """The text without line breaks, except before empty or indented lines."""
    return re.sub(r"(?<=\S)\n(?=\S)", " ", inspect.cleandoc(text))


@contextmanager
def readable_help() -> Iterator[None]:
    """Within it, help is printed in `help_width` columns. Lines that are still too long break between words."""
    stream, width, columns = sys.stdout, help_width(), os.environ.get("COLUMNS")
    os.environ["COLUMNS"] = str(width)
    printed = _Kept(stream)
    try:
        with redirect_stdout(printed):
            yield
    finally:
        if columns is None:
            del os.environ["COLUMNS"]
        else:
            os.environ["COLUMNS"] = columns
        if text := printed.getvalue().removesuffix("\n"):
            Console(file=stream, width=width).print(Text.from_ansi(text))


class _Kept(StringIO):
    """Keeps what is printed, and looks like the stream that it will go to."""

    def __init__(self, stream: TextIO) -> None:
        super().__init__()
        self._stream = stream

    @property
    def encoding(self) -> str:  # type: ignore[override]
        return self._stream.encoding

    def isatty(self) -> bool:
        return self._stream.isatty()
