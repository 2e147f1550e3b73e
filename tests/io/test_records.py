"""Dataclasses as CSV."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.records import write_records


@dataclass(frozen=True, slots=True)
class Record:
    name: str
    tasks: int
    cost: float
    done: bool


def test_the_file_is_plain_csv(tmp_path: Path) -> None:
    path = tmp_path / "records.csv"
    write_records([Record('a,"b', 3, 0.1, True), Record(" c ", -1, 1e-300, False)], path)
    assert path.read_bytes() == b'name,tasks,cost,done\n"a,""b",3,0.1,True\n c ,-1,1e-300,False\n'


def test_nothing_is_no_table(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="there are no rows; expected at least one"):
        write_records([], tmp_path / "records.csv")
    assert not list(tmp_path.iterdir())
    write_records([], tmp_path / "records.csv", Record)
    assert (tmp_path / "records.csv").read_text() == "name,tasks,cost,done\n"
