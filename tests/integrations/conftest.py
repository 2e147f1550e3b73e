"""These tests need the extra `integrations`, in an environment of its own: ``make test-integrations``."""

from __future__ import annotations

from importlib.util import find_spec

LIBRARIES = ("ray", "torchrl", "sb3_contrib", "supersuit", "tianshou")
collect_ignore_glob = [] if all(find_spec(library) for library in LIBRARIES) else ["test_*.py"]
