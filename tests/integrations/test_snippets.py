"""The README's examples that need another library run as they stand."""

from __future__ import annotations

import pytest
from test_readme import ALL_BLOCKS, BLOCKS, README

OTHERS = [block for block in ALL_BLOCKS if block not in BLOCKS]
pytestmark = [pytest.mark.integrations, pytest.mark.filterwarnings("ignore")]


def test_there_is_one_for_each_library() -> None:
    assert len(OTHERS) == 5


@pytest.mark.parametrize("block", OTHERS, ids=range(len(OTHERS)))
def test_example_runs(block: str) -> None:
    exec(compile(block, str(README), "exec"), {"__name__": "readme"})
