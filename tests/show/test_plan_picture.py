"""The picture of a plan holds every task, in the right place and mark."""

from __future__ import annotations

import importlib
import re
import sys
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.transforms import Bbox

from mrta_zoo.errors import ConfigError, MissingExtraError, PlanError
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.plan import Plan
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.lettering import text_width
from mrta_zoo.show.palette import GROUND, robot_colour
from mrta_zoo.show.plan.picture import draw_plan, save_plan_picture

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


def test_a_name_from_right_to_left_leaves_the_title_in_order() -> None:
    title = draw_plan(replace(SCENARIO, name="שער 5"), PLAN).get_suptitle()
    assert title.startswith("\u2068שער 5\u2069, planned by by hand: 1 of 3")


def test_of_one_task_the_title_says_so() -> None:
    one = Scenario(task_xy=[[5, 5]], deadline=[90], workload=[1], robot_xy=[[0, 5]], capacity=[1])
    assert ": 1 of 1 task completed (100.0 %)" in draw_plan(one, Plan.of([(0,)])).get_suptitle()


def test_a_long_name_leaves_room_for_what_else_the_title_says() -> None:
    title = draw_plan(replace(SCENARIO, name="N" * 300), PLAN).get_suptitle()
    assert title.startswith("NNNN")
    assert "…" in title
    assert title.endswith("not taken")
    assert text_width(title, 13.0, "bold") < 17 * 72


def test_late_tasks_are_marked_without_colour() -> None:
    times = draw_plan(SCENARIO, PLAN).axes[1]
    assert [bar.get_hatch() for bar in times.patches] == [None, "////"]


def lines_to_deadlines(figure: Figure) -> list[list[list[float]]]:
    """The ways from bars to deadlines: three corners each."""
    times = figure.axes[1]
    ways = [
        way.tolist() for each in times.collections if isinstance(each, LineCollection) for way in each.get_segments()
    ]
    return [way for way in ways if len(way) == 3]


def test_each_deadline_is_joined_to_its_task() -> None:
    figure = draw_plan(SCENARIO, PLAN)
    bars = {bar.get_x() + bar.get_width(): bar for bar in figure.axes[1].patches}
    (early, early_corner, early_due), (late, late_corner, late_due) = lines_to_deadlines(figure)
    assert (early[0], early_corner[0], early_due[0]) == (15, 15, 20)  # from the end of the bar to the deadline
    assert early[1] == bars[15].get_y() + bars[15].get_height() < early_corner[1] == early_due[1]  # below it
    assert (late[0], late_corner[0], late_due[0]) == (40, 40, 38)
    assert late[1] == bars[40].get_y() > late_corner[1] == late_due[1]  # above it


def test_bars_that_touch_are_kept_apart() -> None:
    two = Scenario(task_xy=[[5, 5], [5, 5]], deadline=[90, 90], workload=[30, 30], robot_xy=[[0, 5]], capacity=[1])
    first, second = draw_plan(two, Plan.of([(0, 1)])).axes[1].patches
    assert first.get_x() + first.get_width() == second.get_x() == 35
    assert {to_hex(bar.get_edgecolor()) for bar in (first, second)} == {GROUND}
    assert min(bar.get_linewidth() for bar in (first, second)) >= 1.0


def test_a_mere_visit_is_seen() -> None:
    visit = Scenario(task_xy=[[5, 5]], deadline=[90], workload=[0], robot_xy=[[0, 5]], capacity=[1])
    (bar,) = draw_plan(visit, Plan.of([(0,)])).axes[1].patches
    assert to_hex(bar.get_edgecolor()) == robot_colour(0)


def test_names_are_where_they_fit_and_numbers_are_whole() -> None:
    named = replace(
        SCENARIO, task_names=("valve-A", "survey point of the north field", "C"), robot_names=("Spot", "R2")
    )
    routes, times = draw_plan(named, Plan.of([(0, 1, 2), ()])).axes
    assert {"valve-A", "C"} <= {text.get_text() for text in routes.texts}
    assert [label.get_text() for label in times.get_yticklabels()] == ["Spot\n1 of 3", "R2\n0 of 0"]
    crowd = UniformGenerator(tasks=(150, 150), robots=(1, 1))(np.random.default_rng(0))
    for axes in draw_plan(crowd, Plan.of([tuple(range(150))])).axes:
        assert {text.get_text() for text in axes.texts} <= {*map(str, range(150)), ""}


def test_the_height_follows_the_robots() -> None:
    heights = []
    for robots in (1, 3, 10, 20, 500):
        scenario = UniformGenerator(tasks=(20, 20), robots=(robots, robots))(np.random.default_rng(0))
        heights.append(draw_plan(scenario, Plan.of([[]] * robots)).get_figheight())
    assert heights == sorted(heights)
    assert heights[0] < 6.0
    assert heights[3] > 1.7 * heights[2]
    assert heights[-1] < 41.0


@pytest.mark.parametrize("robots", [1, 3, 20])
def test_nothing_lies_on_anything_else(robots: int) -> None:
    scenario = UniformGenerator(tasks=(40, 40), robots=(robots, robots))(np.random.default_rng(1))
    figure = draw_plan(scenario, make_solver("edf").solve(scenario))
    figure.draw_without_rendering()
    parts = []
    for axes in figure.axes:
        parts += [axes.bbox, axes.get_legend().get_window_extent(), axes.xaxis.label.get_window_extent()]
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            labels = zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=False)  # those above follow
            parts += [label.get_window_extent() for place, label in labels if low <= place <= high]
    parts += [text.get_window_extent() for text in figure.texts]
    for index, one in enumerate(parts):
        assert figure.bbox.x0 <= one.x0 <= one.x1 <= figure.bbox.x1
        assert figure.bbox.y0 <= one.y0 <= one.y1 <= figure.bbox.y1
        for other in parts[:index]:
            shared = one.intersection(one, other)
            assert shared is None or min(shared.width, shared.height) < 1.0 or one.width * one.height == 0


@pytest.mark.parametrize("origin", [(512000.0, 5403000.0), (-40.0, -1e6), (1e11, -1e10)])
def test_a_map_that_does_not_begin_at_0(origin: tuple[float, float]) -> None:
    moved = replace(SCENARIO, task_xy=SCENARIO.task_xy + origin, robot_xy=SCENARIO.robot_xy + origin, map_origin=origin)
    figure = draw_plan(moved, PLAN)
    figure.draw_without_rendering()
    routes = figure.axes[0]
    for axis, low in zip((routes.xaxis, routes.yaxis), origin, strict=True):
        assert axis.get_view_interval() == pytest.approx((low - 3.5, low + 103.5))
        written = [label.get_text() for label in axis.get_ticklabels()]
        assert axis.get_offset_text().get_text() == ""
        assert [float(text) for text in written] == axis.get_ticklocs().tolist()
        assert len(written) >= 2
        assert min(label.get_window_extent().x0 for label in axis.get_ticklabels()) > 0


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


@pytest.mark.parametrize("module", ["show.plan.picture", "eval.plot_history"])
def test_without_matplotlib_it_names_the_extra(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    for name in [name for name in sys.modules if name.startswith("matplotlib.")]:
        monkeypatch.setitem(sys.modules, name, None)
    for name in (module, "show.figure"):
        monkeypatch.delitem(sys.modules, f"mrta_zoo.{name}", raising=False)
    with pytest.raises(MissingExtraError, match=r'needs matplotlib.*pip install "mrta_zoo\[plot\]"'):
        importlib.import_module(f"mrta_zoo.{module}")


def test_a_mission_in_the_corner_of_a_large_map_fills_the_picture() -> None:
    corner = replace(SCENARIO, map_size=(512010.0, 5403010.0))
    routes = draw_plan(corner, PLAN).axes[0]
    assert routes.get_xlim() == pytest.approx((-3.15, 93.15))  # the box around all places is 90 by 90
    line = replace(SCENARIO, task_xy=[[5, 0], [5, 40], [5, 80]], robot_xy=[[5, 0], [5, 90]], map_size=(1e6, 1e6))
    routes = draw_plan(line, PLAN).axes[0]
    assert routes.get_ylim() == pytest.approx((-3.15, 93.15))
    assert np.diff(routes.get_xlim()) > 20  # no map is without width


def test_one_late_deadline_does_not_squash_the_chart() -> None:
    lasting = replace(SCENARIO, deadline=[1e9, 38, 90])
    figure = draw_plan(lasting, PLAN)
    end = figure.axes[1].get_xlim()[1]
    assert end < 250
    assert max(way[-1][0] for way in lines_to_deadlines(figure)) == pytest.approx(end / 1.012)
    easy = replace(SCENARIO, deadline=[1e9, 1e9, 1e9])
    assert draw_plan(easy, PLAN).axes[1].get_xlim()[1] < 100  # twice the 40 that it takes


def starts(scenario: Scenario) -> list[tuple[str, str, Bbox]]:
    """The labels of robots on the map: what they say, their ground, and what they cover in pixels."""
    figure = draw_plan(scenario, Plan.of([()] * scenario.num_robots))
    figure.draw_without_rendering()
    labels = [text for text in figure.axes[0].texts if text.get_bbox_patch() is not None]
    return [
        (text.get_text(), to_hex(text.get_bbox_patch().get_facecolor()), text.get_bbox_patch().get_window_extent())
        for text in labels
    ]


@pytest.mark.parametrize("apart", [0.0, 1.0])
@pytest.mark.parametrize("names", [(), ("Spot", "Husky", "Ann", "a name that is far too long for any map to hold it")])
def test_robots_that_start_at_one_place_are_all_seen(names: tuple[str, ...], apart: float) -> None:
    places = np.array([(50.0, 50.0), (50.0, 50.0 + apart), (50.0 + apart, 50.0), (10.0, 50.0)])
    found = starts(replace(SCENARIO, robot_xy=places, capacity=np.ones(4), speed=np.ones(4), robot_names=names))
    assert [ground for _, ground, _ in found] == [to_hex(robot_colour(robot)) for robot in range(4)]
    texts = [text for text, _, _ in found]
    assert texts[:3] == list(names[:3] or "012")
    assert re.fullmatch(r"a n.*….* it" if names else "3", texts[3])
    boxes = [box.shrunk(0.95, 0.95) for _, _, box in found]
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))


def test_where_a_name_has_no_room_there_is_a_number() -> None:
    around = [(x, y) for x in range(40, 61, 2) for y in range(40, 61, 2) if (x, y) != (50, 50)]
    crowd = Scenario(
        task_xy=around, deadline=[90] * len(around), workload=[1] * len(around), robot_xy=[(50, 50), (90, 10)],
        capacity=[1, 1], robot_names=("Spot", "Husky"),
    )  # fmt: skip
    assert [text for text, _, _ in starts(crowd)] == ["0", "Husky"]


def test_of_a_whole_fleet_at_one_place_there_is_the_number() -> None:
    fleet = replace(SCENARIO, robot_xy=np.full((20, 2), 50.0), capacity=np.ones(20), speed=np.ones(20))
    assert [text for text, _, _ in starts(fleet)] == ["20 robots"]
