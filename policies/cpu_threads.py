"""How many CPU threads trained networks use.

The networks here are small: with as many threads as there are cores, torch's default, a decision can take twenty times
as long as with one thread if other programs are at work.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from threading import Lock, get_ident

from mrta_zoo.bounds import check_threads

VARIABLES = ("OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""Of the environment, by which users say how many threads torch shall have."""

_chosen: ContextVar[int | None] = ContextVar("chosen", default=None)

_lock = Lock()
_blocks: list[tuple[int, int]] = []
"""The Python threads that are in a block now, each with its number of threads."""
_usual = 1
"""What torch used before the first of them."""


@contextmanager
def cpu_threads(count: int) -> Iterator[None]:
    """Within it torch uses `count` threads, and so do the policies and trainers of this package.

    Raises:
        ConfigError: if the number is out of range.
    """
    check_threads(count, least=1)
    before = _chosen.get()
    _chosen.set(count)
    try:
        with _torch_threads(count):
            yield
    finally:
        _chosen.set(before)


@contextmanager
def few_threads() -> Iterator[None]:
    """Within it torch uses one thread, unless `cpu_threads` or one of `VARIABLES` says how many; for small networks."""
    count = _chosen.get()
    if count is None and any(name in os.environ for name in VARIABLES):
        yield
        return
    with _torch_threads(count or 1):
        yield


@contextmanager
def _torch_threads(count: int) -> Iterator[None]:
    """Within it torch uses so many threads for the Python thread that is in it.

    What torch is told also counts for Python threads that first use torch later. So one that begins within another's
    block finds the number of that block, and is given what was there before instead.
    """
    global _usual
    torch = sys.modules.get("torch")  # heuristics need none, so it is not imported for them
    if torch is None:
        yield
        return
    block = get_ident(), count
    with _lock:
        before = torch.get_num_threads()
        if not _blocks:
            _usual = before
        elif all(thread != block[0] for thread, _ in _blocks) and any(before == other for _, other in _blocks):
            before = _usual
        _blocks.append(block)
        torch.set_num_threads(count)
    try:
        yield
    finally:
        with _lock:
            _blocks.remove(block)
            torch.set_num_threads(before)
