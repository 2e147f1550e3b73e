"""Input files for tests of several commands."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import SCENARIO

from mrta_zoo.cli.main import main
from mrta_zoo.io import write_scenario


@pytest.fixture(scope="module")
def cases(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of three small TAPTC cases."""
    folder = tmp_path_factory.mktemp("data") / "cases"
    assert main(["generate", "--count", "3", "--tasks", "12", "--robots", "2-3", "--out", str(folder)]) == 0
    return folder


@pytest.fixture
def mission(tmp_path: Path) -> str:
    """A file that holds `SCENARIO`."""
    write_scenario(SCENARIO, tmp_path / "mission.json")
    return str(tmp_path / "mission.json")
