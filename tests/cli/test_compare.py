"""The command ``mrta-zoo compare``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command_line import SCENARIO, Captured, fails

from mrta_zoo.cli.main import main
from mrta_zoo.debug import compare, record
from mrta_zoo.io import write_plan
from mrta_zoo.plan import Plan


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
    assert f"choose differently at {len(found.disagreements)} of {len(found.traces[0].choices)} decisions" in output
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
