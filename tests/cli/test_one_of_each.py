"""One task, one robot, one case: nothing is said of "1 tasks"."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from command_line import Captured

from mrta_zoo import mrta_v0
from mrta_zoo.cli.main import main
from mrta_zoo.debug import Stepper
from mrta_zoo.errors import MrtaError
from mrta_zoo.io import write_scenario
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify
from mrta_zoo.wording import counted

LONE = Scenario(task_xy=[[3, 4]], deadline=[20], workload=[2], robot_xy=[[0, 0]], capacity=[1], name="lone")
WRONG = re.compile(r"(?<![\d.,])1 (?:[a-z]+s|entries|capacities)\b")


def test_counted() -> None:
    assert [counted(number, "case") for number in (0, 1, 2)] == ["0 cases", "1 case", "2 cases"]
    assert counted(2, "entry", "entries") == "2 entries"
    assert counted(12345, "plan", form=",") == "12,345 plans"


@pytest.mark.parametrize(
    "arguments",
    [
        ["solve", "cases/lone.json", "--method", "nearest"],
        ["solve", "cases/lone.json", "--method", "exact"],
        ["eval", "--cases", "cases", "--methods", "nearest", "--out", "out/rows.csv"],
        ["step", "cases/lone.json", "--policy", "nearest", "--session", "out/s.json", "--script", "script.txt"],
        ["compare", "cases/lone.json", "--methods", "nearest,edf"],
        ["generate", "--count", "1", "--tasks", "1", "--robots", "1", "--out", "out/cases"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_commands(arguments: list[str], tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("scipy")
    (tmp_path / "cases").mkdir()
    (tmp_path / "out").mkdir()
    write_scenario(LONE, tmp_path / "cases" / "lone.json")
    (tmp_path / "script.txt").write_text("show\nrobots\nfollow\nlog\nsave\nend\n")
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 0
    said = capsys.readouterr().out
    assert re.search(r"\b1 (task|case|row|scenario)\b", said) or arguments[0] == "eval"
    assert WRONG.findall(said) == []


def test_python() -> None:
    plan = Plan(((0,),), "lone", "hand")
    shown = [repr(LONE), LONE._repr_html_(), plan._repr_html_(), verify(LONE, plan)._repr_html_()]
    env = mrta_v0.raw_env(scenario=LONE, render_mode="ansi")
    env.reset()
    shown.append(env.render())
    stepper = Stepper(LONE, "nearest")
    stepper.finish()
    for wrong in (lambda: stepper.take(0), lambda: verify(LONE, Plan(((0,), ())))):
        with pytest.raises(MrtaError) as caught:
            wrong()
        shown.append(str(caught.value))
    with pytest.raises(MrtaError) as caught:
        Scenario(task_xy=np.zeros((2, 2)), deadline=[20], workload=[2], robot_xy=[[0, 0]], capacity=[1])
    shown.append(str(caught.value))
    assert [WRONG.findall(text) for text in shown] == [[]] * len(shown)
