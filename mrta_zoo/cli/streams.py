"""Standard output and error that accept any text while a command runs."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from threading import Lock
from typing import Any

_lock = Lock()
_commands = 0
"""How many commands run now, each in a thread of its own."""
_fitted = ExitStack()
"""Restores the streams."""


@contextmanager
def fit_streams() -> Iterator[None]:
    """Within it, standard output and error accept any text, even if the shell has closed them.

    Several threads may be within it at once. When the last one leaves, the streams are as they were.
    """
    global _commands
    with _lock:
        if _commands == 0:
            _fitted.enter_context(_fit("stdout"))
            _fitted.enter_context(_fit("stderr"))
        _commands += 1
    try:
        yield
    finally:
        with _lock:
            _commands -= 1
            if _commands == 0:
                _fitted.close()


@contextmanager
def _fit(name: str) -> Iterator[None]:
    stream = getattr(sys, name)
    if stream is None:  # by >&-
        with open(os.devnull, "w", encoding="utf-8") as stand_in:
            setattr(sys, name, stand_in)
            yield
            setattr(sys, name, None)
    elif hasattr(stream, "reconfigure"):
        errors = stream.errors
        _reconfigure(stream, "replace")  # what the terminal's encoding lacks must not end in a traceback
        yield
        _reconfigure(stream, errors)
    else:
        yield


def _reconfigure(stream: Any, errors: str | None) -> None:
    with suppress(OSError):  # it writes what is left to write, which may have failed before
        stream.reconfigure(errors=errors)
