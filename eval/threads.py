"""How many CPU threads trained networks may use while they are timed."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from mrta_zoo.bounds import check_threads


@contextmanager
def cpu_threads(count: int) -> Iterator[None]:
    """Within it torch uses `count` threads. Without torch, or before its import, nothing happens.

    Raises:
        ConfigError: if the number is out of range.
    """
    check_threads(count, least=1)
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
