"""The Python examples of the README and of the pages in docs/ run as they stand."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from mrta_zoo.io import read_scenario
from mrta_zoo.policies.neural.capam.context import CONTEXT_FEATURES
from mrta_zoo.policies.neural.capam.encoders import ENCODERS
from mrta_zoo.policies.neural.capam.node_features import NODE_FEATURES
from mrta_zoo.policies.registry import METHODS

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
PAGES = [README, *sorted((ROOT / "docs").glob("*.md"))]
OTHER_LIBRARIES = re.compile(r"(rllib|torchrl|stable_baselines3|sb3|supersuit|tianshou)(_|\b)")
ALL_BLOCKS = [
    pytest.param(page, block, id=f"{page.stem}-{number}")
    for page in PAGES
    for number, block in enumerate(re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL))
]
BLOCKS = [each for each in ALL_BLOCKS if not OTHER_LIBRARIES.search(str(each.values[1]))]
"""The others run in tests/integrations."""


@pytest.fixture
def nothing_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Examples write where they are, and register what other tests should not find."""
    monkeypatch.chdir(tmp_path)
    registries: list[dict[str, Any]] = [NODE_FEATURES, CONTEXT_FEATURES, ENCODERS, METHODS]  # type: ignore[list-item]
    before = [dict(registry) for registry in registries]
    yield
    for registry, entries in zip(registries, before, strict=True):
        registry.clear()
        registry.update(entries)


def test_there_are_examples() -> None:
    assert len(BLOCKS) >= 12


@pytest.mark.usefixtures("nothing_stays")
@pytest.mark.parametrize(("page", "block"), BLOCKS)
def test_example_runs(page: Path, block: str, capsys: pytest.CaptureFixture[str]) -> None:
    exec(compile(block, str(page), "exec"), {"__name__": "readme"})
    assert "error:" not in capsys.readouterr().err  # what the command line says where Python raises


@pytest.mark.parametrize("language", ["json", "csv"])
def test_example_files_are_read(language: str, tmp_path: Path) -> None:
    (text,) = re.findall(rf"```{language}\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    (tmp_path / f"mission.{language}").write_text(text, encoding="utf-8")
    scenario = read_scenario(tmp_path / f"mission.{language}")
    assert (scenario.num_tasks, scenario.speed.tolist()) == (2, [1, 1.5])
