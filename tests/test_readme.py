"""The README's Python examples run as they stand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mrta_zoo.io import read_scenario

README = Path(__file__).parents[1] / "README.md"
BLOCKS = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)


def test_there_are_examples() -> None:
    assert len(BLOCKS) >= 4


@pytest.mark.parametrize("block", BLOCKS, ids=range(len(BLOCKS)))
def test_example_runs(block: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # some write files
    exec(compile(block, str(README), "exec"), {"__name__": "readme"})


@pytest.mark.parametrize("language", ["json", "csv"])
def test_example_files_are_read(language: str, tmp_path: Path) -> None:
    (text,) = re.findall(rf"```{language}\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    (tmp_path / f"mission.{language}").write_text(text, encoding="utf-8")
    scenario = read_scenario(tmp_path / f"mission.{language}")
    assert (scenario.num_tasks, scenario.speed.tolist()) == (2, [1, 1.5])


def test_links_lead_somewhere() -> None:
    for target in re.findall(r"\]\((?!https?://|#)([^)]+)\)", README.read_text(encoding="utf-8")):
        assert (README.parent / target).exists(), f"README links to {target}, which does not exist"
