"""Whether a file can be written is told before the work, as it is decided after it."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.atomic import replacing
from mrta_zoo.io.destination import check_destination

ORDINARY = not hasattr(os, "geteuid") or os.geteuid() != 0  # root may write anywhere


@pytest.mark.parametrize(
    ("name", "complaint"),
    [
        ("new", ""),
        ("there", ""),
        ("link", ""),
        ("dangling", ""),
        ("/dev/null", ""),
        ("folder", "is a folder"),
        ("to-folder", "is a folder"),
        ("circle", "symbolic links"),
        ("nowhere", "absent does not exist"),
        ("absent/new", "absent does not exist"),
        ("there/new", "there is not a folder"),
        ("x" * 300, "name too long"),
        ("null\0character", "null"),
        pytest.param("read-only", "permission", marks=pytest.mark.skipif(not ORDINARY, reason="root")),
        pytest.param("closed/new", "permission", marks=pytest.mark.skipif(not ORDINARY, reason="root")),
        pytest.param("closed/there", "", marks=pytest.mark.skipif(not ORDINARY, reason="root")),
    ],
)
def test_it_is_refused_if_and_only_if_it_cannot_be_written(tmp_path: Path, name: str, complaint: str) -> None:
    for folder in ("folder", "closed"):
        (tmp_path / folder).mkdir()
    for file in ("there", "read-only", "closed/there"):
        (tmp_path / file).write_text("old")
    (tmp_path / "read-only").chmod(0o444)
    (tmp_path / "closed").chmod(0o555)
    links = {"link": "there", "dangling": "new", "to-folder": "folder", "circle": "circle", "nowhere": "absent/new"}
    for link, target in links.items():
        (tmp_path / link).symlink_to(target)
    path = tmp_path / name
    if not complaint:
        check_destination(path)
        with replacing(path) as partial:
            partial.write_text("new")
        return
    with pytest.raises(ConfigError, match=complaint):
        check_destination(path)
    with pytest.raises((OSError, ValueError)), replacing(path) as partial:
        partial.write_text("new")


def test_where_results_are_printed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with (tmp_path / "log").open("w") as log:
        monkeypatch.setattr("sys.stdout", log)
        with pytest.raises(ConfigError, match="log is where standard output goes; expected a file of its own"):
            check_destination(tmp_path / "log")
