"""The commands that look into episodes: `mrta-zoo step` and `mrta-zoo compare`."""

from __future__ import annotations

import io
import json
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from command_line import Captured, fails
from factories import named_scenario, small_scenario
from real_cases import REAL, needs_real_cases

from mrta_zoo.cli.main import main
from mrta_zoo.debug import compare, record
from mrta_zoo.debug.session import Session
from mrta_zoo.io import read_trace, write_plan, write_scenario, write_trace
from mrta_zoo.plan import Plan

SCENARIO = small_scenario(2, tasks=12, robots=3)


@pytest.fixture
def mission(tmp_path: Path) -> str:
    write_scenario(SCENARIO, tmp_path / "mission.json")
    return str(tmp_path / "mission.json")


def script(tmp_path: Path, text: str) -> str:
    (tmp_path / "commands.txt").write_text(text)
    return str(tmp_path / "commands.txt")


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
    assert "is there already and is no session" in capsys.readouterr().err
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


def test_compare_prints_and_writes(mission: str, tmp_path: Path, capsys: Captured) -> None:
    write_plan(record(SCENARIO, "edf").plan(), tmp_path / "plan.json")
    plan, out = str(tmp_path / "plan.json"), tmp_path / "comparison.json"
    assert main(["compare", mission, "--methods", f"nearest,{plan}", "--out", str(out), "--rows", "2"]) == 0
    output = capsys.readouterr().out
    found = compare(SCENARIO, "nearest", record(SCENARIO, "edf").plan())
    assert found.parting is not None
    instead = found.parting.otherwise[0]
    assert instead is not None
    assert f"They part at decision {found.parting.index}, at {found.parting.time:.1f}, when robot" in output
    assert f"there and then by itself: completed {instead.completed} (" in output
    assert f"choose otherwise at {len(found.disagreements)} of {len(found.traces[0].choices)} decisions" in output
    assert output.count("more (--rows)") == sum(
        len(each) > 2
        for each in (
            found.disagreements, found.turns,
            [fate for fate in found.fates if fate.completed[0]], [fate for fate in found.fates if fate.completed[1]],
        )
    )  # fmt: skip
    document = json.loads(out.read_text())
    assert (document["format"], document["version"], document["methods"]) == (
        "mrta_zoo.comparison",
        1,
        ["nearest", plan],
    )
    assert document["parting"]["otherwise"][0]["cost"] == instead.cost
    assert len(document["turns"]) == len(found.turns)
    assert main(["compare", mission, "--methods", f"edf,{plan}"]) == 0
    assert f"edf and {plan} do the same throughout" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("methods", "percents"),
    [("PLAN,nearest", []), ("PLAN,capam-plus", ["% capam-plus"]), ("capam-plus,capam", ["% capam-plus", "% capam"])],
)
def test_who_has_no_probabilities_has_no_column_of_them(
    methods: str, percents: list[str], mission: str, tmp_path: Path, capsys: Captured
) -> None:
    write_plan(Plan(((0,), (), ())), tmp_path / "plan.json")
    assert main(["compare", mission, "--methods", methods.replace("PLAN", str(tmp_path / "plan.json"))]) == 0
    lines = capsys.readouterr().out.splitlines()
    parted = next(index for index, line in enumerate(lines) if line.startswith("They part at"))
    heading = next(line for line in lines[parted:] if line.split()[:1] == ["method"])
    assert heading.split() == ["method", "task", "distance", "finish", "slack", *" ".join(percents).split()]


def test_what_cannot_be_compared(mission: str, capsys: Captured) -> None:
    assert "expected two, such as" in fails(capsys, ["compare", mission, "--methods", "nearest"])
    assert "named twice" in fails(capsys, ["compare", mission, "--methods", "nearest,nearest"])
    assert "rows is 0" in fails(capsys, ["compare", mission, "--methods", "nearest,edf", "--rows", "0"])
    assert "which is the scenario" in fails(capsys, ["compare", mission, "--methods", "edf,random", "--out", mission])


@needs_real_cases
def test_a_real_case(tmp_path: Path, capsys: Captured) -> None:
    case = str(min((REAL / "n100" / "group1").glob("*.txt")))
    assert main(["compare", case, "--methods", "nearest,edf"]) == 0
    assert "They part at decision" in capsys.readouterr().out
    assert main(["step", case, "--policy", "nearest", "--script", script(tmp_path, "jump 1\nshow\nend")]) == 0
    assert "the mission is over: completed" in capsys.readouterr().out


@pytest.mark.usefixtures("signals_heard")
@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGTERM])
def test_a_lost_connection_saves_the_session(mission: str, tmp_path: Path, number: int) -> None:
    session = tmp_path / "session.json"
    code = (
        "import os, sys; from mrta_zoo.cli.main import main; "
        "from mrta_zoo.debug.session import Session; do = Session.do; "
        f"Session.do = lambda self, line: os.kill(os.getpid(), {int(number)}) if line == 'q' else do(self, line); "
        "sys.exit(main(sys.argv[1:]))"
    )
    flags = ["--policy", "edf", "--session", str(session), "--script", script(tmp_path, "f 3\nq")]
    command = [sys.executable, "-c", code, "step", mission, *flags]
    done = subprocess.run(command, capture_output=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (128 + number, b"")
    assert read_trace(session).bookmark == 3


def handlers() -> list[object]:
    return [signal.getsignal(number) for number in sorted(signal.valid_signals())]


@pytest.mark.parametrize("flags", [[], ["--session"]], ids=["", "session"])
def test_signals_are_left_to_who_handles_them(
    flags: list[str], mission: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[object] = []
    do = Session.do

    def watch(session: Session, line: str) -> str:
        seen.append((signal.getsignal(signal.SIGTERM), signal.getsignal(signal.SIGINT)))
        return do(session, line)

    monkeypatch.setattr(Session, "do", watch)
    before = handlers()
    flags = [*flags, str(tmp_path / "session.json")] if flags else []
    arguments = ["step", mission, "--policy", "edf", *flags, "--script", script(tmp_path, "f 2")]
    assert main(arguments) == 0
    (terminate, interrupt) = seen.pop()
    assert interrupt is signal.getsignal(signal.SIGINT)
    assert (terminate is signal.SIG_DFL) == (not flags)  # there is a session to save, or not
    assert handlers() == before
    own = signal.signal(signal.SIGTERM, lambda *_: None)
    try:
        mine = signal.getsignal(signal.SIGTERM)
        assert main(arguments) == 0
        assert seen.pop()[0] is mine is signal.getsignal(signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, own)


@pytest.mark.parametrize("missing", ["", "SIGHUP"])
def test_in_a_thread_and_without_hangups(
    missing: str, mission: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if missing:  # as on Windows
        monkeypatch.delattr(signal, missing)
    codes: list[int] = []
    session = ["--session", str(tmp_path / "session.json"), "--script", script(tmp_path, "f 2")]

    def run() -> None:
        codes.append(main(["step", mission, "--policy", "edf", *session]))

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    run()
    assert codes == [0, 0]
    assert read_trace(tmp_path / "session.json").bookmark == 4


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
