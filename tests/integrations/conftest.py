"""These tests need the extra `integrations`, in an environment of its own: ``make test-integrations``."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec

import pytest

LIBRARIES = ("ray", "torchrl", "sb3_contrib", "supersuit", "tianshou")
collect_ignore_glob = [] if all(find_spec(library) for library in LIBRARIES) else ["test_*.py"]


@pytest.fixture(scope="session")
def cluster() -> Iterator[None]:
    """Ray, started once; tried again, as its limit of 30 seconds is short on a busy machine."""
    import ray

    for attempt in range(4):
        try:
            ray.init(include_dashboard=False, log_to_driver=False, logging_level="ERROR")
            break
        except Exception:
            ray.shutdown()
            if attempt == 3:
                raise
    yield
    ray.shutdown()
