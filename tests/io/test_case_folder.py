"""Folders of cases: all of them or none."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from mrta_zoo.errors import ConfigError, ScenarioError
from mrta_zoo.generators import TaptcGenerator, UniformGenerator
from mrta_zoo.io import read_cases
from mrta_zoo.io.case_folder import write_case_folder
from mrta_zoo.io.formats import FORMATS, FormatName

SCENARIO = UniformGenerator(tasks=(3, 3))(np.random.default_rng(0), "case")


@pytest.mark.parametrize("file_format", ["taptc", "json", "csv"])
def test_a_case_folder_reads_back(tmp_path: Path, file_format: str) -> None:
    rng = np.random.default_rng(1)
    generator = TaptcGenerator(tasks=(3, 9)) if file_format == "taptc" else UniformGenerator(tasks=(3, 9), speed=(1, 2))
    scenarios = [generator(rng, f"case{index}") for index in range(3)]
    write_case_folder(scenarios, tmp_path / "new" / "cases", file_format)  # type: ignore[arg-type]
    assert [case.scenario for case in read_cases(tmp_path / "new" / "cases")] == scenarios


def test_a_case_folder_is_whole_or_absent(tmp_path: Path) -> None:
    def interrupted() -> object:
        yield UniformGenerator(tasks=(2, 2))(np.random.default_rng(0), "first")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_case_folder(interrupted(), tmp_path / "cases", "json")  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


def test_a_case_folder_does_not_touch_what_is_there(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(ConfigError, match="is not empty; expected a new or empty folder"):
        write_case_folder([SCENARIO], tmp_path, "json")
    with pytest.raises(ConfigError, match="is a file; expected a new or empty folder"):
        write_case_folder([SCENARIO], tmp_path / "mine.txt", "json")
    with pytest.raises(ConfigError, match="cannot be made"):
        write_case_folder([SCENARIO], tmp_path / "mine.txt" / "cases", "json")
    assert [file.name for file in tmp_path.iterdir()] == ["mine.txt"]


def test_a_case_folder_in_the_current_one_and_through_a_link(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, written_as in (("here", "."), ("there", "../link")):
        (tmp_path / name).mkdir()
        if name == "there":
            (tmp_path / "link").symlink_to(tmp_path / name)
        monkeypatch.chdir(tmp_path / name)
        write_case_folder([SCENARIO], Path(written_as), "json")
        assert [path.name for path in (tmp_path / name).iterdir()] == [f"{SCENARIO.name}.json"]
    assert (tmp_path / "link").is_symlink()


@pytest.mark.parametrize("exists", [True, False])
def test_errors_of_a_case_folder_name_its_final_place(tmp_path: Path, exists: bool) -> None:
    folder = tmp_path / "cases"
    if exists:
        folder.mkdir()
    fast = UniformGenerator(tasks=(2, 2), speed=2)(np.random.default_rng(0), "fast")
    with pytest.raises(ScenarioError, match=re.escape(f"{folder}/group1/fast.txt: robot 0 has speed 2")):
        write_case_folder([fast], folder, "taptc")
    assert [path.name for path in tmp_path.rglob("*")] == ["cases"] * exists


def test_every_format_has_its_row() -> None:
    assert sorted(get_args(FormatName)) == sorted(form.name for form in FORMATS.values())
