"""The layout of the replay page, in a browser: at any width, with any names, all text can be read."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest
from factories import small_scenario
from open_page import UNITS, OpenPage

from mrta_zoo.debug.recorder import record
from mrta_zoo.show.replay import write_replay
from mrta_zoo.show.shortened import telling

pytestmark = pytest.mark.browser

SCENARIO = small_scenario(5, tasks=25, robots=4, latest=200.0, name="<b>four</b> robots")

FAR = (512000.0, 5403000.0)
NAMED = replace(
    SCENARIO, task_names=[f"{'survey point ' * (j % 3 == 0)}{'x' * 150 * (j % 8 == 0)}V-{j}" for j in range(25)],
    robot_names=["Spot", "</script>", "a robot with a long name that ends in 2", "$R_3$"],
    task_xy=SCENARIO.task_xy + FAR, robot_xy=SCENARIO.robot_xy + FAR, map_origin=FAR,
    deadline=[1e9, *SCENARIO.deadline[1:]],
)  # fmt: skip
OVERLAPPING = """() => {
  const texts = [...document.querySelectorAll("text, h1, h2, p, td, th, b, button, output, .score, .now, footer span")]
    .filter((text) => text.textContent.trim() && !text.closest(".robot") && text.getClientRects().length > 0);
  const boxes = texts.map((text) => {
    const range = document.createRange();
    range.selectNodeContents(text);
    return [text.textContent.trim(), range.getBoundingClientRect()];
  });
  const found = boxes.filter(([, box]) => box.left < -0.5 || box.right > document.documentElement.clientWidth + 0.5)
    .map(([text]) => `${text} is cut`);
  boxes.forEach(([text, a], index) => boxes.slice(0, index).forEach(([other, b]) => {
    const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
    const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
    if (wide > 1 && high > 4) found.push(`${text} on ${other}`);
  }));
  return found;
}"""
TORN = """() => [...document.querySelectorAll("footer span")].filter((entry) => {
  const words = document.createRange();
  words.selectNodeContents(entry.lastChild);
  const icon = entry.firstElementChild.getBoundingClientRect(), lines = [...words.getClientRects()];
  return lines.some((line) => icon.right > line.left) || icon.bottom < lines[0].top || icon.top > lines[0].bottom;
}).map((entry) => entry.textContent)"""
"""Entries of the legend whose icon is not before their words, beside the first line."""


@pytest.mark.parametrize("width", [360, 500, 1280, 1920])
@pytest.mark.parametrize("count", [1, 2])
def test_no_text_is_cut_or_on_another(browser, tmp_path, width, count):
    traces = [record(NAMED, "nearest"), record(NAMED, "nearest", mask_rule="active")]
    write_replay(traces[:count], tmp_path / "named.html")
    page = OpenPage(browser, (tmp_path / "named.html").as_uri() + "#5", width=width, height=720)
    assert page.tab.evaluate("document.documentElement.scrollWidth") <= width
    assert page.tab.evaluate(OVERLAPPING) == []
    assert page.decision(0).startswith("Decision 5 of 0–")
    named = page.tab.locator("#side-0 .labels text").all_text_contents()
    assert len(named) > 12
    assert "V-1" in named
    assert page.tab.evaluate("end") < 1000
    assert page.tab.evaluate(TORN) == []
    page.tab.set_viewport_size({"width": 700, "height": 800})
    page.tab.wait_for_function("sides[0].map.width === sides[0].map.box.clientWidth")
    assert page.tab.evaluate(OVERLAPPING) == []
    page.tab.close()
    assert page.complaints == []


STATIONS = replace(
    SCENARIO, task_names=[f"Inspect pump station {j} (north wing)" for j in range(25)],
    robot_names=[f"Boston Dynamics Spot {r} (leased)" for r in range(4)],
)  # fmt: skip
IN_HOURS = replace(
    STATIONS, deadline=STATIONS.deadline / 3600, speed=STATIONS.speed * 3.6, capacity=STATIONS.capacity * 3600,
    map_size=(0.05, 0.05), task_xy=STATIONS.task_xy / 1e3, robot_xy=STATIONS.robot_xy / 1e3,
)  # fmt: skip


@pytest.mark.parametrize("width", [360, 1280])
@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("scenario", [STATIONS, IN_HOURS], ids=["seconds", "hours"])
def test_long_names_leave_tables_readable(browser, tmp_path, scenario, count, width):
    traces = [record(scenario, "capam-plus"), record(scenario, "nearest", mask_rule="active")]
    write_replay(traces[:count], tmp_path / "stations.html")
    page = OpenPage(browser, (tmp_path / "stations.html").as_uri() + "#5", width=width, height=720)
    assert page.tab.evaluate("document.documentElement.scrollWidth") <= width
    assert page.tab.evaluate(OVERLAPPING) == []
    heights = page.tab.locator("tbody tr").evaluate_all("rows => rows.map((row) => row.clientHeight)")
    assert max(heights) < 140
    for side in range(count):
        names = page.texts(f"#side-{side} td.name")
        numbers = page.tab.locator(f"#side-{side} tbody tr").evaluate_all("rows => rows.map((row) => row.dataset.task)")
        assert [re.search(r"\d+", name)[0] for name in names] == numbers
        robots = page.tab.locator(f"#side-{side} .who[data-robot]").all_text_contents()
        assert all(re.fullmatch(rf"{robot}: .*{robot}\D*", text) for robot, text in enumerate(robots))
    page.tab.close()
    assert page.complaints == []


def test_the_page_shortens_names_as_pictures_do(browser, tmp_path):
    write_replay([record(SCENARIO, "nearest")], tmp_path / "page.html")
    page = OpenPage(browser, (tmp_path / "page.html").as_uri())
    for names in (
        STATIONS.task_names, NAMED.task_names, ("Room 12 valve A", "Room 12 valve B", "Room 13 valve A"),
        ("东泵站一号室", "东泵站二号室", "Spot 7", "Spot 17", "station 1", "station 12", "12.5 m", "12.7 m"),
    ):  # fmt: skip
        found = page.tab.evaluate("names => names.map((name) => telling(names).get(name))", list(names))
        assert found == [[list(part) for part in telling(tuple(names))[name]] for name in names]
    page.tab.close()


def test_a_map_that_does_not_begin_at_0(browser, tmp_path):
    write_replay([record(NAMED, "nearest")], tmp_path / "far.html")
    page = OpenPage(browser, (tmp_path / "far.html").as_uri())
    mark = page.tab.locator("#side-0 .task").nth(4).get_attribute("transform")
    x, y = map(float, re.findall(r"[\d.]+", mark)[:2])
    assert (x, UNITS - y) == pytest.approx(tuple(SCENARIO.task_xy[4] * UNITS / 50), abs=0.01)
    assert {"512000", "512050"} <= set(page.tab.locator(".axis.below").all_text_contents())
    assert {"5403000", "5403050"} <= set(page.tab.locator(".axis:not(.below)").all_text_contents())
    page.tab.close()


def test_names_from_right_to_left_leave_sentences_in_order(browser, tmp_path):
    named = replace(SCENARIO, task_names=[f"שער {task}" for task in range(25)], robot_names=["ברז", "b", "c", "d"])
    write_replay([record(named, "nearest")], tmp_path / "right.html")
    page = OpenPage(browser, (tmp_path / "right.html").as_uri() + "#0")
    task = record(named, "nearest").choices[0].task
    assert f"\u2068ברז\u2069 takes task \u2068שער {task}\u2069 at 0.0" in page.decision(0)
    page.tab.close()
