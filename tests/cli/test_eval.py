"""The command ``mrta-zoo eval``."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from command_line import Captured
from real_cases import REAL, needs_real_cases

from mrta_zoo.cli.main import main
from mrta_zoo.io import read_cases


def test_eval_prints_tables_and_writes_rows(cases: Path, tmp_path: Path, capsys: Captured) -> None:
    out = tmp_path / "rows.csv"
    assert main(["eval", "--cases", str(cases), "--methods", "random, nearest", "--out", str(out)]) == 0
    output = capsys.readouterr()
    rows = list(csv.DictReader(out.read_text().splitlines()))
    names = [case.name for case in read_cases(cases)]
    assert [(row["method"], row["case"]) for row in rows] == [
        (m, name) for m in ("random", "nearest") for name in names
    ]
    assert "Tasks completed, mean %" in output.out
    assert "best known" not in output.out
    assert output.err == ""  # no progress bar where there is no terminal


def test_eval_uses_the_reference(cases: Path, capsys: Captured) -> None:
    reference = cases / "reference.csv"
    lines = [f"{c.name},{c.scenario.num_tasks},{c.scenario.num_robots},1,2" for c in read_cases(cases)]
    reference.write_text("\n".join(["case,tasks,robots,nearest,best", *lines]))
    try:
        assert main(["eval", "--cases", str(cases), "--methods", "nearest"]) == 0
        assert "Share of the best known plan's tasks, mean %" in capsys.readouterr().out
    finally:
        reference.unlink()


def test_eval_on_the_builtin_suite(tmp_path: Path, capsys: Captured) -> None:
    out = tmp_path / "rows.csv"
    assert main(["eval", "--cases", "builtin", "--methods", "nearest", "--out", str(out)]) == 0
    assert len(out.read_text().splitlines()) == 97
    assert "96" in capsys.readouterr().out


@needs_real_cases
def test_eval_on_real_cases(tmp_path: Path, capsys: Captured) -> None:
    assert main(["eval", "--cases", str(REAL / "n100"), "--methods", "nearest"]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    # Of the `nearest` column of reference.csv the mean is 54.6 %.
    assert ["all", "32", "54.6"] in lines


def test_an_interrupted_evaluation_writes_nothing(
    cases: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    def interrupted(*args: object) -> object:
        raise KeyboardInterrupt

    monkeypatch.setattr("mrta_zoo.eval.progress.evaluate", interrupted)
    arguments = ["eval", "--cases", str(cases), "--methods", "nearest", "--out", str(tmp_path / "rows.csv")]
    assert main(arguments) == 130
    assert capsys.readouterr().err == "interrupted\n"
    assert list(tmp_path.iterdir()) == []
