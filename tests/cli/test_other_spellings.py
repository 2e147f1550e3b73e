"""A byte order mark and a suffix in capital letters, as other systems write them, make no difference to any reader."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path

import pytest
from command_line import Captured
from valid_files import TABLE

from mrta_zoo.cli.main import main
from mrta_zoo.debug.recorder import record
from mrta_zoo.eval.experiment import MANIFEST, open_folder
from mrta_zoo.eval.manifest import Manifest
from mrta_zoo.eval.rows_file import RowsFile
from mrta_zoo.io import read_plan, read_trace, write_plan, write_trace
from mrta_zoo.io.files import read_scenario
from mrta_zoo.io.json_format import json_kind

MARK = b"\xef\xbb\xbf"


def mark(path: Path) -> None:
    path.write_bytes(MARK + path.read_bytes())


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A mission, its plan and its trace."""
    (tmp_path / "M.CSV").write_bytes(MARK + TABLE.encode())
    scenario = read_scenario(tmp_path / "M.CSV")
    trace = record(scenario, "edf")
    write_trace(trace, tmp_path / "T.JSON")
    write_plan(trace.plan(), tmp_path / "P.JSON")
    for name in ("T.JSON", "P.JSON"):
        mark(tmp_path / name)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_plans_and_traces(files: Path, capsys: Captured) -> None:
    assert (json_kind(files / "P.JSON"), json_kind(files / "T.JSON")) == ("mrta_zoo.plan", "mrta_zoo.trace")
    assert read_trace("T.JSON").plan() == read_plan("P.JSON")
    for line in (
        "compare M.CSV --methods P.JSON,T.JSON",
        "step M.CSV --policy P.JSON --script commands",
        "step M.CSV --policy T.JSON --script commands",
        "step --session T.JSON --script commands",
    ):
        (files / "commands").write_bytes(MARK + b"log\n")
        assert main(line.split()) == 0, line
    for line in ("replay P.JSON --scenario M.CSV", "replay T.JSON", "replay M.CSV --policy P.JSON,T.JSON"):
        assert main(line.split()) == 0, line
    told = capsys.readouterr()
    assert told.err == ""
    assert "M: edf and edf replayed in replay.html" in told.out
    assert main(["replay", "M.CSV", "--policy", "P.JSON", "--out", "P.JSON"]) == 2
    assert "is the file P.JSON; expected a file of its own" in capsys.readouterr().err


def test_all_cases_of_a_folder_count(files: Path, capsys: Captured) -> None:
    (files / "b.csv").write_text(TABLE)
    assert main(["eval", "--cases", ".", "--methods", "nearest", "--out", "R.CSV"]) == 0
    assert [line.split(",")[0] for line in (files / "R.CSV").read_text().splitlines()] == ["case", "M", "b"]


def test_commands_that_are_piped(files: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    for data, code, says in (
        (MARK + b"f 1\r\nlog\r\n", 0, "decision 1: robot 0 chooses at"),
        (b"f 1\nsave caf\xe9\n", 2, "standard input, line 2: byte 0xe9 is not UTF-8; expected UTF-8 text"),
    ):
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(data), encoding="ascii"))
        assert main(["step", "M.CSV", "--policy", "nearest"]) == code
        told = capsys.readouterr()
        assert says in told.out + told.err


def test_policies_and_runs(tmp_path: Path) -> None:
    pytest.importorskip("torch")
    from mrta_zoo.cli.methods import files_of_methods
    from mrta_zoo.eval.manifest import digest_of_weights
    from mrta_zoo.policies.neural.capam.config import NetworkConfig
    from mrta_zoo.policies.neural.policy import load_policy
    from mrta_zoo.policies.neural.sharing import build_network
    from mrta_zoo.policies.neural.weights import PolicyInfo, save_policy
    from mrta_zoo.policies.registry import make_solver
    from mrta_zoo.train import checkpoint
    from mrta_zoo.train.config import TrainConfig

    config = NetworkConfig(embedding=32, heads=4)
    save_policy(tmp_path / "p.safetensors", build_network(config, "shared", 1, seed=0), PolicyInfo(network=config))
    mark(tmp_path / "p.json")
    for suffix in ("safetensors", "json"):
        (tmp_path / f"p.{suffix}").rename(tmp_path / f"P.{suffix.upper()}")
    place = tmp_path / "P.SAFETENSORS"
    assert load_policy(place).name == "P"
    assert make_solver(str(place)) is not None
    assert set(files_of_methods([f"{place}+polish"]).values()) == {place, tmp_path / "P.JSON"}
    assert len(digest_of_weights(str(place))) == 64

    place.with_suffix(".JSON").rename(tmp_path / "P.Json")
    assert load_policy(place).name == "P"
    capital = tmp_path / "capital"
    capital.mkdir()
    place.rename(capital / "POLICY.SAFETENSORS")
    (tmp_path / "P.Json").rename(capital / "POLICY.JSON")
    assert load_policy(capital).name == "capital"
    assert make_solver(str(capital)) is not None
    assert set(files_of_methods([str(capital)]).values()) == {capital / "POLICY.SAFETENSORS", capital / "POLICY.JSON"}

    checkpoint.start(tmp_path / "run", TrainConfig(updates=7, network=config))
    mark(tmp_path / "run" / "config.json")
    assert checkpoint.saved_config(tmp_path / "run").updates == 7


def test_histories(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    from mrta_zoo.eval.plot_history import main as draw
    from mrta_zoo.eval.plot_history import read_history

    (tmp_path / "H.CSV").write_bytes(MARK + b"update,episodes,completion\r\n0,0,0.25\r\n5,80,0.5\r\n,,\r\n")
    assert read_history(tmp_path / "H.CSV").updates == (0, 5)
    draw((tmp_path / "H.CSV",), out=tmp_path / "C.PNG")
    assert (tmp_path / "C.PNG").read_bytes().startswith(b"\x89PNG")


@dataclass(frozen=True)
class Measured:
    case: str
    value: int


def test_what_is_resumed(tmp_path: Path) -> None:
    RowsFile(tmp_path / "rows.csv", Measured).append(Measured("cafe\u0301", 1))
    mark(tmp_path / "rows.csv")
    with (tmp_path / "rows.csv").open("a") as file:
        file.write(",\n")
    again = RowsFile(tmp_path / "rows.csv", Measured)
    again.append(Measured("b", 2))
    assert RowsFile(tmp_path / "rows.csv", Measured).rows == [Measured("caf\u00e9", 1), Measured("b", 2)]

    manifest = Manifest(command="c", settings={"cases": "caf\u00e9"}, cases="", weights={})
    open_folder(tmp_path / "folder", manifest)
    path = tmp_path / "folder" / MANIFEST
    path.write_bytes(MARK + path.read_bytes().replace("caf\u00e9".encode(), "cafe\u0301".encode()))
    open_folder(tmp_path / "folder", manifest)
