"""How many CPU threads trained networks may use while they are timed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from mrta_zoo.errors import ConfigError

MOST_THREADS = 1024
"""More than any machine has use for; torch fails with as many threads as the system cannot start."""


@contextmanager
def cpu_threads(count: int) -> Iterator[None]:
    """Within it torch uses `count` threads, 1 to `MOST_THREADS`. Without torch, or before its import, nothing happens.

    Raises:
        ConfigError: if the number is out of range.
    """
    if not 1 <= count <= MOST_THREADS:
        raise ConfigError(f"threads is {count}; expected a whole number from 1 to {MOST_THREADS}")
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
