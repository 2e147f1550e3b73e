"""The command ``mrta-zoo step``."""

from __future__ import annotations

import io
import json
from pathlib import Path

import pytest
from command_line import SCENARIO, Captured, fails, script
from factories import named_scenario, small_scenario
from real_cases import REAL, needs_real_cases

from mrta_zoo.cli.main import main
from mrta_zoo.debug import record
from mrta_zoo.io import read_trace, write_plan, write_scenario, write_trace
from mrta_zoo.plan import Plan


def test_an_empty_file_becomes_a_new_session(mission: str, tmp_path: Path, capsys: Captured) -> None:
    """As a container wants one to be there before it gets it mounted."""
    session = tmp_path / "session.json"
    session.touch()
    line = ["step", mission, "--policy", "nearest", "--session", str(session), "--script", script(tmp_path, "follow")]
    assert main(line) == 0
    assert read_trace(session).choices[0] == record(SCENARIO, "nearest").choices[0]


def test_a_script_steps_and_the_session_is_saved(mission: str, tmp_path: Path, capsys: Captured) -> None:
    session = tmp_path / "session.json"
    arguments = ["step", "--policy", "nearest", "--session", str(session), "--script"]
    assert main([*arguments, script(tmp_path, "f 4\nstay\nb"), mission]) == 0
    output = capsys.readouterr()
    assert output.out.startswith("> f 4\ndecision 4: robot ")
    assert output.err == ""
    trace = read_trace(session)
    assert (trace.bookmark, len(trace.choices), trace.method) == (4, 5, "nearest")
    assert trace.choices[:4] == record(SCENARIO, "nearest").choices[:4]
    assert trace.choices[4].task is None
    # It goes on there, with the same policy, and without the scenario's file.
    assert main(["step", "--session", str(session), "--script", script(tmp_path, "follow\nend")]) == 0
    assert "the mission is over" in capsys.readouterr().out
    assert read_trace(session).choices == record(SCENARIO, "nearest").choices
    # Nor does it mind its file; another mission's it does.
    assert main([*arguments, script(tmp_path, "b 99\nf"), mission]) == 0
    assert read_trace(session).bookmark == 1
    write_scenario(small_scenario(5), tmp_path / "other.json")
    before = session.read_bytes()
    assert "leave out the scenario to go on with it" in fails(
        capsys, [*arguments, script(tmp_path, "f"), str(tmp_path / "other.json")]
    )
    assert session.read_bytes() == before
    # `load` goes on with the loaded file, and `save` spares what is no session.
    other = tmp_path / "loaded.json"
    other.write_bytes(before)
    lines = f"load {other}\nf 2\n"
    assert main(["step", "--session", str(session), "--script", script(tmp_path, lines)]) == 0
    assert (read_trace(other).bookmark, session.read_bytes()) == (3, before)
    # A copy does not move the session: what comes after it is saved where the session is.
    copy = tmp_path / "copy.json"
    lines = f"goto 0\nsave {copy}\nf 2\n"
    assert main(["step", "--session", str(session), "--script", script(tmp_path, lines)]) == 0
    assert (read_trace(copy).bookmark, read_trace(session).bookmark) == (0, 2)
    scenario = Path(mission).read_bytes()
    with_save = ["step", "--session", str(session), "--script", script(tmp_path, f"save {mission}")]
    assert main(with_save) == 2
    assert "already exists and is not a session" in capsys.readouterr().err
    assert Path(mission).read_bytes() == scenario


def test_a_session_may_be_a_link(mission: str, tmp_path: Path) -> None:
    (tmp_path / "shared").mkdir()
    link = tmp_path / "session.json"
    link.symlink_to(tmp_path / "shared" / "s.json")  # which is not there yet
    for decisions in (1, 2):
        scenario = [mission, "--policy", "edf"] if decisions == 1 else []
        assert main(["step", *scenario, "--session", str(link), "--script", script(tmp_path, "follow\n")]) == 0
        assert link.is_symlink()
        assert len(read_trace(tmp_path / "shared" / "s.json").choices) == decisions


def test_standard_input_is_a_script(mission: str, capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    for flags in (["--script", "-"], []):
        monkeypatch.setattr("sys.stdin", io.StringIO("f 2\nlog\n"))
        assert main(["step", mission, "--policy", "edf", *flags]) == 0
        assert "2 decisions so far" in capsys.readouterr().out


def test_without_a_scenario_one_is_drawn(tmp_path: Path, capsys: Captured) -> None:
    drawn = []
    for seed in ("1", "1", "2"):
        assert main(["step", "--seed", seed, "--policy", "random", "--script", script(tmp_path, "f 9\nlog")]) == 0
        drawn.append(capsys.readouterr().out)
    assert drawn[0] == drawn[1] != drawn[2]
    assert "drawn with seed 2: 100 tasks" in drawn[2]


def test_a_plan_or_a_trace_may_advise(mission: str, tmp_path: Path, capsys: Captured) -> None:
    routes = record(SCENARIO, "nearest").plan().routes
    plan = Plan((routes[0][:1], (), routes[2][:1]), SCENARIO.name, "hand")
    write_plan(plan, tmp_path / "plan.json")
    write_trace(record(SCENARIO, plan), tmp_path / "trace.json")
    for name in ("plan.json", "trace.json"):
        arguments = ["step", mission, "--policy", str(tmp_path / name), "--script", script(tmp_path, "end\nlog")]
        assert main(arguments) == 0
        assert "the mission is over: completed 2 of 12" in capsys.readouterr().out
    assert main(["step", mission, "--policy", "none", "--script", script(tmp_path, "3\nlog")]) == 0
    assert "robot 0 takes task 3" in capsys.readouterr().out


def test_a_session_keeps_its_seed(mission: str, tmp_path: Path, capsys: Captured) -> None:
    session = str(tmp_path / "session.json")
    arguments = ["--session", session, "--script"]
    half = script(tmp_path, "f 3")
    assert main(["step", mission, "--policy", "random", "--seed", "5", *arguments, half]) == 0
    assert main(["step", *arguments, script(tmp_path, "end")]) == 0
    assert read_trace(session).choices == record(SCENARIO, "random", seed=5).choices
    capsys.readouterr()


def test_what_cannot_be_stepped(mission: str, tmp_path: Path, capsys: Captured) -> None:
    commands = script(tmp_path, "# a comment\nf 1\ntake 99\n")
    assert main(["step", mission, "--policy", "nearest", "--script", commands]) == 2
    output = capsys.readouterr()
    assert output.out == "> f 1\ndecision 1: robot 1 chooses at 0.0\n> take 99\n"
    assert "commands.txt, line 3: robot 1 chose task 99; tasks are numbered 0 to 11" in output.err
    assert "there is no method 'nearst'" in fails(capsys, ["step", mission, "--policy", "nearst", "--script", commands])
    assert "there is no such file" in fails(capsys, ["step", mission, "--policy", "edf", "--script", "no.txt"])
    assert "expected SCENARIO" in fails(capsys, ["step", "--agents", mission, "--script", commands])
    assert "which is the scenario" in fails(capsys, ["step", mission, "--session", mission, "--script", commands])
    write_plan(Plan(((), ())), tmp_path / "plan.json")
    message = fails(capsys, ["step", mission, "--policy", str(tmp_path / "plan.json"), "--script", commands])
    assert "the plan has 2 routes" in message


@needs_real_cases
def test_a_real_case(tmp_path: Path, capsys: Captured) -> None:
    case = str(min((REAL / "n100" / "group1").glob("*.txt")))
    assert main(["compare", case, "--methods", "nearest,edf"]) == 0
    assert "They part at decision" in capsys.readouterr().out
    assert main(["step", case, "--policy", "nearest", "--script", script(tmp_path, "jump 1\nshow\nend")]) == 0
    assert "the mission is over: completed" in capsys.readouterr().out


def test_a_closed_standard_input_is_told(mission: str, capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", None)
    assert "standard input is closed" in fails(capsys, ["step", mission, "--policy", "edf"])


def test_a_plan_of_another_name_is_noticed(mission: str, tmp_path: Path, capsys: Captured) -> None:
    write_plan(Plan(record(SCENARIO, "edf").plan().routes, "elsewhere"), tmp_path / "plan.json")
    for arguments in (
        ["compare", mission, "--methods", f"{tmp_path / 'plan.json'},nearest"],
        ["replay", str(tmp_path / "plan.json"), "--scenario", mission, "--out", str(tmp_path / "page.html")],
    ):
        assert main(arguments) == 0
        assert "is a plan for elsewhere; the scenario is" in capsys.readouterr().err


def test_names_are_kept_in_sessions_and_comparisons(tmp_path: Path, capsys: Captured) -> None:
    path, session, out = (str(tmp_path / name) for name in ("named.csv", "session.json", "comparison.json"))
    write_scenario(named_scenario(), path)
    lines = script(tmp_path, "pump #3 <b>")
    assert main(["step", path, "--policy", "nearest", "--session", session, "--script", lines]) == 0
    assert "> pump #3 <b>\ndecision 0: Ann takes task pump #3 <b>, until 40.0 (the" in capsys.readouterr().out
    trace = read_trace(session)
    assert (trace.scenario, trace.choices[0].task) == (named_scenario(), 1)
    write_plan(Plan(((0, 1), (4,))), tmp_path / "plan.json")
    assert main(["compare", path, "--methods", f"nearest,{tmp_path / 'plan.json'}", "--out", out]) == 0
    output = capsys.readouterr().out
    assert "They part at decision 1, at 0.0, when Bob & Co chooses\n" in output
    assert f"{tmp_path / 'plan.json'} with task =SUM(A1) there and then by itself: completed 3 (+0)" in output
    assert ["=SUM(A1)", "30.0", "Bob", "&", "Co", "17.0", "not", "taken"] in [
        row.split() for row in output.splitlines()
    ]
    assert json.loads(Path(out).read_text(encoding="utf-8"))["task_names"][1] == "pump #3 <b>"
