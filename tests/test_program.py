"""How programs of ours end without a traceback, and what programs of others see of it."""

from __future__ import annotations

import os
import runpy
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from command_line import Captured

from mrta_zoo.program import _is_ours


def run_interrupted(arguments: list[str], folder: Path) -> tuple[int, str]:
    """Run Python, whose Ctrl-C comes when gymnasium is imported; the exit code, and the end of standard error."""
    (folder / "gymnasium.py").write_text("raise KeyboardInterrupt\n")
    ended = subprocess.run(
        [sys.executable, *arguments], env={**os.environ, "PYTHONPATH": str(folder)}, capture_output=True, text=True,
        timeout=60, check=False,
    )  # fmt: skip
    return ended.returncode, ended.stderr


@pytest.mark.skipif(os.name == "nt", reason="other exit codes there")
@pytest.mark.parametrize("module", ["mrta_zoo", "mrta_zoo.train.aec_reinforce"])
def test_programs_of_ours_show_no_traceback(module: str, tmp_path: Path) -> None:
    assert run_interrupted(["-m", module, "--help"], tmp_path) == (-signal.SIGINT, "interrupted\n")


def test_programs_of_others_do(tmp_path: Path) -> None:
    assert "Traceback" in run_interrupted(["-c", "import mrta_zoo"], tmp_path)[1]


def test_errors_are_sentences() -> None:
    command = [sys.executable, "-m", "mrta_zoo.eval.benchmarks.aec_turns", "--turns", "0"]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (ended.returncode, ended.stdout) == (2, "")
    assert ended.stderr == "error: turns is 0; expected a whole number >= 1\n"


@pytest.mark.parametrize(
    ("script", "started", "ours"),
    [
        ("/usr/bin/mrta-zoo", ["python", "/usr/bin/mrta-zoo", "solve"], True),
        ("mrta-zoo.exe", ["python.exe", "mrta-zoo.exe"], True),
        ("-m", ["python", "-X", "dev", "-m", "mrta_zoo", "solve"], True),
        ("-m", ["python", "-m", "mrta_zoo.eval.plot_history", "-m"], True),
        ("-m", ["python", "-m", "pytest", "mrta_zoo"], False),
        ("", ["python"], False),
        ("-m", ["python", "-m"], False),
        ("mine.py", ["python", "mine.py", "mrta-zoo"], False),
    ],
)
def test_which_are_ours(script: str, started: list[str], ours: bool) -> None:
    assert _is_ours(script, started) == ours


def test_the_example_trainer_explains_itself(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    aec_reinforce = pytest.importorskip("mrta_zoo.train.aec_reinforce")
    monkeypatch.setattr("sys.argv", ["aec_reinforce", "--help"])
    with pytest.raises(SystemExit) as exit_:
        runpy.run_path(aec_reinforce.__file__, run_name="__main__")
    assert exit_.value.code == 0
    output = capsys.readouterr()
    assert output.out.startswith("usage: ")
    assert "--updates" in output.out


@pytest.mark.parametrize("module", ["eval.plot_history", "eval.benchmarks.aec_turns", "train.aec_reinforce"])
def test_modules_that_are_run(module: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    pytest.importorskip("matplotlib" if module == "eval.plot_history" else "torch")
    monkeypatch.setattr(sys, "argv", [module, "--ou", "3"])
    monkeypatch.delitem(sys.modules, f"mrta_zoo.{module}", raising=False)
    with pytest.raises(SystemExit) as exit_:
        runpy.run_module(f"mrta_zoo.{module}", run_name="__main__")
    assert exit_.value.code == 2
    assert "--ou" in capsys.readouterr().err
