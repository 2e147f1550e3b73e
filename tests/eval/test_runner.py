"""Methods on cases: rows, tables, and the files they go to."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from mrta_zoo.errors import PlanError
from mrta_zoo.eval.rows import Row
from mrta_zoo.eval.runner import evaluate
from mrta_zoo.eval.table import summary_tables
from mrta_zoo.io import Case
from mrta_zoo.io.records import write_records
from mrta_zoo.plan import Plan
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.plan.text import schedule_table, totals
from mrta_zoo.verify import verify

# Robot 0 at (0, 0) does 2 work units a time unit, robot 1 at (100, 0) one.
CASE = Case(
    "small",
    Scenario(
        task_xy=np.array([(30.0, 40.0), (0.0, 10.0), (100.0, 50.0)]),
        deadline=np.array([60.0, 100.0, 50.0]),
        workload=np.array([20.0, 10.0, 10.0]),
        robot_xy=np.array([(0.0, 0.0), (100.0, 0.0)]),
        capacity=np.array([2.0, 1.0]),
        name="small",
    ),
    best_known=2,
)


class Fixed:
    """Always the same plan."""

    def __init__(self, *routes: tuple[int, ...]) -> None:
        self.plan = Plan.of(routes)
        self.warmed_up: list[str] = []

    def solve(self, scenario: Scenario) -> Plan:
        return self.plan

    def warm_up(self, scenario: Scenario) -> None:
        self.warmed_up.append(scenario.name)


def row(case: str, method: str, robots: int, completed: int, seconds: float = 0.001) -> Row:
    return Row(case, method, 100, robots, completed, completed / 100, 1.0, 1.0, 1.0, seconds)


def printed(*things: object) -> str:
    console = Console(width=300, markup=False)
    with console.capture() as capture:
        for thing in things:
            console.print(thing)
    return capture.get()


def test_rows_hold_the_verifiers_scores() -> None:
    # Robot 0: task 1 at 10, done at 10 + 10/2 = 15; task 0 is sqrt(30² + 30²) = 42.43 away, done at 15 + 42.43 + 10 =
    # 67.43 > 60: late. Robot 1: task 2 is 50 away, done at 50 + 10 = 60 > 50: late.
    solver = Fixed((1, 0), (2,))
    (found,) = evaluate([CASE], {"fixed": solver})
    diagonal = np.sqrt(1800.0)
    assert (found.case, found.method, found.tasks, found.robots) == ("small", "fixed", 3, 2)
    assert (found.completed, found.completion) == (1, 1 / 3)
    assert found.cost == pytest.approx((15 + diagonal + 10) / 60 + 60 / 50)
    assert found.distance == pytest.approx(10 + diagonal + 50)
    assert found.makespan == pytest.approx(25 + diagonal)
    assert 0 <= found.seconds < 1
    assert solver.warmed_up == ["small"]


def test_a_wrong_plan_is_an_error_that_names_method_and_case() -> None:
    with pytest.raises(PlanError, match="method broken on case small: task 0 is taken twice"):
        list(evaluate([CASE], {"broken": Fixed((0,), (0,))}))


def test_rows_as_csv(tmp_path: Path) -> None:
    path = tmp_path / "rows.csv"
    write_records([*evaluate([CASE], {"nearest": make_solver("nearest")}), row("a,b", 'quo"te', 2, 30)], path)
    lines = list(csv.DictReader(path.read_text().splitlines()))
    assert ",".join(lines[0]) == "case,method,tasks,robots,completed,completion,cost,distance,makespan,seconds"
    assert (lines[1]["case"], lines[1]["method"], lines[1]["completion"]) == ("a,b", 'quo"te', "0.3")
    score = verify(CASE.scenario, make_solver("nearest").solve(CASE.scenario))
    assert (float(lines[0]["cost"]), float(lines[0]["makespan"])) == (score.cost, score.makespan)
    assert [file.name for file in tmp_path.iterdir()] == ["rows.csv"]


def test_tables_group_by_size_and_compare_with_the_best_known() -> None:
    rows = [row("x", "m1", 2, 30), row("y", "m1", 2, 50), row("z", "m1", 7, 90, 0.004), row("x", "m2", 2, 20)]
    completed, share, seconds = summary_tables(rows, {"x": 40, "z": 90})
    # Two robots: (30 + 50) / 2 = 40; all: (30 + 50 + 90) / 3 = 56.7. m2 has only case x.
    text = [line.split() for line in printed(completed).splitlines()]
    assert ["100", "2", "2", "40.0", "20.0"] in text
    assert ["100", "7", "1", "90.0", "-"] in text
    assert ["all", "3", "56.7", "20.0"] in text
    # 30/40 = 75 %, 90/90 = 100 %; 20/40 = 50 %; case y has no best known.
    text = [line.split() for line in printed(share).splitlines()]
    assert ["100", "2", "1", "75.0", "50.0"] in text
    assert ["all", "2", "87.5", "50.0"] in text
    assert ["all", "3", "2.00", "1.00"] in [line.split() for line in printed(seconds).splitlines()]
    assert len(summary_tables(rows)) == 2


def test_the_schedule_as_text() -> None:
    score = verify(CASE.scenario, Plan.of([(1, 0), ()]))
    text = [line.split() for line in printed(schedule_table(CASE.scenario, score)).splitlines()]
    assert ["robot", "0", "1", "10.00", "15.00", "100"] in text
    assert ["robot", "0", "0", "57.43", "67.43", "60", "late"] in text
    assert any(line[:2] == ["robot", "1"] and "stays" in line for line in text)
    assert totals(score).startswith("completed 1 of 3 tasks (33.3 %), 1 late, 1 not taken\ncost ")
