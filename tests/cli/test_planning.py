"""Flags that have no effect beside others: what contradicts a session is refused, what is merely idle is said."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import Captured, fails
from valid_files import TABLE

from mrta_zoo.cli.main import main
from mrta_zoo.policies.registry import make_solver


@pytest.fixture(autouse=True)
def mission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for place in (Path("m.csv"), Path("cases") / "m.csv"):
        place.parent.mkdir(exist_ok=True)
        place.write_text(TABLE)
    Path("script").write_text("log\n")


@pytest.mark.parametrize(
    ("line", "warnings"),
    [
        ("solve m.csv --method nearest --budget 1", ["nearest does not use --budget"]),
        ("solve m.csv --method nearest --mask-rule active", []),
        ("solve m.csv --method edf --decode beam --samples 3",
         ["edf does not use --decode", "edf does not use --samples"]),
        ("eval --cases cases --methods nearest,edf --budget 1", ["nearest and edf do not use --budget"]),
        ("compare m.csv --methods nearest,edf --budget 1", ["nearest and edf do not use --budget"]),
        ("step m.csv --policy nearest --script script --budget 1", ["nearest does not use --budget"]),
        ("step m.csv --policy none --script script --mask-rule active", []),
    ],
)  # fmt: skip
def test_what_nobody_uses_is_said(line: str, warnings: list[str], capsys: Captured) -> None:
    assert main(line.split()) == 0
    assert capsys.readouterr().err.splitlines() == [f"warning: {each}" for each in warnings]


def test_who_uses_what(capsys: Captured) -> None:
    pytest.importorskip("numba")
    line = "eval --cases cases --methods nearest,ils,edf+polish --budget 0.01 --mask-rule active"
    assert main(line.split()) == 0
    assert capsys.readouterr().err == ""
    assert main(["solve", "m.csv", "--method", "ils", "--mask-rule", "active"]) == 0
    assert capsys.readouterr().err == "warning: ils does not use --mask-rule\n"


def test_what_a_session_holds_already(capsys: Captured) -> None:
    assert main(["step", "m.csv", "--policy", "nearest", "--script", "script", "--session", "s.json"]) == 0
    again = ["step", "--session", "s.json", "--script", "script"]
    assert "--mask-rule is active, but s.json is a session with the mask rule feasible" in fails(
        capsys, [*again, "--mask-rule", "active"]
    )
    assert "--agents is given without a scenario" in fails(capsys, [*again, "--agents", "m.csv"])
    assert main([*again, "--mask-rule", "feasible"]) == 0


def test_samples_are_drawn(capsys: Captured) -> None:
    pytest.importorskip("torch")
    assert make_solver("capam", samples=3).options.decode == "sample"  # type: ignore[attr-defined]
    assert make_solver("capam").options.decode == "greedy"  # type: ignore[attr-defined]
    for decode, told in (("greedy", "warning: capam does not use --samples\n"), ("beam", "")):
        assert main(["solve", "m.csv", "--method", "capam", "--decode", decode, "--samples", "3"]) == 0
        assert capsys.readouterr().err == told
