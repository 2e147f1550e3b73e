"""Folders of cases and their reference tables."""

import os
import pickle
from pathlib import Path

import pytest

from mrta_zoo import Plan, Scenario
from mrta_zoo.errors import ScenarioError
from mrta_zoo.io import read_cases, write_plan, write_scenario, write_taptc


def scenario(name: str, tasks: int = 3) -> Scenario:
    return Scenario([[1, 1]] * tasks, [5] * tasks, [1] * tasks, [[0, 0]], [1], name=name)  # type: ignore[arg-type]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("c10", "c9", "c1"):
        write_scenario(scenario(name), tmp_path / f"{name}.json")
    write_scenario(scenario("c2"), tmp_path / "c2.csv")
    (tmp_path / "notes.txt").write_text("not a case")
    return tmp_path


def test_natural_order_without_reference(folder: Path) -> None:
    cases = read_cases(folder)
    assert [case.name for case in cases] == ["c1", "c2", "c9", "c10"]
    assert [case.scenario.name for case in cases] == ["c1", "c2", "c9", "c10"]
    assert all(case.best_known is None and case.reference == {} for case in cases)


def test_reference(folder: Path) -> None:
    (folder / "reference.csv").write_text(
        "case,tasks,robots,nearest,pyvrp\nc1,3,1,2,3\nelsewhere,100,7,50,60\nc9,3,1,0,\nc10,3,1,,\n"
    )
    told: list[str] = []
    cases = {case.name: case for case in read_cases(folder, told.append)}
    assert told == [
        f"{folder / 'reference.csv'}: no case of the folder is called 'elsewhere', and there is no row for 'c2'"
    ]
    assert cases["c1"].reference == {"nearest": 2, "pyvrp": 3}
    assert cases["c1"].best_known == 3
    assert cases["c9"].reference == {"nearest": 0}
    assert cases["c9"].best_known == 0
    assert cases["c10"].best_known is None
    assert cases["c2"].best_known is None
    assert pickle.loads(pickle.dumps(cases)) == cases
    assert len({hash(case) for case in cases.values()}) == 4


def test_taptc_folder(tmp_path: Path) -> None:
    for group in ("group1", "group2"):
        for robots in (10, 2):
            path = tmp_path / group / f"r{group[-1]}1a{robots}i00.txt"
            path.parent.mkdir(exist_ok=True)
            path.write_text("1 100 100\n0 1 1 20 50")
            (tmp_path / "agent").mkdir(exist_ok=True)
            agents = "".join(f"{index} 5 5 1\n" for index in range(robots))
            (tmp_path / "agent" / f"a{robots}i00.txt").write_text(f"{robots} 100 100\n{agents}")
    cases = read_cases(tmp_path)
    assert [case.name for case in cases] == ["r11a2i00", "r11a10i00", "r21a2i00", "r21a10i00"]
    assert [case.scenario.num_robots for case in cases] == [2, 10, 2, 10]


@pytest.mark.parametrize(
    ("reference", "message"),
    [
        ("", "reference.csv is empty"),
        (
            "case,tasks,robots\nc1,3,1\n",
            "header is 'case,tasks,robots'; expected case,tasks,robots and a column",
        ),
        ("name,tasks,robots,m\nc1,3,1,2\n", "header is 'name,tasks,robots,m'; expected case"),
        ("case,tasks,robots,m,m\nc1,3,1,2,2\n", "method 'm' is empty or appears twice; expected"),
        ("case,tasks,robots,\nc1,3,1,2\n", "method '' is empty"),
        ("case,tasks,robots,m\nc1,3,1\n", "line 2: 'c1,3,1' has 3 cells; expected 4"),
        ("case,tasks,robots,m\nc1,3,1,x\n", "line 2: m is 'x'; expected a whole number"),
        ("case,tasks,robots,m\nc1,3,1,2.0\n", "line 2: m is '2.0'; expected a whole number"),
        ("case,tasks,robots,m\nc1,3,1,-2\n", "line 2: m is '-2'; expected a whole number"),
        ("case,tasks,robots,m\nc1,3,1,4\n", "line 2: m is 4; expected at most 3"),
        ("case,tasks,robots,m\nc1,4,1,2\n", "line 2: tasks is 4; expected 3 as in the case c1"),
        ("case,tasks,robots,m\nc1,3,2,2\n", "line 2: robots is 2; expected 1 as in the case c1"),
        ("case,tasks,robots,m\nc1,3,1,2\nc1,3,1,2\n", "line 3: case 'c1' appears twice; expected"),
    ],
)
def test_malformed_reference(folder: Path, reference: str, message: str) -> None:
    (folder / "reference.csv").write_text(reference)
    with pytest.raises(ScenarioError) as caught:
        read_cases(folder)
    assert "reference.csv" in str(caught.value)
    assert message in str(caught.value)


def test_no_such_folder(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="nowhere does not exist; expected a folder"):
        read_cases(tmp_path / "nowhere")
    (tmp_path / "file").write_text("")
    with pytest.raises(ScenarioError, match="file is not a folder; expected a folder"):
        read_cases(tmp_path / "file")


def test_no_cases(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="holds no cases; expected"):
        read_cases(tmp_path)


def test_two_cases_of_one_name(folder: Path) -> None:
    write_scenario(scenario("c1"), folder / "other.json")
    with pytest.raises(ScenarioError, match=r"other\.json: the case is called 'c1', as in .*c1\.json; expected"):
        read_cases(folder)


def test_malformed_case_is_named(folder: Path) -> None:
    (folder / "c5.json").write_text("{")
    with pytest.raises(ScenarioError, match=r"c5\.json, line 1"):
        read_cases(folder)


def test_plans_among_the_scenarios_are_passed_over(tmp_path: Path) -> None:
    write_scenario(Scenario([[1, 1]], [5], [1], [[0, 0]], [1]), tmp_path / "one.json")  # type: ignore[arg-type]
    write_plan(Plan.of([[0]]), tmp_path / "plan.json")
    assert [case.scenario.num_tasks for case in read_cases(tmp_path)] == [1]


@pytest.mark.parametrize("name", ["x" * 300, "a\0b"])
def test_a_name_that_no_folder_can_have(name: str) -> None:
    with pytest.raises(ScenarioError, match="does not exist; expected a folder of cases"):
        read_cases(name)


def test_a_reference_that_leads_nowhere(folder: Path) -> None:
    (folder / "reference.csv").symlink_to(folder / "absent.csv")
    with pytest.raises(ScenarioError, match=r"reference\.csv: there is no such file"):
        read_cases(folder)


@pytest.mark.parametrize(("file", "row"), [("cafe\u0301", "caf\u00e9"), ("caf\u00e9", "cafe\u0301")])
def test_accents_may_be_written_in_two_ways(tmp_path: Path, file: str, row: str) -> None:
    """macOS names files in one way, spreadsheets write the other; nobody sees the difference."""
    write_scenario(scenario(file), tmp_path / f"{file}.csv")
    (tmp_path / "reference.csv").write_text(f"case,tasks,robots,m\n{row},3,1,2\n", encoding="utf-8")
    [case] = read_cases(tmp_path)
    assert (case.name, case.best_known) == ("caf\u00e9", 2)
    write_scenario(scenario(row), tmp_path / "other.json")
    with pytest.raises(ScenarioError, match="the case is called 'caf\u00e9', as in"):
        read_cases(tmp_path)


@pytest.mark.parametrize(
    "text",
    [",case,tasks,robots,m\n,c,3,1,1\n", "case,tasks,,robots,m\nc,3,,1,1\n", "case,tasks,robots,m,,\nc,3,1,1,,,,\n"],
)
def test_empty_columns_of_a_reference_are_passed_over(tmp_path: Path, text: str) -> None:
    write_scenario(scenario("c"), tmp_path / "c.csv")
    (tmp_path / "reference.csv").write_text(text)
    assert [dict(case.reference) for case in read_cases(tmp_path)] == [{"m": 1}]


def test_rows_that_match_no_case_are_told(folder: Path) -> None:
    def told(*names: str) -> list[str]:
        sentences: list[str] = []
        rows = "".join(f"{name},3,1,2\n" for name in names)
        (folder / "reference.csv").write_text("case,tasks,robots,m\n" + rows)
        read_cases(folder, sentences.append)
        return [each.removeprefix(f"{folder / 'reference.csv'}: ") for each in sentences]

    def no_case(said: str) -> list[str]:
        return [f"no case of the folder is called {said}"]

    assert told("c1", "c2", "c9", "c10") == told("c1", "c9") == []
    assert told("c1", "c2", "c9", "c10", "x") == no_case("'x'")
    assert told("c1", "c2", "c9", "c_10") == no_case(
        "'c_10', and there is no row for 'c10'; is 'c_10' meant for 'c10'?"
    )
    assert told("c1", "c2", "c9", "b1", "b2", "b3", "C010") == no_case(
        "'b1', 'b2', 'b3' and 1 more, and there is no row for 'c10'"
    )
    assert told("c1", "c2", "c9", "b1", "b2", "b3", "c010") == no_case(
        "'c010', 'b1', 'b2' and 1 more, and there is no row for 'c10'; is 'c010' meant for 'c10'?"
    )
    larger = [f"d{index}" for index in range(5)]
    assert told("c1", "c2", "c9", "c10", *larger) == [], "the table of a larger benchmark"
    assert told("c1", "c2", "c9", *larger) == no_case("'d0', 'd1', 'd2' and 2 more, and there is no row for 'c10'")
    with pytest.warns(UserWarning, match="no case of the folder is called 'd0', 'd1'"):
        read_cases(folder)


def test_suffixes_may_be_in_capital_letters(tmp_path: Path) -> None:
    (tmp_path / "Group1").mkdir()
    write_scenario(scenario("a"), tmp_path / "a.csv")
    write_scenario(scenario("b"), tmp_path / "b.json")
    write_taptc(scenario("c"), tmp_path / "Group1" / "c.txt", tmp_path / "c.txt")
    (tmp_path / "agent").mkdir()
    (tmp_path / "c.txt").rename(tmp_path / "agent" / "c.txt")
    write_plan(Plan.of([[0]]), tmp_path / "plan.json")
    (tmp_path / "Reference.csv").write_text("case,tasks,robots,m\na,3,1,2\n")
    for path in [*tmp_path.rglob("*.*")]:
        path.rename(path.with_name(path.stem + path.suffix.upper()))
    cases = read_cases(tmp_path)
    assert [(case.name, case.best_known) for case in cases] == [("a", 2), ("b", None), ("c", None)]
    (tmp_path / "agent" / "c.TXT").rename(tmp_path / "agent" / "c.txt")
    assert read_cases(tmp_path) == cases


def test_a_second_reference_table_is_refused(folder: Path) -> None:
    for name in ("reference.csv", "REFERENCE.CSV"):
        (folder / name).write_text("case,tasks,robots,m\nc1,3,1,2\n")
    if len([*folder.glob("[rR]*")]) == 2:  # capital letters count here
        with pytest.raises(ScenarioError, match=r"reference\.csv: the folder also has REFERENCE\.CSV; expected one"):
            read_cases(folder)


@pytest.mark.parametrize(
    ("agents", "task"),
    [
        ("AGENT/c.txt", "c.txt"),
        ("Agent/c.Txt", "c.txt"),
        ("agent/c.txt", "c.Txt"),
        ("agent/caf\u00e9.txt", "cafe\u0301.txt"),
        ("AGENT/cafe\u0301.TXT", "caf\u00e9.txt"),
        ("group1/AGENT/A2I00.TXT", "r11a2i00.txt"),
    ],
)
def test_agent_files_may_be_spelt_otherwise(tmp_path: Path, agents: str, task: str) -> None:
    for path in (tmp_path / "group1" / task, tmp_path / agents):
        path.parent.mkdir(exist_ok=True, parents=True)
    write_taptc(scenario("c"), tmp_path / "group1" / task, tmp_path / agents)
    assert [case.scenario.num_robots for case in read_cases(tmp_path)] == [1]


@pytest.mark.parametrize(
    "header",
    [
        "robot,robot_name,task,task_name,x,y,depart,arrive,finish,deadline,slack",
        "case,method,tasks,robots,completed,completion,cost,distance,makespan,seconds",
        "update,episodes,completion,cost,baseline_replaced",
    ],
)
def test_tables_of_results_among_the_scenarios_are_passed_over(tmp_path: Path, header: str) -> None:
    write_scenario(scenario("c"), tmp_path / "c.csv")
    (tmp_path / "table.CSV").write_text(f"{header}\n{','.join('1' for _ in header.split(','))}\n")
    assert [case.name for case in read_cases(tmp_path)] == ["c"]
    (tmp_path / "table.CSV").write_text("type,x,y\n1,1,1\n")
    with pytest.raises(ScenarioError, match=r"table\.CSV, line 1: there is no column 'type'"):
        read_cases(tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_only_files_are_cases(tmp_path: Path) -> None:
    write_scenario(scenario("c"), tmp_path / "c.csv")
    (tmp_path / "group1").mkdir()
    for name in ("a.json", "a.csv", "reference.csv", "group1/a.txt"):
        os.mkfifo(tmp_path / name)
    (tmp_path / "folder.json").mkdir()
    (tmp_path / "d.csv").symlink_to(tmp_path / "elsewhere")
    (tmp_path / "c.csv").rename(tmp_path / "elsewhere")
    assert [case.name for case in read_cases(tmp_path)] == ["d"]
