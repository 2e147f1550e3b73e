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

from mrta_zoo.bounds import check_threads

VARIABLES = ("OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""Of the environment, by which users say how many threads torch shall have."""

_chosen: ContextVar[int | None] = ContextVar("chosen", default=None)


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
    torch = sys.modules.get("torch")  # heuristics need none, so it is not imported for them
    if torch is None:
        yield
        return
    before = torch.get_num_threads()
    torch.set_num_threads(count)
    try:
        yield
    finally:
        torch.set_num_threads(before)
