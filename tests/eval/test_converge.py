"""``mrta-zoo converge``: quality against time."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from mrta_zoo.cli.converge import seconds_of
from mrta_zoo.cli.main import main
from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.converge.curves import BudgetRow, curves_of, draw_curves
from mrta_zoo.eval.converge.experiment import every_of_each_size
from mrta_zoo.io import Case
from mrta_zoo.suite import builtin_suite


def row(case: int, method: str, budget: float | None, completed: int, seconds: float, robots: int = 2) -> BudgetRow:
    return BudgetRow(f"c{case}", method, 100, robots, completed, completed / 100, 0, 0, 0, seconds, budget)


def test_curves_are_means_at_measured_times() -> None:
    rows = [row(case, "ils", 0.1, 40 + case, 0.2 + 0.1 * case) for case in range(5)]
    rows += [row(case, "nearest", None, 30, 0.01) for case in range(5)]
    curves = curves_of(rows, [("nearest", None), ("ils", 0.1), ("ils", 1.0)], seed=0)
    nearest, ils = curves.to_dict("records")
    # (40 + 41 + 42 + 43 + 44) / 5 = 42 % after (0.2 + 0.3 + 0.4 + 0.5 + 0.6) / 5 = 0.4 s, though 0.1 s were allowed.
    assert (ils["mean_percent"], ils["mean_seconds"], ils["budget"]) == pytest.approx((42, 0.4, 0.1))
    assert 40 < ils["low"] < 42 < ils["high"] < 44
    assert (nearest["mean_percent"], nearest["low"], nearest["high"], nearest["note"]) == (30, 30, 30, "all equal")


def test_budgets_make_a_line_and_methods_without_one_a_point() -> None:
    rows = [row(0, "ils", budget, 40 + index, budget) for index, budget in enumerate((0.1, 1.0, 10.0))]
    rows.append(row(0, "nearest", None, 30, 0.01))
    order = [("nearest", None), *(("ils", budget) for budget in (0.1, 1.0, 10.0))]
    (axes,) = draw_curves(curves_of(rows, order, seed=0)).axes
    drawn = {tuple(line.get_xdata()): tuple(line.get_ydata()) for line in axes.lines if len(line.get_xdata())}
    assert drawn == {(0.1, 1.0, 10.0): (40, 41, 42), (0.01,): (30,)}
    assert axes.get_xscale() == "log"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["ils", "nearest, no budget"]


def test_every_so_many_cases_of_each_size() -> None:
    cases = [Case(scenario.name, scenario) for scenario in builtin_suite()]
    chosen = every_of_each_size(cases, 8)
    assert [case.scenario.num_robots for case in chosen].count(7) == 3
    assert len(chosen) == 96 / 8
    assert every_of_each_size(cases, 1) == cases
    with pytest.raises(ConfigError, match="every is 0"):
        every_of_each_size(cases, 0)


def test_budgets() -> None:
    assert seconds_of("3,0.1, 1") == [0.1, 1, 3]
    for text in ("0", "1,x", "inf", "nan", "-1"):
        with pytest.raises(ConfigError, match="expected numbers of seconds > 0"):
            seconds_of(text)


def test_the_command_draws_and_resumes(tmp_path: Path) -> None:
    cases, out = str(tmp_path / "cases"), tmp_path / "out"
    assert main(["generate", "--count", "5", "--tasks", "6", "--robots", "2", "--out", cases]) == 0
    flags = ["converge", "--cases", cases, "--methods", "capam-plus", "--points", "nearest", "--out", str(out)]
    assert main([*flags, "--budgets", "0.01,0.05"]) == 0
    assert {path.name for path in out.glob("[!.]*")} == {
        "manifest.json", "rows.csv", "sessions.csv", "report.md", "report.html", "curves.csv", "curves.png",
        "curves.svg",
    }  # fmt: skip
    whole = (out / "rows.csv").read_text()
    assert [line["budget"] for line in csv.DictReader(whole.splitlines())] == [""] * 5 + ["0.01"] * 5 + ["0.05"] * 5
    (out / "rows.csv").write_text(whole[: whole.rindex("capam-plus") + 3])
    assert main([*flags, "--budgets", "0.01,0.05"]) == 0
    resumed = (out / "rows.csv").read_text()
    assert resumed.splitlines()[:-1] == whole.splitlines()[:-1]
    assert resumed.count("\n") == whole.count("\n")
