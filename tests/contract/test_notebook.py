"""Objects show themselves in a notebook: asked as IPython asks them."""

from __future__ import annotations

import base64
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace

import numpy as np
import pytest
from factories import named_scenario, small_scenario
from IPython.core.formatters import DisplayFormatter

from mrta_zoo import Plan, Scenario, mrta_v0
from mrta_zoo.eval.rows import Row
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.show.markup import MOST_ROWS, table
from mrta_zoo.verify import verify

SCENARIO = Scenario(
    task_xy=[[10, 0], [0, 20]], deadline=[20, 40], workload=[6, 0],
    robot_xy=[[0, 0], [50, 50]], capacity=[2, 1], map_size=(100, 50), name="a < b",
)  # fmt: skip


def shown(thing: object) -> str:
    """What a notebook would show of a thing as HTML, which must be well-formed."""
    html = DisplayFormatter().format(thing)[0]["text/html"]
    ElementTree.fromstring(f"<div>{html}</div>")
    return html


def cells(html: str) -> list[list[str]]:
    return [re.findall(r"<td[^>]*>(.*?)</td>", row) for row in re.findall(r"<tr>(.*?)</tr>", html)][1:]


def test_a_scenario():
    html = shown(SCENARIO)
    assert "a &lt; b: 2 tasks, 2 robots, map 100 by 50" in html
    assert cells(html)[0] == ["deadline", "20", "30", "40"]
    # 320 pixels for 100 distance units, y downwards: task 1 is at (0, 20), 30 units below the top.
    assert '<circle cx="0.0" cy="96.0"' in html
    assert html.count("<circle") == 2
    assert html.count("<title>robot") == 2


def test_a_map_that_lies_elsewhere():
    far = np.array([512000.0, -40.0])
    moved = replace(SCENARIO, task_xy=SCENARIO.task_xy + far, robot_xy=SCENARIO.robot_xy + far,
                    map_origin=tuple(far), task_names=("valve <A>", "B"), robot_names=("Spot", "R & D"))  # fmt: skip
    html = shown(moved)
    assert "map 100 by 50 from 512000, -40" in html
    assert '<circle cx="0.0" cy="96.0"' in html
    assert "<title>task valve &lt;A&gt;, deadline 20</title>" in html
    assert "<title>R &amp; D</title>" in html
    corner = shown(replace(SCENARIO, map_size=(1e6, 1e6)))  # of which only the places are shown, 50 by 50
    assert '<circle cx="64.0" cy="320.0"' in corner


def test_one_late_deadline_leaves_the_other_colours():
    tasks = re.findall(r'<circle[^>]*fill="(#\w+)"', shown(replace(SCENARIO, deadline=[20, 1e9])))
    assert tasks[0] != tasks[1]
    assert tasks[0] != "#e03131"  # as if it was due at once


def test_a_plan_and_its_score():
    plan = Plan.of([(0, 1), ()], "a < b", "mine")
    assert "Plan of a &lt; b by mine: 2 tasks taken" in shown(plan)
    assert cells(shown(plan)) == [["0", "2", "0 → 1"], ["1", "0", "-"]]
    html = shown(verify(SCENARIO, plan))  # 10 + 6 / 2 = 13, then sqrt(500) = 22.36 more
    assert "2 of 2 tasks completed (100.0 %), cost 0.000, distance 32.4, makespan 35.4 (cost by Eq. 1: the sum" in html
    assert cells(html) == [["0", "2 of 2", "35.4", "0 → 1"], ["1", "0 of 0", "-", "-"]]


def test_a_row_of_an_evaluation():
    html = shown(Row("c", "nearest", 2, 1, 1, 0.5, 1.25, 10.0, 8.0, 0.125))
    assert ["completion", "0.5"] in cells(html)
    assert "nearest on c" in html


@pytest.mark.parametrize("make", [mrta_v0.env, mrta_v0.raw_env, mrta_v0.parallel_env])
def test_an_environment_is_a_picture(make):
    env = make(scenario=small_scenario(0))
    assert "mrta_v0: no mission yet; call reset()" in shown(env)
    env.reset()
    html = DisplayFormatter().format(env)[0]["text/html"]
    assert 'alt="small   time 0.0   8 tasks: 8 active' in html
    assert base64.b64decode(re.search(r"base64,([^\"]+)", html)[1]).startswith(b"\x89PNG")


def test_an_environment_without_pygame_is_text(monkeypatch):
    monkeypatch.setattr("mrta_zoo.env.base.find_spec", lambda name: None)
    env = mrta_v0.env(scenario=SCENARIO)
    env.reset()
    assert shown(env).startswith('<pre class="tex2jax_ignore mathjax_ignore">a &lt; b   time 0.0   2 tasks')


def test_many_are_few_enough():
    scenario = UniformGenerator(tasks=(1000, 1000), robots=(70, 70))(np.random.default_rng(0))
    assert len(shown(scenario)) < 200_000
    plan = Plan.of([[]] * 70)
    assert len(cells(shown(plan))) == MOST_ROWS
    assert f"and {70 - MOST_ROWS} more" in shown(plan)


def test_nothing_in_a_cell_is_markup():
    assert "<b>&lt;i&gt;</b>" in table("<i>", ["<u>"], [["<script>"]])
    assert "<script>" not in table("<i>", ["<u>"], [["<script>"]])


def test_names_are_text():
    named = named_scenario()
    html = shown(named)
    assert "<title>task pump #3 &lt;b&gt;, deadline 50</title>" in html
    assert "<title>Bob &amp; Co</title>" in html
    assert cells(shown(verify(named, Plan.of([(0, 1), (2,)])))) == [
        ["Ann", "2 of 2", "45.0", "valve-A → pump #3 &lt;b&gt;"],
        ["Bob &amp; Co", "1 of 1", "17.0", "=SUM(A1)"],
    ]


def test_names_from_right_to_left_keep_the_order():
    named = replace(named_scenario(), task_names=("שער", "ברז", "c", "d", "e"))
    html = shown(verify(named, Plan.of([(0, 1), (2,)])))
    assert cells(html)[0][-1] == "\u2068שער\u2069 → \u2068ברז\u2069"  # isolated: or the arrow would point backwards


def test_a_map_may_lie_anywhere():
    moved = Scenario(
        SCENARIO.task_xy + 5e6, SCENARIO.deadline, SCENARIO.workload, SCENARIO.robot_xy + 5e6, SCENARIO.capacity,
        map_size=(100, 50), map_origin=(5e6, 5e6),
    )  # fmt: skip
    assert '<circle cx="0.0" cy="96.0"' in shown(moved)  # as above


def test_no_dollar_sign_is_mathematics():
    plan = Plan.of([(0,), (1,)], "Budget $5 to $9")
    for thing in (plan, SCENARIO, verify(SCENARIO, plan)):
        assert shown(thing).startswith('<div class="tex2jax_ignore mathjax_ignore">')  # as MathJax 2, 3 and pandas know
