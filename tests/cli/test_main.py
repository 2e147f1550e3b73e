"""The command line: what it prints and writes, and how it ends."""

from __future__ import annotations

import csv
import io
import json
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from command_line import Captured
from real_cases import REAL, needs_real_cases

from mrta_zoo import __version__
from mrta_zoo.cli.main import COMMANDS, main
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.io import read_cases, read_plan, read_scenario, write_scenario
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify


@pytest.fixture(scope="module")
def cases(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of three small TAPTC cases."""
    folder = tmp_path_factory.mktemp("data") / "cases"
    assert main(["generate", "--count", "3", "--tasks", "12", "--robots", "2-3", "--out", str(folder)]) == 0
    return folder


def test_version_and_help(capsys: Captured) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"mrta-zoo {__version__}\n"
    assert main(["--help"]) == 0
    text = capsys.readouterr().out
    assert all(f"  {name} " in text for name in COMMANDS)
    assert main([]) == 2
    assert capsys.readouterr().err == text


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(command: str, capsys: Captured) -> None:
    if command == "train":
        pytest.importorskip("torch")
    with pytest.raises(SystemExit) as exit_:
        main([command, "--help"])
    assert exit_.value.code == 0
    text = capsys.readouterr().out
    assert text.startswith(f"usage: mrta-zoo {command} ")
    assert f"mrta-zoo {command} " in text.split("\n", 1)[1], "an example"
    assert command == "train" or "None" not in text


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


def test_generate_is_fixed_by_its_seed(tmp_path: Path) -> None:
    def drawn(name: str, *flags: str) -> list[Scenario]:
        main(
            [
                "generate",
                "--generator",
                "uniform",
                "--format",
                "json",
                "--tasks",
                "3-9",
                "--out",
                str(tmp_path / name),
                *flags,
            ]
        )
        return [case.scenario for case in read_cases(tmp_path / name)]

    three = drawn("a", "--count", "3", "--seed", "5")
    assert three == drawn("b", "--count", "3", "--seed", "5")
    assert three == drawn("c", "--count", "9", "--seed", "5")[:3]
    assert three != drawn("d", "--count", "3", "--seed", "6")
    assert len({scenario.num_tasks for scenario in drawn("e", "--count", "12")}) > 1


def test_generate_takes_bounds(tmp_path: Path) -> None:
    flags = "--generator uniform --format json --robots 3 --map 50-20 --speed 0.5-1.5 --capacity 2 --deadline 10-12.5"
    assert main(["generate", "--out", str(tmp_path / "cases"), "--count", "4", *flags.split()]) == 0
    for case in read_cases(tmp_path / "cases"):
        scenario = case.scenario
        assert (scenario.num_tasks, scenario.num_robots, scenario.map_size) == (100, 3, (50, 20))
        assert 0.5 <= scenario.speed.min() < scenario.speed.max() <= 1.5
        assert (scenario.capacity == 2).all()
        assert 10 <= scenario.deadline.min() < scenario.deadline.max() <= 12.5


@pytest.mark.parametrize("decode", ["augment", "beam"])
def test_solve_decodes_as_it_is_told(cases: Path, tmp_path: Path, decode: str) -> None:
    neural = pytest.importorskip("mrta_zoo.policies.neural.policy")
    case, out = next(cases.glob("group1/*.txt")), tmp_path / "plan.json"
    flags = ["--method", "capam", "--decode", decode, "--samples", "4", "--out", str(out)]
    assert main(["solve", str(case), *flags]) == 0
    scenario = read_scenario(case)
    expected = neural.load_policy("capam").solve(scenario, decode=decode, samples=4)
    assert read_plan(out).routes == expected.routes


def test_an_interrupted_evaluation_writes_nothing(
    cases: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    from mrta_zoo.cli import commands

    def interrupted(*args: object) -> object:
        raise KeyboardInterrupt

    monkeypatch.setattr(commands, "evaluate", interrupted)
    arguments = ["eval", "--cases", str(cases), "--methods", "nearest", "--out", str(tmp_path / "rows.csv")]
    assert main(arguments) == 130
    assert capsys.readouterr().err == "interrupted\n"
    assert list(tmp_path.iterdir()) == []


def test_as_a_module_in_a_pipe(cases: Path) -> None:
    task_file = next((cases / "group1").glob("*.txt"))
    command = [sys.executable, "-m", "mrta_zoo", "solve", str(task_file), "--method", "nearest"]
    result = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    assert "\x1b" not in result.stdout
    assert "completed" in result.stdout
    assert result.stderr == ""


@pytest.mark.usefixtures("signals_heard")
def test_ctrl_c_ends_with_130(tmp_path: Path) -> None:
    folder = tmp_path / "cases"
    command = [sys.executable, "-m", "mrta_zoo", "generate", "--count", "1000000", "--out", str(folder)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        try:
            while not any(tmp_path.rglob("*.txt")) and process.poll() is None:
                pass
            process.send_signal(signal.SIGINT)
            _, complaint = process.communicate(timeout=60)
        finally:
            process.kill()
    assert (process.returncode, complaint) == (130, "interrupted\n")
    assert list(tmp_path.iterdir()) == []


def test_streams_are_left_as_they_were(monkeypatch: pytest.MonkeyPatch) -> None:
    out = io.TextIOWrapper(io.BytesIO(), encoding="ascii", errors="strict")
    monkeypatch.setattr("sys.stdout", out)
    monkeypatch.setattr("sys.stderr", None)
    assert main(["solve", "é"]) == 2
    assert main(["--version"]) == 0
    assert (sys.stdout.errors, sys.stderr) == ("strict", None)


@pytest.mark.parametrize("closed", [False, True])
def test_streams_are_left_as_they_were_by_commands_in_several_threads(
    closed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first ends while the second, which found the streams as the first had made them, is still at work."""
    out = None if closed else io.TextIOWrapper(io.BytesIO(), encoding="ascii", errors="strict")
    monkeypatch.setattr("sys.stdout", out)
    first_begun, second_begun, first_over = (threading.Event() for _ in range(3))
    codes = {}

    def first(_: object) -> None:
        first_begun.set()
        assert second_begun.wait(10)

    def second(_: object) -> None:
        second_begun.set()
        assert first_over.wait(10)
        print("é")  # still fit for it
        sys.stdout.flush()

    monkeypatch.setitem(COMMANDS, "first", ("", first))
    monkeypatch.setitem(COMMANDS, "second", ("", second))
    threads = [
        threading.Thread(target=lambda name=name: codes.update({name: main([name])})) for name in ("first", "second")
    ]
    threads[0].start()
    assert first_begun.wait(10)
    threads[1].start()
    threads[0].join()
    first_over.set()
    threads[1].join()
    assert codes == {"first": 0, "second": 0}
    assert sys.stdout is out
    assert out is None or out.errors == "strict"


@pytest.mark.parametrize(("error", "code"), [(BrokenPipeError(), 141), (OSError(28, "No space left"), 2)])
def test_a_caller_keeps_its_output(error: OSError, code: int, monkeypatch: pytest.MonkeyPatch) -> None:
    class Notebook(io.StringIO):  # which has no file number
        def flush(self) -> None:
            raise error

    monkeypatch.setattr("sys.stdout", Notebook())
    assert main(["--version"]) == code


def test_the_command_line_starts_light() -> None:
    heavy = ("torch", "rich", "tyro", "matplotlib")
    code = f"import sys, mrta_zoo.cli.main; print(*[m for m in {heavy} if m in sys.modules])"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert loaded.stdout.split() == []


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no /dev/full")
@pytest.mark.parametrize("arguments", ["solve CASE --method nearest", "solve --help", "--version"])
def test_standard_output_that_is_full_or_closed(cases: Path, arguments: str) -> None:
    task_file = next((cases / "group1").glob("*.txt"))
    command = f"{sys.executable} -m mrta_zoo {arguments.replace('CASE', str(task_file))}"
    for unbuffered in ("", "1"):
        environment = {**os.environ, "PYTHONUNBUFFERED": unbuffered}
        full = subprocess.run(
            f"{command} > /dev/full", shell=True, capture_output=True, text=True, timeout=60, env=environment
        )
        assert (full.returncode, full.stderr) == (2, "error: the output: no space left on device\n")
    closed = subprocess.run(f"{command} >&-", shell=True, capture_output=True, text=True, timeout=60)
    assert (closed.returncode, closed.stderr) == (0, "")


@pytest.mark.parametrize("flag", ["--method", "--methods", "--policy"])
@pytest.mark.parametrize("joined", [False, True])
def test_the_flag_of_methods_may_be_spelt_any_way(
    flag: str, joined: bool, cases: Path, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    mission = str(next((cases / "group1").glob("*.txt")))
    monkeypatch.setattr("sys.stdin", io.StringIO("log\n"))

    def spelt(value: str) -> list[str]:
        return [f"{flag}={value}"] if joined else [flag, value]

    for arguments, said in (
        (["solve", mission, *spelt("edf")], "planned by edf"),
        (["eval", "--cases", str(cases), *spelt("edf,nearest")], "nearest"),
        (["step", mission, *spelt("edf")], "edf"),
        (["compare", mission, *spelt("edf,nearest")], "edf"),
        (["replay", mission, *spelt("edf"), "--out", str(tmp_path / "page.html")], "edf replayed"),
    ):
        assert main(arguments) == 0
        assert said in capsys.readouterr().out
    for command in ("reproduce", "converge"):
        assert main([command, "--cases", str(cases), "--out", str(tmp_path / "out"), *spelt("none-such")]) == 2
        assert "there is no method 'none-such'" in capsys.readouterr().err


@pytest.mark.skipif(os.name == "nt", reason="the current folder cannot be deleted there")
def test_a_current_folder_that_was_deleted(tmp_path: Path) -> None:
    for arguments in (["--version"], ["solve", "m.csv"]):
        (tmp_path / "gone").mkdir()
        script = 'rmdir "$PWD"; exec "$0" -m mrta_zoo "$@"'
        done = subprocess.run(
            ["sh", "-c", script, sys.executable, *arguments],
            cwd=tmp_path / "gone", capture_output=True, text=True, timeout=60, check=False,
        )  # fmt: skip
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr == (
            "error: the current folder cannot be used (no such file or directory); expected to be in one that exists\n"
        )
