"""The command ``mrta-zoo replay``."""

from __future__ import annotations

from pathlib import Path

import pytest
from factories import small_scenario

from mrta_zoo import Plan
from mrta_zoo.cli.main import main
from mrta_zoo.debug.recorder import record
from mrta_zoo.io import write_plan, write_scenario, write_trace

SCENARIO = small_scenario(3)


@pytest.fixture(autouse=True)
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write_scenario(SCENARIO, "case.json")
    trace = record(SCENARIO, "edf")
    write_trace(trace, "trace.json")
    write_plan(trace.plan(), "plan.json")
    write_plan(Plan.of([[0]]), "short.json")
    Path("commands").write_text("log\n")
    Path("pointer.json").write_text("version https://git-lfs.github.com/spec/v1\noid sha256:0\n")


@pytest.mark.parametrize(
    ("arguments", "shown"),
    [
        ("case.json --policy nearest", "nearest"),
        ("case.json --policy nearest,trace.json", "nearest and edf"),
        ("case.json --policy plan.json,random --seed 3", "edf and random"),
        ("trace.json", "edf"),
        ("trace.json --policy nearest", "edf and nearest"),
        ("plan.json --scenario case.json", "edf"),
    ],
)
def test_pages(arguments: str, shown: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replay", *arguments.split(), "--out", "page.html"]) == 0
    assert f"small: {shown} replayed in page.html" in capsys.readouterr().out
    page = Path("page.html").read_text(encoding="utf-8")
    assert [method in page for method in shown.split(" and ")] == [True] * len(shown.split(" and "))


def test_a_trained_policy_by_default(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replay", "case.json"]) == 0
    assert "small: capam-plus replayed in replay.html" in capsys.readouterr().out
    assert '"probability":null' not in Path("replay.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ("plan.json", "plan.json is a plan, which does not hold its scenario; expected --scenario SCENARIO"),
        ("trace.json --scenario case.json", "--scenario is given with a trace, which holds its scenario"),
        ("case.json --scenario case.json", "--scenario is given, and case.json is no plan"),
        ("case.json --policy nearest,edf,random", "that makes 3 episodes; expected 2 at most"),
        ("trace.json --policy nearest,edf", "that makes 3 episodes"),
        ("case.json --policy nearest --out case.json", "--out is case.json, which is the source"),
        ("case.json --policy trace.json --out trace.json", "--out is trace.json, which is the file trace.json"),
        ("absent.json", "absent.json: there is no such file"),
        ("case.json --policy unheard-of", "there is no method 'unheard-of'"),
        ("case.json --policy absent.json", "absent.json: there is no such file"),
        ("case.json --policy nearest,pointer.json", "pointer.json is a pointer of Git LFS; expected the file itself"),
        ("case.json --policy case.json", "case.json: format is 'mrta_zoo.scenario'"),
        ("short.json --scenario case.json", "short.json: "),
        ("case.json --policy short.json", "short.json: "),
        ("plan.json --scenario case.json --policy short.json", "short.json: "),
    ],
)
def test_errors(arguments: str, sentence: str, capsys: pytest.CaptureFixture[str]) -> None:
    before = {path: path.read_bytes() for path in Path().iterdir()}
    assert main(["replay", *arguments.split()]) == 2
    assert sentence in capsys.readouterr().err
    assert {path: path.read_bytes() for path in Path().iterdir()} == before


@pytest.mark.parametrize(
    "command", ["step case.json --policy short.json --script commands", "compare case.json --methods short.json,edf"]
)
def test_a_plan_that_does_not_fit_is_named(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(command.split()) == 2
    assert capsys.readouterr().err.startswith("error: short.json: ")
