"""How many CPU threads trained networks may use while they are timed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from mrta_zoo.errors import ConfigError


@contextmanager
def cpu_threads(count: int) -> Iterator[None]:
    """Within it torch uses `count` threads, >= 1. Without torch, or before it is imported, nothing happens.

    Raises:
        ConfigError: if the number is out of range.
    """
    if count < 1:
        raise ConfigError(f"threads is {count}; expected a whole number >= 1")
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
