"""Skipping tests of methods whose extra is not installed."""

from __future__ import annotations

import pytest

from mrta_zoo import extras
from mrta_zoo.policies.registry import METHODS


def skip_unless_installed(name: str) -> None:
    """Skip the test if the extra of this method is not installed."""
    extra = METHODS[name].extra
    for module in extras.EXTRAS[extra] if extra else ():
        pytest.importorskip(module)
