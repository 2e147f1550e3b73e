"""The replay page, in a browser: what it shows is the mission, and everything on it is linked."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from factories import small_scenario
from open_page import UNITS, OpenPage

from mrta_zoo import Scenario
from mrta_zoo.debug.percent import percent
from mrta_zoo.debug.recorder import record
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.mission import Mission
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.rules import Status
from mrta_zoo.show.render.whereabouts import whereabouts
from mrta_zoo.show.replay import write_replay
from mrta_zoo.show.view import shown_time
from mrta_zoo.trace import Trace

pytestmark = pytest.mark.browser

SCENARIO = small_scenario(5, tasks=25, robots=4, latest=200.0, name="<b>four</b> robots")
TRACES = (record(SCENARIO, "capam-plus"), record(SCENARIO, "nearest", mask_rule="active"))
END = shown_time(SCENARIO, max(trace.score.makespan for trace in TRACES))


@pytest.fixture(scope="module")
def opened(browser: Any, tmp_path_factory: pytest.TempPathFactory) -> OpenPage:
    file = tmp_path_factory.mktemp("replay") / "pair.html"
    write_replay(TRACES, file)
    return OpenPage(browser, file.as_uri())


@pytest.fixture
def page(opened: OpenPage) -> Iterator[OpenPage]:
    """The page with both episodes, at time 0; nothing on it may complain or load anything."""
    opened.slide(0)
    yield opened
    assert opened.complaints == []
    assert [request for request in opened.requests if not request.startswith(("file:", "data:", "blob:"))] == []


def mission_at(trace: Trace, time: float) -> Mission:
    """The mission at any time, also between decisions, with every decision made that was made by then."""
    made = [decision for decision in trace.decisions() if decision.time <= time]
    mission = trace.mission(made[-1].index)
    mission.take(made[-1].robot, made[-1].choice.task)  # without moving the clock on to the next decision
    mission.time = time
    return mission


def expected_status(trace: Trace, time: float) -> list[str]:
    """By the finish times, as the clock of a `Mission` stands still between decisions."""
    mission, names = mission_at(trace, time), []
    for task, deadline in enumerate(trace.scenario.deadline.tolist()):
        finish = mission.finish[task]
        if time < finish < np.inf:
            status = Status.ASSIGNED
        elif finish <= deadline:
            status = Status.COMPLETED
        elif finish < np.inf or deadline < time:
            status = Status.MISSED
        else:
            status = Status.ACTIVE
        names.append(status.name.lower())
    return names


def test_everything_is_there(page):
    assert page.tab.title() == "<b>four</b> robots"
    assert page.texts("h1") == ["<b>four</b> robots"]
    assert page.texts(".method") == ["capam-plus", "nearest"]
    assert float(page.tab.locator("#slider").get_attribute("max")) == pytest.approx(END)
    for side, trace in enumerate(TRACES):
        count = page.tab.locator
        assert count(f"#side-{side} .robot").count() == 4
        assert count(f"#side-{side} .task").count() == 25
        visits = sum(map(len, trace.plan().routes))
        for mark in ("travel", "work", "due", "deadline"):
            assert count(f"#side-{side} .gantt .visit .{mark}").count() == visits
        assert count(f"#strip-{side} i").count() == len(trace.choices)
    assert page.tab.locator("#progress .progress").count() == 2
    score = TRACES[0].mission().completed()
    assert page.texts(".score")[0].startswith(f"{score} of 25 completed, cost {TRACES[0].mission().cost():.2f}")


@pytest.mark.parametrize("share", [0.0, 0.13, 0.31, 0.5, 0.77, 1.0])
def test_the_slider_moves_robots_to_the_right_place(page, share):
    time = share * END
    page.slide(time)
    for side, trace in enumerate(TRACES):
        mission = mission_at(trace, time)
        for robot, place in page.places(side, size=50.0).items():
            here = whereabouts(mission, robot)
            assert place == pytest.approx((here.x, here.y), abs=0.01), f"robot {robot} of {trace.method}"
        assert page.statuses(side) == expected_status(trace, time)
        done = expected_status(trace, time).count("completed")
        assert page.texts(f"#side-{side} .now") == [f"{done} completed by now"]


def test_robots_on_their_way_are_between_places(page):
    page.slide(0.0)
    start = page.places(0, size=50.0)
    finish = TRACES[0].mission()
    task = finish.routes[0][0]
    way = np.hypot(*(SCENARIO.task_xy[task] - SCENARIO.robot_xy[0])) / SCENARIO.speed[0]
    page.slide(way / 2)
    assert page.places(0, size=50.0)[0] == pytest.approx(
        tuple((SCENARIO.task_xy[task] + SCENARIO.robot_xy[0]) / 2), abs=0.01
    )
    assert start[0] == pytest.approx(tuple(SCENARIO.robot_xy[0]), abs=0.01)


def check_decision(page: OpenPage, side: int, index: int) -> None:
    """That heading, clock, table, and marks on map and chart are those of a decision."""
    trace = TRACES[side]
    decision = trace.decisions()[index]
    heading = (
        f"Decision {index} of 0–{len(trace.choices) - 1}: robot {decision.robot} takes task {decision.choice.task} at"
    )
    assert page.decision(side).startswith(heading)
    assert float(page.texts("#clock")[0].removeprefix("time ")) == pytest.approx(decision.time, abs=0.06)
    chosen = page.tab.locator(f"#side-{side} tr.chosen")
    assert chosen.get_attribute("data-task") == str(decision.choice.task)
    if decision.choice.probabilities:
        probability = decision.choice.probabilities[decision.choice.task]
        only = page.tab.locator(f"#side-{side} tbody tr:not(.barred)").count() == 1
        assert page.texts(f"#side-{side} tr.chosen .likely") == [f"{percent(probability, only)} %"]
    ring = page.tab.locator(f"#side-{side} .acting").get_attribute("transform")
    acting = page.tab.locator(f"#side-{side} .robot[data-robot='{decision.robot}']").get_attribute("transform")
    assert ring == acting
    picked = page.tab.locator(f"#side-{side} .picked").bounding_box()
    for robot in range(SCENARIO.num_robots):
        name = page.tab.locator(f"#side-{side} .who[data-robot='{robot}']").bounding_box()
        in_its_row = picked["y"] < name["y"] + name["height"] / 2 < picked["y"] + picked["height"]
        assert in_its_row == (robot == decision.robot)
    cursor = page.tab.locator(f"#side-{side} .cursor").bounding_box()
    assert cursor["x"] == pytest.approx(picked["x"], abs=2)


@pytest.mark.parametrize("side", [0, 1])
def test_a_click_on_the_chart_goes_to_its_decision(page, side):
    finish = TRACES[side].mission().finish
    on_time = [
        each
        for each in sorted(TRACES[side].decisions(), key=lambda each: (each.robot, each.index))
        if finish[each.choice.task] <= SCENARIO.deadline[each.choice.task]
    ]
    middle = len(on_time) // 2
    bar = page.tab.locator(f"#side-{side} .visit[data-task='{on_time[middle].choice.task}'] .work")
    bar.scroll_into_view_if_needed()
    box = bar.bounding_box()
    page.tab.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    check_decision(page, side, on_time[middle].index)


@pytest.mark.parametrize("side", [0, 1])
def test_a_click_on_a_tick_under_the_slider_goes_to_its_decision(page, side):
    index = len(TRACES[side].choices) // 2
    box = page.tab.locator(f"#strip-{side} i").nth(index).bounding_box()
    page.tab.mouse.click(box["x"] + 1, box["y"] + 5)
    check_decision(page, side, index)


def test_keys_and_buttons_step_from_decision_to_decision(page):
    page.tab.locator("#strip-0 i").first.click(force=True)
    page.tab.locator("body").click(position={"x": 5, "y": 5})
    for key, expected in (("ArrowRight", 1), ("ArrowRight", 2), ("ArrowLeft", 1)):
        page.tab.keyboard.press(key)
        check_decision(page, 0, expected)
    page.tab.click("#next")
    check_decision(page, 0, 2)
    page.tab.click("#previous")
    check_decision(page, 0, 1)


def test_the_address_names_the_decision(page, browser):
    page.tab.evaluate("pick(1, 4)")
    assert page.tab.url.endswith("pair.html#4/1")
    other = OpenPage(browser, page.tab.url)
    check_decision(other, 1, 4)
    other.tab.close()


def test_of_decisions_at_the_same_time_those_after_are_yet_to_be_made(page):
    page.tab.locator("#strip-0 i").first.click(force=True)
    page.tab.evaluate("pick(0, 1)")  # the second robot's, also at time 0
    assert page.statuses(0).count("assigned") == 2
    page.tab.evaluate("pick(0, 3)")
    assert page.statuses(0).count("assigned") == 4


def test_the_table_tells_why_a_task_may_not_be_chosen(page):
    index = next(
        decision.index
        for mission, decision in TRACES[0].steps()
        if (mission.reasons[decision.robot] == 3).sum() > 0 and (mission.reasons[decision.robot] == 1).sum() > 0
    )
    mission, decision = TRACES[0].mission(index), TRACES[0].decisions()[index]
    page.tab.evaluate(f"pick(0, {index})")
    counts = np.bincount(mission.reasons[decision.robot], minlength=4)
    assert counts[2] == 0  # which is left out
    assert page.texts("#side-0 .decision p") == [
        f"{counts[0]} to choose from, {counts[1]} taken, {counts[3]} too late; "
        f"{page.tab.locator('#side-0 .decision tbody tr').count()} of them listed"
    ]
    reasons = " ".join(page.texts("#side-0 tr.barred"))
    assert re.search(r"robot \d on it until|too late by \d", reasons)


def test_pointing_at_a_row_rings_its_task(page):
    page.tab.evaluate("pick(0, 2)")
    row = page.tab.locator("#side-0 tbody tr").nth(1)
    row.hover()
    task = int(row.get_attribute("data-task"))
    x, y = SCENARIO.task_xy[task] * UNITS / 50
    ring = page.tab.locator("#side-0 circle.looked")
    assert ring.get_attribute("visibility") == "visible"
    numbers = re.findall(r"[\d.]+", ring.get_attribute("transform"))
    assert [float(number) for number in numbers] == pytest.approx([x, UNITS - y], abs=0.01)
    page.tab.mouse.move(5, 5)
    assert ring.get_attribute("visibility") == "hidden"


def end_of_way(page: OpenPage, side: int, task: int) -> tuple[float, float]:
    """Where the line from a task's bar to its deadline ends, in pixels of the window."""
    point = page.tab.locator(f"#side-{side} .visit[data-task='{task}'] .due").evaluate(
        "way => { const end = way.getPointAtLength(way.getTotalLength()).matrixTransform(way.getScreenCTM());"
        " return [end.x, end.y] }"
    )
    return point[0], point[1]


@pytest.mark.parametrize("side", [0, 1])
def test_each_deadline_is_joined_to_its_task(page, side):
    finish = TRACES[side].mission().finish
    start, stop = (page.tab.evaluate(f"sides[{side}].gantt.at({time})") for time in (0, END))
    left = page.tab.locator(f"#side-{side} .gantt .chart").bounding_box()["x"]
    left += page.tab.evaluate(f"sides[{side}].gantt.left()")
    for task in range(SCENARIO.num_tasks):
        if np.isinf(finish[task]):
            continue
        due, y = end_of_way(page, side, task)
        shown = min(SCENARIO.deadline[task], END) / END
        assert due - left == pytest.approx(start + (stop - start) * shown, abs=0.1)
        group = f"#side-{side} .visit[data-task='{task}']"
        bar, tick = (page.tab.locator(f"{group} .{part}").bounding_box() for part in ("work", "deadline"))
        in_time = finish[task] <= SCENARIO.deadline[task]
        assert in_time == (y > bar["y"] + bar["height"] - 1)  # below the bar, or above it
        assert tick["x"] <= due + 1.5
        assert tick["x"] + tick["width"] >= due - 1.5


def test_pointing_at_a_deadline_shows_its_task_and_the_other_way_round(page):
    page.slide(END)
    route = TRACES[0].plan().routes[1]
    for task in (route[0], route[-1]):
        group = page.tab.locator(f"#side-0 .visit[data-task='{task}']")
        for part in (".deadline", ".work"):
            page.tab.mouse.move(5, 5)
            assert page.tab.locator(".visit.pointed").count() == 0
            group.locator(part).hover(force=True)
            assert page.tab.locator(".visit.pointed").get_attribute("data-task") == str(task)
            assert page.tab.locator("#side-0 circle.looked").get_attribute("visibility") == "visible"
            wide = [part.evaluate("part => getComputedStyle(part).strokeWidth") for part in (
                group.locator(".due"), group.locator(".work"), group.locator(".deadline"))]  # fmt: skip
            assert wide == ["2px", "2px", "3px"]
    page.tab.mouse.move(5, 5)
    page.tab.locator(f"#side-0 .task[data-task='{route[0]}']").hover(force=True)
    assert page.tab.locator(".visit.pointed").get_attribute("data-task") == str(route[0])
    said = page.tab.locator("footer").inner_text()
    assert "from a bar to the deadline of its task" in said
    assert "above it" not in said


def test_a_drag_over_a_chart_shows_that_span(page):
    chart = page.tab.locator("#side-0 .gantt .chart")
    chart.scroll_into_view_if_needed()
    box = chart.bounding_box()
    page.tab.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 10)
    page.tab.mouse.down()
    page.tab.mouse.move(box["x"] + 0.6 * box["width"], box["y"] + 10)
    page.tab.mouse.up()
    first, last = page.tab.evaluate("sides[0].gantt.span")
    assert 0.2 * END < first < 0.45 * END < 0.5 * END < last < 0.65 * END
    chart.dblclick(position={"x": 200, "y": 3})
    assert page.tab.evaluate("sides[0].gantt.span") == [0, pytest.approx(END)]


def test_play_moves_the_time_on_and_pauses(page):
    page.tab.select_option("#speed", "4")
    page.tab.click("#play")
    page.tab.wait_for_function(f"moment.time > {0.02 * END}")
    page.tab.click("#play")
    assert page.texts("#play") == ["play"]
    time = page.tab.evaluate("moment.time")
    page.tab.wait_for_timeout(100)
    assert page.tab.evaluate("moment.time") == time
    mission = mission_at(TRACES[0], time)
    here = whereabouts(mission, 2)
    assert page.places(0, size=50.0)[2] == pytest.approx((here.x, here.y), abs=0.01)


def test_one_episode_without_probabilities(browser, tmp_path):
    write_replay([TRACES[1]], tmp_path / "one.html")
    page = OpenPage(browser, (tmp_path / "one.html").as_uri())
    assert page.tab.locator(".side").count() == 1
    assert not page.tab.locator("#side-0 th.likely").is_visible()
    assert page.tab.locator("#side-0 th.wide").first.is_visible()
    page.tab.close()
    assert page.complaints == []


@pytest.mark.parametrize("choices", [0, 3])
def test_an_episode_that_breaks_off(browser, tmp_path, choices):
    write_replay([Trace(SCENARIO, TRACES[0].choices[:choices], bookmark=choices // 2)], tmp_path / "cut.html")
    page = OpenPage(browser, (tmp_path / "cut.html").as_uri())
    assert page.tab.locator("#strip-0 i").count() == choices
    if choices:
        assert page.decision(0).startswith("Decision 1 of 0–2: ")  # the bookmark
    else:
        assert page.texts("#side-0 .decision p") == ["No decision has been made yet."]
    page.slide(50)
    page.tab.close()
    assert page.complaints == []


def test_a_thousand_tasks(browser, tmp_path):
    scenario = TaptcGenerator(tasks=(1000, 1000), robots=(70, 70))(np.random.default_rng(0))
    trace = Trace.of_plan(scenario, make_solver("nearest").solve(scenario))
    write_replay([trace, trace], tmp_path / "many.html")
    page = OpenPage(browser, (tmp_path / "many.html").as_uri())
    assert page.tab.locator("#side-1 .task").count() == 1000
    page.slide(60.0)
    mission = mission_at(trace, 60.0)
    for robot, place in page.places(1, size=100.0).items():
        here = whereabouts(mission, robot)
        assert place == pytest.approx((here.x, here.y), abs=0.01)
    page.tab.close()
    assert page.complaints == []


def test_the_scenario_is_not_square(browser, tmp_path):
    scenario = Scenario(
        task_xy=[[200, 10], [30, 50]], deadline=[500, 400], workload=[1, 1],
        robot_xy=[[0, 0]], capacity=[1], map_size=(200, 50),
    )  # fmt: skip
    write_replay([record(scenario, "nearest")], tmp_path / "wide.html")
    page = OpenPage(browser, (tmp_path / "wide.html").as_uri())
    mark = page.tab.locator("#side-0 .task").first.get_attribute("transform")
    x, y = map(float, re.findall(r"[\d.]+", mark)[:2])
    assert (x, y) == pytest.approx((520, (50 - 10) * 2.6))  # 520 units for 200
    page.tab.close()


def test_numbers_in_the_chart_and_on_the_map_are_whole(page):
    for selector in (".visit .what", ".labels text"):
        texts = page.tab.locator(f"#side-0 {selector}").all_text_contents()
        assert len(texts) > 15
        assert {int(text) for text in texts} <= set(range(25))
