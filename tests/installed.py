"""Which methods can be tried here: each needs what its extra brings."""

from __future__ import annotations

import pytest

from mrta_zoo import extras
from mrta_zoo.policies.registry import METHODS


def skip_unless_installed(name: str) -> None:
    """Skip the test if what a method needs is not installed."""
    extra = METHODS[name].extra
    for module in extras.EXTRAS[extra] if extra else ():
        pytest.importorskip(module)
