"""The published TAPTC cases, which the project may not ship: tests need them in a folder beside the checkout."""

from __future__ import annotations

from pathlib import Path

import pytest

REAL = Path(__file__).resolve().parents[2] / "shared" / "taptc"

needs_real_cases = pytest.mark.skipif(not REAL.is_dir(), reason=f"no real cases in {REAL}")
