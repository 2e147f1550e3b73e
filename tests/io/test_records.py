"""Dataclasses as CSV: what was written is read back, and nothing else is."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.records import read_records, write_records


@dataclass(frozen=True, slots=True)
class Record:
    name: str
    tasks: int
    cost: float
    done: bool


HEADER = "name,tasks,cost,done\n"
PRINTABLE = st.text(st.characters(exclude_categories=["Cs", "Cc"]))
RECORDS = st.builds(Record, PRINTABLE, st.integers(), st.floats(allow_nan=False, allow_infinity=False), st.booleans())


@given(st.lists(RECORDS, min_size=1))
def test_read_is_what_was_written(tmp_path_factory: pytest.TempPathFactory, records: list[Record]) -> None:
    path = tmp_path_factory.mktemp("records") / "records.csv"
    write_records(records, path)
    assert read_records(path, Record) == records


def test_the_file_is_plain_csv(tmp_path: Path) -> None:
    path = tmp_path / "records.csv"
    write_records([Record('a,"b', 3, 0.1, True), Record(" c ", -1, 1e-300, False)], path)
    assert path.read_bytes() == b'name,tasks,cost,done\n"a,""b",3,0.1,True\n c ,-1,1e-300,False\n'
    path.write_text(HEADER)
    assert read_records(path, Record) == []


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (None, r"records\.csv: there is no such file"),
        ("", r"records\.csv is empty; expected a scenario, a plan or a table"),
        ("name,tasks\na,1\n", "line 1: header is 'name,tasks'; expected name,tasks,cost,done"),
        ("tasks,name,cost,done\n1,a,2,True\n", "line 1: header is 'tasks,name,cost,done'; expected name,tasks"),
        (HEADER + "a,1,2,True\na,1,2\n", "line 3: 'a,1,2' has 3 cells; expected 4 as in the header"),
        (HEADER + "a,1.5,2,True\n", r"line 2: tasks is '1\.5'; expected a whole number"),
        (HEADER + "a,,2,True\n", "line 2: tasks is ''; expected a whole number"),
        (HEADER + "a,1,two,True\n", "line 2: cost is 'two'; expected a finite number"),
        (HEADER + "a,1,nan,True\n", "line 2: cost is 'nan'; expected a finite number"),
        (HEADER + "a,1,2,yes\n", "line 2: done is 'yes'; expected True or False"),
        (HEADER + 'a,1,2,True\n"a,1,2,True\n', "line 3: .*; expected cells separated by commas"),
    ],
)
def test_what_is_none_is_refused(tmp_path: Path, text: str | None, sentence: str) -> None:
    path = tmp_path / "records.csv"
    if text is not None:
        path.write_text(text)
    with pytest.raises(ConfigError, match=sentence):
        read_records(path, Record)


def test_nothing_is_no_table(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="there are no rows; expected at least one"):
        write_records([], tmp_path / "records.csv")
    assert not list(tmp_path.iterdir())
