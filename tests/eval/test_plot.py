"""The picture of a plan holds every task, in the right place and mark."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from matplotlib.patches import Rectangle

from mrta_zoo.errors import ConfigError, MissingExtraError, PlanError
from mrta_zoo.eval.plot_plan import draw_plan, save_plan_picture
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.plan import Plan
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.scenario import Scenario

# Robot 0 at (0, 0): task 0 at 10, done at 10 + 5 = 15; task 1 at 15 + 20 = 35, done at 40 > 38: late.
SCENARIO = Scenario(
    task_xy=np.array([(10.0, 0.0), (30.0, 0.0), (50.0, 50.0)]),
    deadline=np.array([20.0, 38.0, 90.0]),
    workload=np.full(3, 5.0),
    robot_xy=np.array([(0.0, 0.0), (90.0, 90.0)]),
    capacity=np.ones(2),
    name="small",
)
PLAN = Plan.of([(0, 1), ()], "small", "by hand")


def test_the_picture_says_what_the_plan_does() -> None:
    figure = draw_plan(SCENARIO, PLAN)
    routes, times = figure.axes
    assert figure.get_suptitle() == ("small, planned by by hand: 1 of 3 tasks completed (33.3 %), 1 late, 1 not taken")
    bars = [patch for patch in times.patches if isinstance(patch, Rectangle)]
    assert sorted((bar.get_x(), bar.get_x() + bar.get_width()) for bar in bars) == [(10, 15), (35, 40)]
    assert [label.get_text() for label in times.get_yticklabels()] == ["robot 0\n1 of 2", "robot 1\n0 of 0"]
    (way,) = (line.get_xydata().tolist() for line in routes.lines if len(line.get_xydata()) > 1)
    assert way == [[0, 0], [10, 0], [30, 0]]
    places = [collection.get_offsets().tolist() for collection in routes.collections]
    for mark in ([[10, 0]], [[30, 0]], [[50, 50]]):  # completed, late, not taken
        assert mark in places


def test_late_tasks_are_marked_without_colour() -> None:
    times = draw_plan(SCENARIO, PLAN).axes[1]
    assert [bar.get_hatch() for bar in times.patches] == [None, "////"]


@pytest.mark.parametrize(("suffix", "magic"), [(".png", b"\x89PNG"), (".svg", b"<?xml"), (".PDF", b"%PDF")])
def test_formats(tmp_path: Path, suffix: str, magic: bytes) -> None:
    path = tmp_path / f"plan{suffix}"
    save_plan_picture(SCENARIO, PLAN, path)
    assert path.read_bytes().startswith(magic)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(("tasks", "robots"), [(1, 1), (40, 12), (300, 60)])
def test_any_size_draws(tmp_path: Path, tasks: int, robots: int) -> None:
    scenario = UniformGenerator(tasks=tasks, robots=robots)(np.random.default_rng(0))  # type: ignore[arg-type]
    save_plan_picture(scenario, make_solver("edf", mask_rule="active").solve(scenario), tmp_path / "plan.png")


def test_errors(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"has the suffix '.xyz'; expected one of .*\.png"):
        save_plan_picture(SCENARIO, PLAN, tmp_path / "plan.xyz")
    with pytest.raises(ConfigError, match="cannot be written: no such file or directory"):
        save_plan_picture(SCENARIO, PLAN, tmp_path / "absent" / "plan.png")
    with pytest.raises(PlanError):
        save_plan_picture(SCENARIO, Plan.of([(0, 0), ()]), tmp_path / "plan.png")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("module", ["eval.plot_plan", "eval.plot_history"])
def test_without_matplotlib_it_names_the_extra(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    for name in [name for name in sys.modules if name.startswith("matplotlib.")]:
        monkeypatch.setitem(sys.modules, name, None)
    for name in (module, "eval.figure"):
        monkeypatch.delitem(sys.modules, f"mrta_zoo.{name}", raising=False)
    with pytest.raises(MissingExtraError, match=r'needs matplotlib.*pip install "mrta_zoo\[plot\]"'):
        importlib.import_module(f"mrta_zoo.{module}")
