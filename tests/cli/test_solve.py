"""`mrta-zoo solve` on a mission with names, worked out by hand: see `factories.named_scenario`."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from command_line import Captured, fails
from factories import hopeless_scenario, named_scenario

from mrta_zoo import extras
from mrta_zoo.cli.main import main
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.io import json_format, read_plan, read_scenario, write_plan, write_scenario
from mrta_zoo.plan import Plan
from mrta_zoo.verify import verify
from mrta_zoo.wording import listed

NEAREST = """\
named: 5 tasks, 2 robots, planned by nearest in

 robot      task          arrival   finish   deadline
 Ann        valve-A         10.00    15.00         20
 Ann        pump #3 <b>     35.00    45.00         50

 Bob & Co   =SUM(A1)        15.00    17.00         30

completed 3 of 5 tasks (60.0 %), 0 late, 2 not taken
cost 4.050 (Eq. 1: the sum of finish / deadline over the tasks missed)
distance 60.0, makespan 45.0
left out, out of reach (no robot could do them in time): 弁[red]
left out, others were worth more: $x$
"""  # the cost: both count as finished at the end, 45 / 20 + 45 / 25


@pytest.fixture
def mission(tmp_path: Path) -> Path:
    path = tmp_path / "named.csv"
    write_scenario(named_scenario(), path)
    return path


def test_names_and_reasons_are_printed(mission: Path, capsys: Captured) -> None:
    assert main(["solve", str(mission), "--method", "nearest"]) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines() if "──" not in line]
    assert lines[0].pop() == "s"
    assert float(lines[0].pop()) < 5
    assert lines == [line.split() for line in NEAREST.splitlines()]


def test_names_in_lists_are_told_apart(mission: Path, capsys: Captured) -> None:
    names = ("pump A", "valve, main", 'mast "old"', '"fence"', "gate, 3")
    write_scenario(replace(named_scenario(), task_names=names), mission)
    assert main(["solve", str(mission), "--method", "nearest", "--mask-rule", "unvisited"]) == 0
    assert '\nfinished late: "gate, 3", """fence"""\n' in capsys.readouterr().out
    assert listed(names) == 'pump A, "valve, main", mast "old", """fence""", "gate, 3"'
    assert listed(["fence W ", "\xa0x"]) == '"fence W ", "\xa0x"'


def test_what_is_late_is_named(mission: Path, capsys: Captured) -> None:
    assert main(["solve", str(mission), "--method", "nearest", "--mask-rule", "unvisited"]) == 0
    output = capsys.readouterr().out
    assert "left out" not in output
    assert "\nfinished late: $x$, 弁[red]\n" in output  # Bob & Co goes there from =SUM(A1), Ann at the end


def test_the_plan_file_has_names_and_reasons(mission: Path, tmp_path: Path) -> None:
    out = tmp_path / "plan.json"
    assert main(["solve", str(mission), "--method", "nearest", "--out", str(out)]) == 0
    document = json.loads(out.read_text())
    jsonschema.validate(document, json.loads(Path(json_format.__file__).with_name("plan.schema.json").read_text()))
    assert document["left_out"] == [
        {"task": 3, "reason": "out of reach", "name": "弁[red]"},
        {"task": 4, "reason": "others were worth more", "name": "$x$"},
    ]
    assert [[(stop["task"], stop["name"], stop["robot_name"]) for stop in stops] for stops in document["schedule"]] == [
        [(0, "valve-A", "Ann"), (1, "pump #3 <b>", "Ann")],
        [(2, "=SUM(A1)", "Bob & Co")],
    ]
    assert read_plan(out) == Plan.of([[0, 1], [2]], "named", "nearest")
    out.write_text(out.read_text().replace("out of reach", "too far"))
    assert main(["replay", str(out), "--scenario", str(mission), "--out", str(tmp_path / "page.html")]) == 2


def test_the_schedule_as_a_table(mission: Path, tmp_path: Path, capsys: Captured) -> None:
    out = tmp_path / "schedule.csv"
    assert main(["solve", str(mission), "--method", "nearest", "--schedule", str(out)]) == 0
    assert f"schedule written to {out}\n" in capsys.readouterr().out
    assert out.read_text(encoding="utf-8") == (
        "robot,robot_name,task,task_name,x,y,depart,arrive,finish,deadline,slack\n"
        "0,Ann,0,valve-A,10.0,0.0,0.0,10.0,15.0,20.0,5.0\n"
        "0,Ann,1,pump #3 <b>,30.0,0.0,15.0,35.0,45.0,50.0,5.0\n"
        "1,Bob & Co,2,=SUM(A1),100.0,30.0,0.0,15.0,17.0,30.0,13.0\n"
    )


def test_a_schedule_without_names_or_tasks(tmp_path: Path, capsys: Captured) -> None:
    mission, out = tmp_path / "mission.json", tmp_path / "schedule.csv"
    write_scenario(replace(named_scenario(), task_names=(), robot_names=()), mission)
    assert main(["solve", str(mission), "--method", "nearest", "--schedule", str(out)]) == 0
    rows = list(csv.DictReader(out.read_text().splitlines()))
    assert [(row["robot_name"], row["task_name"]) for row in rows] == [
        ("robot 0", "0"), ("robot 0", "1"), ("robot 1", "2"),
    ]  # fmt: skip
    write_scenario(hopeless_scenario(), mission)
    assert main(["solve", str(mission), "--method", "nearest", "--schedule", str(out)]) == 0
    assert out.read_text() == "robot,robot_name,task,task_name,x,y,depart,arrive,finish,deadline,slack\n"
    assert "\nleft out, out of reach (no robot could do them in time): 0\n" in capsys.readouterr().out


def test_an_unknown_reason_is_told(tmp_path: Path, mission: Path, capsys: Captured) -> None:
    write_plan(Plan.of([[], []]), tmp_path / "plan.json")
    text = (tmp_path / "plan.json").read_text()
    (tmp_path / "plan.json").write_text(
        text.replace('"routes"', '"left_out": [{"task": 1, "reason": "far"}], "routes"')
    )
    arguments = ["compare", str(mission), "--methods", f"nearest,{tmp_path / 'plan.json'}"]
    assert "left_out[0].reason is 'far'; expected one of others were worth more, out of reach" in fails(
        capsys, arguments
    )


@pytest.mark.parametrize("other", ["--out", "--plot"])
def test_a_schedule_takes_no_other_file(other: str, mission: Path, tmp_path: Path, capsys: Captured) -> None:
    arguments = ["solve", str(mission), "--method", "nearest"]
    same = str(tmp_path / "x.svg")
    assert "; expected a file of its own" in fails(capsys, [*arguments, "--schedule", same, other, same])
    assert "which is the task file" in fails(capsys, [*arguments, "--schedule", str(mission)])
    assert "does not exist" in fails(capsys, [*arguments, "--schedule", str(tmp_path / "absent" / "s.csv")])
    assert mission.read_text().startswith("kind,")


def test_the_best_method_plans_by_default(mission: Path, tmp_path: Path, capsys: Captured) -> None:
    pytest.importorskip("numba")
    out = tmp_path / "plan.json"
    assert main(["solve", str(mission), "--out", str(out)]) == 0
    output = capsys.readouterr()
    assert output.out.startswith("named: 5 tasks, 2 robots, planned by eils in ")
    assert "completed 3 of 5 tasks" in output.out  # all that can be done
    assert (read_plan(out).method, output.err) == ("eils", "")


def test_without_what_it_needs_the_next_best_plans(
    mission: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    assert main(["solve", str(mission)]) == 0
    output = capsys.readouterr()
    assert output.out.startswith("named: 5 tasks, 2 robots, planned by nearest in ")
    assert output.err == (
        "note: planning by nearest instead of the default: method 'eils' needs scipy, numba, not installed here; "
        'install it with: pip install "mrta_zoo[solvers]"\n'
    )
    # One that is named is not exchanged for another.
    assert "method 'eils' needs scipy, numba, not installed" in fails(
        capsys, ["solve", str(mission), "--method", "eils"]
    )


@pytest.mark.parametrize("flags", [["--decode", "greedy"], ["--samples", "4"], ["--mask-rule", "unvisited"]])
def test_how_learned_methods_plan_is_for_one_of_them(flags: list[str], mission: Path, capsys: Captured) -> None:
    pytest.importorskip("torch")
    assert main(["solve", str(mission), *flags]) == 0
    assert "planned by capam-plus in " in capsys.readouterr().out


def test_solve_prints_and_writes_the_verified_plan(cases: Path, tmp_path: Path, capsys: Captured) -> None:
    task_file = next((cases / "group1").glob("*.txt"))
    out, picture = tmp_path / "plan.json", tmp_path / "plan.png"
    arguments = ["solve", str(task_file), "--method", "nearest", "--out", str(out)]
    pytest.importorskip("matplotlib")
    arguments += ["--plot", str(picture)]
    assert main(arguments) == 0
    output = capsys.readouterr()
    scenario, plan = read_scenario(task_file), read_plan(out)
    score = verify(scenario, plan)
    for robot, visits in enumerate(score.schedule):
        for visit in visits:
            line = f"robot {robot} {visit.task} {visit.arrival:.2f} {visit.finish:.2f} {visit.deadline:g}"
            assert line.split() in [each.split() for each in output.out.splitlines()]
    assert f"completed {score.completed} of 12 tasks" in output.out
    document = json.loads(out.read_text())
    assert document["score"]["cost"] == score.cost
    assert document["schedule"][0][0]["finish"] == score.schedule[0][0].finish
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert output.err == ""


@pytest.mark.parametrize(
    ("budget", "says"), [("20", "proven optimal: no plan completes more tasks"), ("1e-9", "no plan")]
)
def test_solve_prints_what_is_proven(cases: Path, tmp_path: Path, budget: str, says: str, capsys: Captured) -> None:
    pytest.importorskip("scipy")
    pytest.importorskip("numba")
    task_file, out = next((cases / "group1").glob("*.txt")), tmp_path / "plan.json"
    assert main(["solve", str(task_file), "--method", "exact", "--budget", budget, "--out", str(out)]) == 0
    assert says in capsys.readouterr().out
    document = json.loads(out.read_text())
    assert document["bound"] >= document["score"]["completed"]


def test_solve_reads_json_csv_and_named_agents(tmp_path: Path, capsys: Captured) -> None:
    scenario = TaptcGenerator(tasks=(9, 9), robots=(2, 2))(np.random.default_rng(2), "mission")
    for suffix in ("json", "csv", "txt"):
        write_scenario(scenario, tmp_path / f"mission.{suffix}")
    robots = tmp_path / "robots.txt"
    (tmp_path / "agent" / "mission.txt").rename(robots)
    totals = []
    for arguments in (["mission.json"], ["mission.csv"], ["mission.txt", "--agents", str(robots)]):
        assert main(["solve", str(tmp_path / arguments[0]), *arguments[1:], "--method", "edf"]) == 0
        totals.append(capsys.readouterr().out.splitlines()[-2:])
    assert totals[0] == totals[1] == totals[2]


def test_solve_under_another_mask_rule_takes_everything(cases: Path, capsys: Captured) -> None:
    task_file = next((cases / "group1").glob("*.txt"))
    assert main(["solve", str(task_file), "--method", "nearest", "--mask-rule", "unvisited"]) == 0
    assert " 0 not taken" in capsys.readouterr().out


@pytest.mark.parametrize("decode", ["augment", "beam"])
def test_solve_decodes_as_it_is_told(cases: Path, tmp_path: Path, decode: str) -> None:
    neural = pytest.importorskip("mrta_zoo.policies.neural.policy")
    case, out = next(cases.glob("group1/*.txt")), tmp_path / "plan.json"
    flags = ["--method", "capam", "--decode", decode, "--samples", "4", "--out", str(out)]
    assert main(["solve", str(case), *flags]) == 0
    scenario = read_scenario(case)
    expected = neural.load_policy("capam").solve(scenario, decode=decode, samples=4)
    assert read_plan(out).routes == expected.routes
