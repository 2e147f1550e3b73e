"""Nothing that has been worked out is lost because it cannot be written, or bears a name that cannot be."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TextIO

import pytest
from command_line import Captured, fails
from valid_files import TABLE

from mrta_zoo.cli.main import COMMANDS, main
from mrta_zoo.errors import ConfigError, ScenarioError
from mrta_zoo.io import read_cases, read_plan, read_scenario, read_trace
from mrta_zoo.io.outputs import Outputs

NOT_UTF8 = os.fsdecode(b"caf\xe9.csv")


@pytest.fixture
def mission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to work in, with a mission, a folder for outputs, and a place for temporary files."""
    for folder in ("cases", "out", "temporary"):
        (tmp_path / folder).mkdir()
    (tmp_path / "cases" / "m.csv").write_text(TABLE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    return tmp_path


def vanishing(module: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have the folder for outputs go away while the work is done."""
    from importlib import import_module

    real: Callable[..., object] = getattr(import_module(module), name)

    def work(*arguments: object, **options: object) -> object:
        shutil.rmtree("out")
        return real(*arguments, **options)

    monkeypatch.setattr(f"{module}.{name}", work)


def fails_late(capsys: Captured, line: str) -> tuple[str, str]:
    """Run a command that ends with code 2 after it has printed its results; these, and what standard error says."""
    capsys.readouterr()
    assert main(line.split()) == 2
    output = capsys.readouterr()
    assert output.err.startswith("error: ")
    assert output.err.count("\n") == 1
    return output.out, output.err


def rescued(told: str, name: str) -> Path:
    [path] = Path("temporary").glob(f"mrta_zoo.*/{name}")
    assert f"out/{name} cannot be written: no such file or directory; it is in {path.resolve()} instead" in told
    return path


def test_a_plan_is_printed_and_written_elsewhere(
    mission: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    vanishing("mrta_zoo.cli.solve", "solve_and_score", monkeypatch)
    line = "solve cases/m.csv --method nearest --out out/plan.json --plot picture.png"
    printed, told = fails_late(capsys, line)
    assert "completed 2 of 2 tasks" in printed
    assert "plan written" not in printed
    assert "picture written to picture.png" in printed
    assert Path("picture.png").stat().st_size > 1000
    assert read_plan(rescued(told, "plan.json")).routes == ((1, 0),)


@pytest.fixture
def no_reader(mission: Path) -> Iterator[TextIO]:
    """A pipe that nobody reads."""
    reader, writer = os.pipe()
    os.close(reader)
    yield open(writer, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    os.close(writer)


@pytest.mark.skipif(os.name == "nt", reason="pipes without a reader give other errors there")
@pytest.mark.parametrize(
    "line",
    [
        "solve cases/m.csv --method nearest --out out/rows.csv",
        "eval --cases cases --methods nearest --out out/rows.csv",
        "compare cases/m.csv --methods nearest,edf",
    ],
)
def test_the_reader_has_gone(line: str, no_reader: TextIO, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    """What can be written is written, and the exit code says what happened."""
    monkeypatch.setattr("sys.stdout", no_reader)
    assert main(line.split()) == 141
    assert capsys.readouterr().err == ""
    assert ("--out" not in line) or Path("out/rows.csv").exists()


@pytest.mark.skipif(os.name == "nt", reason="pipes without a reader give other errors there")
@pytest.mark.parametrize(
    ("line", "work"),
    [
        ("solve cases/m.csv --method nearest --out out/rows.csv", ("mrta_zoo.cli.solve", "solve_and_score")),
        ("eval --cases cases --methods nearest --out out/rows.csv", ("mrta_zoo.eval.progress", "evaluate")),
    ],
)
def test_the_reader_has_gone_and_something_cannot_be_written(
    line: str, work: tuple[str, str], no_reader: TextIO, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    vanishing(*work, monkeypatch)
    monkeypatch.setattr("sys.stdout", no_reader)
    assert main(line.split()) == 2
    rescued(capsys.readouterr().err, "rows.csv")


@pytest.mark.skipif(os.name == "nt", reason="pipes without a reader give other errors there")
def test_nobody_reads_the_error(no_reader: TextIO, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stderr", no_reader)
    assert main(["solve", "none.csv"]) == 2


def test_a_picture_that_fails_costs_nothing_else(
    mission: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    def fail(*_: object) -> None:
        raise ConfigError("there is no ink")

    monkeypatch.setattr("mrta_zoo.show.plan.picture.save_plan_picture", fail)
    line = "solve cases/m.csv --method nearest --out out/plan.json --plot picture.png"
    printed, told = fails_late(capsys, line)
    assert "completed 2 of 2 tasks" in printed
    assert "plan written to out/plan.json" in printed
    assert told == "error: there is no ink\n"
    assert read_plan("out/plan.json").routes == ((1, 0),)
    assert list(Path("temporary").iterdir()) == []


def test_rows_are_printed_where_they_can_be_written_nowhere(
    mission: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    vanishing("mrta_zoo.eval.progress", "evaluate", monkeypatch)
    line = "eval --cases cases --methods nearest,edf --out out/rows.csv"
    printed, told = fails_late(capsys, line)
    header, *rows = rescued(told, "rows.csv").read_text().splitlines()
    assert header.startswith("case,method,tasks,robots,completed")
    assert [row.split(",")[:2] for row in rows] == [["m", "nearest"], ["m", "edf"]]
    assert "nearest" in printed
    assert header not in printed

    Path("out").mkdir()
    shutil.rmtree("temporary")
    printed, told = fails_late(capsys, line)
    assert told == "error: out/rows.csv cannot be written: no such file or directory\n"
    assert header in printed
    assert "m,nearest,2,1," in printed


def test_comparisons_pages_and_sessions_are_written_elsewhere(
    mission: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    vanishing("mrta_zoo.cli.compare", "compare", monkeypatch)
    printed, told = fails_late(capsys, "compare cases/m.csv --methods nearest,edf --out out/found.json")
    assert "nearest and edf do the same throughout" in printed or "They part" in printed
    assert '"mrta_zoo.comparison"' in rescued(told, "found.json").read_text()

    Path("out").mkdir()
    vanishing("mrta_zoo.cli.planning", "record", monkeypatch)
    _, told = fails_late(capsys, "replay cases/m.csv --policy nearest --out out/page.html")
    assert "<html" in rescued(told, "page.html").read_text()

    Path("out").mkdir()
    Path("commands").write_text("follow\n")
    vanishing("mrta_zoo.cli.step", "run_script", monkeypatch)
    line = "step cases/m.csv --policy nearest --script commands --session out/session.json"
    assert len(read_trace(rescued(fails_late(capsys, line)[1], "session.json")).choices) == 1


def test_a_policy_is_written_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("torch")
    from mrta_zoo.cli.train import train_command
    from mrta_zoo.policies.neural.policy import load_policy
    from mrta_zoo.train import checkpoint

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(checkpoint, "_save", full)
    line = "--preset smoke --tasks 10 --reference-tasks 10 --updates 1 --scenarios 4 --validation-scenarios 4 --out"
    with pytest.raises(ConfigError, match=r"\(No space left on device\); the policy as it is now is in ") as told:
        train_command([*line.split(), str(tmp_path / "run")])
    place = str(told.value).rpartition(" in ")[2]
    assert load_policy(place).info.trained["updates"] == 0


def test_faults_of_ours_are_no_sentence_but_come_last(tmp_path: Path) -> None:
    def fail(_: Path) -> None:
        raise ZeroDivisionError

    printed: list[str] = []

    def write() -> None:
        with Outputs() as outputs:
            assert outputs.write("picture", tmp_path / "picture", fail) is None
            assert outputs.write("plan", tmp_path / "plan", lambda path: path.write_text("1")) == tmp_path / "plan"
            printed.extend(outputs.written)

    with pytest.raises(ZeroDivisionError):
        write()
    assert printed == [f"plan written to {tmp_path / 'plan'}"]


def test_all_that_failed_is_told_in_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "absent"))

    def write() -> None:
        with Outputs() as outputs:
            for name in ("one", "two"):
                assert outputs.write(name, tmp_path / "absent" / name, lambda path: path.write_text("1")) is None

    with pytest.raises(ConfigError, match=r"one cannot be written: .*; .*two cannot be written: no"):
        write()


@pytest.mark.parametrize("command", COMMANDS)
def test_arguments_that_are_not_utf8_are_refused_at_once(command: str, mission: Path, capsys: Captured) -> None:
    told = r"'caf\udce9.csv' is not UTF-8; expected names of files and folders in UTF-8"
    assert told in fails(capsys, [command, NOT_UTF8])
    assert told.replace("caf", "--out=caf") in fails(capsys, [command, f"--out={NOT_UTF8}"])
    assert sorted(os.listdir()) == ["cases", "out", "temporary"]


def test_files_whose_names_are_not_utf8_are_refused_when_read(mission: Path, capsys: Captured) -> None:
    try:
        shutil.copy("cases/m.csv", f"cases/{NOT_UTF8}")
    except OSError:
        pytest.skip("there are no such names here")
    for read in (lambda: read_scenario(f"cases/{NOT_UTF8}"), lambda: read_cases("cases")):
        with pytest.raises(ScenarioError) as caught:
            read()
        assert str(caught.value) == r"cases/caf\udce9.csv: the scenario's name is 'caf\udce9'; expected text in UTF-8"
    for line in (
        "eval --cases cases --methods nearest --out out/rows.csv",
        "reproduce --cases cases --methods nearest --out out/report",
        "converge --cases cases --methods nearest --out out/figure",
    ):
        assert r"cases/caf\udce9.csv: the scenario's name is 'caf\udce9'" in fails(capsys, line.split())
    assert os.listdir("out") == []


def test_a_policy_whose_name_cannot_be_written_is_refused(mission: Path) -> None:
    pytest.importorskip("torch")
    from mrta_zoo.policies.neural.policy import load_policy
    from mrta_zoo.train import checkpoint
    from mrta_zoo.train.config import TrainConfig

    with pytest.raises(ConfigError, match=r"the policy's name is 'a.x1bb'; expected text without control characters"):
        checkpoint.start(Path("a\x1bb"), TrainConfig())  # before it is trained
    with pytest.raises(ConfigError, match=r"the policy's name is 'caf.udce9'; expected text in UTF-8"):
        load_policy("caf\udce9.safetensors")
    with pytest.raises(ConfigError, match=r"the policy's name is 'a.x1bb'; expected text without control characters"):
        load_policy("a\x1bb.safetensors")
