"""The command line: what it prints and writes, and how it ends."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from command_line import Captured

from mrta_zoo import __version__
from mrta_zoo.cli.main import COMMANDS, main


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
