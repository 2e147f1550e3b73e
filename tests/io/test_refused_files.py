"""Files that cannot be opened, that never end, or that are named badly."""

import os
from pathlib import Path

import pytest
from sentences import check_sentence
from valid_files import SCENARIO, TABLE, TASKS

from mrta_zoo import Plan
from mrta_zoo.errors import PlanError, ScenarioError
from mrta_zoo.io import read_cases, read_scenario, write_plan


def test_agents_cannot_be_json(tmp_path: Path) -> None:
    (tmp_path / "cas.txt").write_text(TASKS)
    with pytest.raises(ScenarioError, match=r"'\.json'; expected a TAPTC agent file, or \.csv"):
        read_scenario(tmp_path / "cas.txt", tmp_path / "bots.json")


@pytest.mark.parametrize("suffix", [".txt", ".json", ".csv"])
def test_file_that_cannot_be_read(tmp_path: Path, suffix: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        read_scenario(tmp_path / f"missing{suffix}", tmp_path / "agents.txt")
    check_sentence(caught.value, f"missing{suffix}: there is no such file")
    (tmp_path / f"folder{suffix}").mkdir()
    with pytest.raises(ScenarioError) as caught:
        read_scenario(tmp_path / f"folder{suffix}")
    check_sentence(caught.value, f"folder{suffix} is a folder; expected a file")
    with pytest.raises(ScenarioError) as caught:
        read_scenario(f"nul\0l{suffix}")
    check_sentence(caught.value, f"nul\\0l{suffix} cannot be read")
    with pytest.raises(ScenarioError) as caught:
        read_scenario("x" * 300 + suffix)
    assert "cannot be read" in str(caught.value)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_no_permission(tmp_path: Path) -> None:
    path = tmp_path / "cas.json"
    path.write_text(SCENARIO)
    path.chmod(0)
    with pytest.raises(ScenarioError) as caught:
        read_scenario(path)
    check_sentence(caught.value, "cas.json: no permission")


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no endless file here")
def test_endless_file() -> None:
    with pytest.raises(ScenarioError) as caught:
        read_scenario("/dev/zero")
    check_sentence(caught.value, "/dev/zero is larger than 64 MiB")


def test_names_with_control_characters(tmp_path: Path) -> None:
    (tmp_path / "a\x1bb.csv").write_text(TABLE)
    with pytest.raises(ScenarioError, match=r"the scenario's name is 'a\\x1bb'; expected text without control"):
        read_scenario(tmp_path / "a\x1bb.csv")
    (tmp_path / "a\x1bb.csv").rename(tmp_path / "cas.csv")
    reference = tmp_path / "reference.csv"
    for text in ("case,tasks,robots,me\x1b\ncas,2,1,1\n", "case,tasks,robots,me\ncas\x1b,2,1,1\n"):
        reference.write_text(text)
        with pytest.raises(ScenarioError, match=r"reference\.csv, line .*\\x1b'; expected text without control"):
            read_cases(tmp_path)
    with pytest.raises(PlanError, match="method is 'a\\\\tb'; expected text without control characters"):
        write_plan(Plan.of([[0]], "cas", "a\tb"), tmp_path / "plan.json")
