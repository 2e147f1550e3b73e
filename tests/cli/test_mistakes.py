"""What the command line says of mistakes: one sentence, code 2, and nothing is written."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from command_line import Captured, fails, refused, stand_in

from mrta_zoo.errors import ScenarioError


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["fly"], "there is no command 'fly'; expected one of solve, eval"),
        (["--fly"], "there is no option '--fly'"),
        (["solve", "absent.txt", "--method", "nearest"], "absent.txt"),
        (["solve", "CASE", "--method", "fastest"], "there is no method 'fastest'; expected one of random"),
        (["solve", "CASE", "--method", "nearest", "--budget", "-1"], "budget is -1"),
        (["solve", "CASE", "--method", "nearest", "--seed", "-1"], "seed is -1"),
        (["solve", "CASE", "--method", "nearest", "--samples", "0"], "samples is 0"),
        (["solve", "CASE", "--method", "nearest", "--threads", "0"], "threads is 0"),
        (
            ["solve", "CASE", "--method", "nearest", "--threads", "99999999999"],
            "expected a whole number from 1 to 1024",
        ),
        (["solve", "CASE", "--method", "nearest", "--seed", "9" * 23], "expected a whole number from 0 to 922337"),
        (["solve", "CASE", "--method", "nearest", "--out", "CASE"], ", which is the task file; expected a file of its"),
        (["solve", "CASE", "--method", "nearest", "--out", "AGENTS"], ", which is the agent file; expected a file of"),
        (["replay", "CASE", "--policy", "nearest", "--out", "AGENTS"], ", which is the agent file; expected a file of"),
        (["compare", "CASE", "--methods", "nearest,edf", "--out", "AGENTS"], ", which is the agent file; expected a"),
        (
            ["solve", "CASE", "--method", "nearest", "--out", "x.svg", "--plot", "./x.svg"],
            "which is also --out; expected",
        ),
        (["solve", "x" * 300, "--method", "nearest"], "file name too long"),
        (["solve", "CASE", "--method", "x" * 300], "there is no method 'xxx"),
        (["eval", "--cases", "x" * 300, "--methods", "nearest"], "does not exist"),
        (["solve", "CASE", "--method", "nearest", "--agents", "absent.txt"], "absent.txt: there is no such file"),
        (["solve", "CASE", "--method", "nearest", "--out", "absent/plan.json"], "absent does not exist"),
        (["solve", "CASE", "--method", "nearest", "--out", "."], "is a folder"),
        (["solve", "CASE", "--method", "nearest", "--plot", "plan.doc"], "has the suffix '.doc'"),
        (["solve", "CASE", "--method", "nearest", "--plot", "absent/plan.png"], "absent does not exist"),
        (["solve", "EMPTY", "--method", "nearest"], "is empty"),
        (["eval", "--cases", "absent", "--methods", "nearest"], "absent does not exist"),
        (["eval", "--cases", "HOLLOW", "--methods", "nearest"], "holds no cases"),
        (["eval", "--cases", "builtin", "--methods", "nearest,fastest"], "there is no method 'fastest'"),
        (["eval", "--cases", "builtin", "--methods", ","], "expected names separated by commas"),
        (["eval", "--cases", "builtin", "--methods", "edf,edf"], "edf is named twice"),
        (["eval", "--cases", "builtin", "--methods", "edf", "--out", "CASE/rows.csv"], "is not a folder"),
        (
            ["eval", "--cases", "DATA", "--methods", "nearest", "--out", "CASE"],
            "of the cases; expected a file of its own",
        ),
        (["generate", "--out", "DATA"], "is not empty"),
        (["generate", "--out", "new", "--count", "0"], "count is 0"),
        (["generate", "--out", "new", "--seed", "-3"], "seed is -3"),
        (["generate", "--out", "new", "--seed", "9" * 23], "expected a whole number from 0 to 9223372036854775807"),
        (["generate", "--out", "new", "--tasks", "10000000000"], "whole numbers from 1 to 1000000"),
        (["generate", "--out", "new", "--robots", "99999999999"], "whole numbers from 1 to 1000000"),
        (["generate", "--out", "x" * 300], "file name too long"),
        (["generate", "--out", "new", "--robots", "7-2"], "robots is (7.0, 2.0)"),
        (["generate", "--out", "new", "--tasks", "many"], "tasks is 'many'"),
        (["generate", "--out", "new", "--deadline", "50-60"], "has no field 'deadline'"),
        (["generate", "--out", "new", "--generator", "uniform", "--speed", "2"], "TAPTC files hold no speeds"),
        (["demo", "--policy", "fastest"], "there is no policy 'fastest'"),
    ],
)
def test_mistakes_get_a_sentence(
    arguments: list[str], complaint: str, cases: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    if arguments[0] == "demo":
        pytest.importorskip("torch")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "EMPTY").write_text("")
    (tmp_path / "HOLLOW").mkdir()
    task_file = str(next((cases / "group1").glob("*.txt")))
    agent_file = task_file.replace("group1", "agent")
    written = [
        word.replace("CASE", task_file).replace("AGENTS", agent_file).replace("DATA", str(cases)) for word in arguments
    ]
    assert complaint in fails(capsys, written)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["EMPTY", "HOLLOW"]


@pytest.mark.parametrize("command", ["solve", "eval", "replay", "compare"])
@pytest.mark.parametrize("suffix", ["safetensors", "json"])
def test_no_policy_is_written_over(command: str, suffix: str, cases: Path, tmp_path: Path, capsys: Captured) -> None:
    for ending in ("safetensors", "json"):
        (tmp_path / f"policy.{ending}").write_text("precious")
    target = tmp_path / f"policy.{suffix}"
    for policy in (str(tmp_path), str(tmp_path / "policy.safetensors"), f"{tmp_path}+polish"):
        task_file = str(next((cases / "group1").glob("*.txt")))
        what = {
            "solve": [task_file, "--method", policy],
            "eval": ["--cases", str(cases), "--methods", policy],
            "replay": [task_file, "--policy", policy],
            "compare": [task_file, "--methods", f"nearest,{policy}"],
        }[command]
        assert "weights of" in fails(capsys, [command, *what, "--out", str(target)])
    assert target.read_text() == "precious"


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["solve"], "TASKFILE"),
        (["solve", "x.txt", "--decode", "beams"], "--decode"),
        (["solve", "x.txt", "--budget", "long"], "--budget"),
        (["solve", "x.txt", "--mask-rule", "any"], "--mask-rule"),
        (["eval", "--methods", "nearest"], "--cases"),
        (["generate"], "--out"),
        (["generate", "--out", "x", "--format", "xml"], "--format"),
        (["demo", "now"], "now"),
    ],
)
def test_wrong_values_are_refused(arguments: list[str], complaint: str, capsys: Captured) -> None:
    assert complaint in refused(capsys, arguments)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission(cases: Path, tmp_path: Path, capsys: Captured) -> None:
    tmp_path.chmod(0o500)
    arguments = ["eval", "--cases", str(cases), "--methods", "nearest", "--out", str(tmp_path / "rows.csv")]
    assert "no permission" in fails(capsys, arguments)


@pytest.mark.parametrize(
    ("problem", "complaint"),
    [
        (PermissionError(13, "Permission denied", "some/file"), "error: some/file: permission denied\n"),
        (OSError(28, "No space left on device"), "error: the output: no space left on device\n"),
        (MemoryError(), "error: not enough memory for this command; expected"),
        (RuntimeError("DefaultCPUAllocator: can't allocate memory: you tried to"), "error: not enough memory for this"),
        (RuntimeError("CUDA out of memory. Tried to allocate"), "error: not enough memory for this command; expected"),
        (RecursionError(), "nested too deeply; expected"),
        (ScenarioError("a\x1b[31m.json: two\nlines"), "error: a\\x1b[31m.json: two lines\n"),
    ],
)
def test_what_no_command_foresees(
    problem: Exception, complaint: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    def fail(argv: list[str]) -> None:
        raise problem

    stand_in("solve", fail, monkeypatch)
    assert complaint in fails(capsys, ["solve"])
