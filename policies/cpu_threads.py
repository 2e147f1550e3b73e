"""The number of CPU threads that trained networks use.

The networks are small. With one thread per core, torch's default, a decision can take twenty times as long as with one
thread while other programs run.
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
"""Environment variables by which users set the number of torch's threads."""

_chosen: ContextVar[int | None] = ContextVar("chosen", default=None)

_lock = Lock()
_blocks: list[tuple[int, int]] = []
"""The Python threads inside a block, each with the number of torch's threads there."""
_usual = 1
"""The number of torch's threads before the first block."""


@contextmanager
def cpu_threads(count: int) -> Iterator[None]:
    """Inside the block torch uses `count` threads, and so do the policies and trainers of this package.

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
    """Inside the block torch uses one thread, best for small networks, unless `cpu_threads` or `VARIABLES` set it."""
    count = _chosen.get()
    if count is None and any(name in os.environ for name in VARIABLES):
        yield
        return
    with _torch_threads(count or 1):
        yield


@contextmanager
def _torch_threads(count: int) -> Iterator[None]:
    """Inside the block torch uses this many threads in the current Python thread.

    torch's setting also applies to Python threads that first use torch later. Such a thread, if it begins within
    another's block, finds that block's number; when its own block ends, it gets the number from before the blocks.
    """
    global _usual
    torch = sys.modules.get("torch")  # not imported here: heuristics don't need it
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
