"""Standard output and error that take any text, as long as a command runs."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from threading import Lock
from typing import Any

_lock = Lock()
_fit: dict[Any, tuple[int, Callable[[], None]]] = {}
"""Each stream that was made fit: how many commands use it, and what makes it as it was."""


@contextmanager
def fit_streams() -> Iterator[None]:
    """Standard output and error are fit for any text meanwhile, also where the shell has closed them.

    Several threads may be in this at a time; the streams are as they were when the last has left it.
    """
    with _lock:
        streams = [_take("stdout"), _take("stderr")]
    try:
        yield
    finally:
        with _lock:
            for stream in streams:
                _give_back(stream)


def _take(name: str) -> Any:
    """The stream of that name, now fit."""
    if (stream := getattr(sys, name)) in _fit:
        users, restore = _fit[stream]
    else:
        users, stream, restore = 0, *_make_fit(name)
    _fit[stream] = users + 1, restore
    return stream


def _give_back(stream: Any) -> None:
    users, restore = _fit.pop(stream)
    if users > 1:
        _fit[stream] = users - 1, restore
    else:
        restore()


def _make_fit(name: str) -> tuple[Any, Callable[[], None]]:
    """The stream of that name, or what stands in for it, and what makes it as it was."""
    stream = getattr(sys, name)
    if stream is None:  # by >&-
        stand_in = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
        setattr(sys, name, stand_in)
        return stand_in, partial(_close, name, stand_in)
    if hasattr(stream, "reconfigure"):
        restore = partial(_reconfigure, stream, stream.errors)
        _reconfigure(stream, "replace")  # what the terminal's encoding lacks must not end in a traceback
        return stream, restore
    return stream, lambda: None


def _close(name: str, stand_in: Any) -> None:
    setattr(sys, name, None)
    stand_in.close()


def _reconfigure(stream: Any, errors: str | None) -> None:
    with suppress(OSError):  # it writes what is left to write, which may have failed before
        stream.reconfigure(errors=errors)
