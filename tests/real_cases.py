"""The published TAPTC cases, which are not the project's to ship: tests on them run where they lie beside it."""

from __future__ import annotations

from pathlib import Path

import pytest

REAL = Path(__file__).resolve().parents[2] / "shared" / "taptc"

needs_real_cases = pytest.mark.skipif(not REAL.is_dir(), reason=f"no real cases in {REAL}")
