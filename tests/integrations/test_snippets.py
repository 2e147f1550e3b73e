"""The README's examples that need another library run as they stand."""

from __future__ import annotations

from pathlib import Path

import pytest
from test_readme import ALL_BLOCKS, BLOCKS

OTHERS = [block for block in ALL_BLOCKS if block not in BLOCKS]
pytestmark = [pytest.mark.integrations, pytest.mark.filterwarnings("ignore")]


def test_there_is_one_for_each_library() -> None:
    assert len(OTHERS) == 5


@pytest.mark.parametrize(("page", "block"), OTHERS)
def test_example_runs(page: Path, block: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    exec(compile(block, str(page), "exec"), {"__name__": "readme"})
