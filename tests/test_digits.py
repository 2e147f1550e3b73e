"""Numbers are shown in as many digits as it takes to tell them from others, whatever their units."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from factories import small_scenario
from rich.console import Console

from mrta_zoo.debug import Stepper, compare
from mrta_zoo.debug.comparison_report import report
from mrta_zoo.digits import decimals, full, percentage, rough, rounded, share
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.rows import Row
from mrta_zoo.eval.significance import Estimate
from mrta_zoo.eval.table import summary_tables
from mrta_zoo.plan import Plan
from mrta_zoo.rules import MaskReason
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.plan.text import totals
from mrta_zoo.show.view import Digits
from mrta_zoo.verify import verify

UNITS = small_scenario(2, tasks=12, robots=3)
HOURS = replace(UNITS, deadline=UNITS.deadline / 3600, speed=UNITS.speed * 3600, capacity=UNITS.capacity * 3600)
"""The same in hours rather than seconds."""


@pytest.mark.parametrize(
    ("text", "right"),
    [
        (share(2999 / 3000), "99.967"), (share(1 / 3000), "0.033"), (share(1.0), "100.0"), (share(0.0), "0.0"),
        (share(0.623), "62.3"), (share(0.99998, 2), "99.9980"), (share(0.9753, 2), "97.53"), (percentage(-0.0), "0.0"),
        (percentage(100.02), "100.020"), (percentage(100 - 1e-13), "100.0"),
        (full(1234567.0), "1234567"), (full(-2e6), "-2000000"), (full(1 / 3), "0.333333"), 
        (full(1764361322.25), "1764361322.25"),
        (rough(1234567.0), "1234567"), (rough(1 / 3), "0.333"), (rough(2.0), "2"),
        (rounded(0.0123), "0.0123"), (rounded(45.67), "45.7"), (rounded(0.0), "0.0"), (rounded(1e9), "1000000000.0"),
    ],
)  # fmt: skip
def test_texts(text: str, right: str) -> None:
    assert text == right


def test_times_of_a_mission_have_digits_for_its_unit() -> None:
    # 50 across, at speeds about 1: some 50 s, which are 0.014 hours, of which three digits count.
    assert (Digits.of(UNITS).of_times, Digits.of(HOURS).of_times) == (1, 4)
    digits = Digits.of(replace(UNITS, deadline=np.append(UNITS.deadline[1:], 1e9)))
    assert digits == Digits(1, 1)  # one deadline that is far off does not matter
    assert [digits.time(each) for each in (12.34, 0.0, 0.004, -0.02)] == ["12.3", "0.0", "0.004", "-0.02"]


def test_notes_of_a_mission_in_hours() -> None:
    prospects = [each for each in Stepper(HOURS, "nearest").outlook() if each.reason == MaskReason.CHOOSABLE]
    rivals = [each for each in prospects if each.rival_finish is not None]
    assert rivals
    assert [str(each) for each in rivals] == [f"{each.who} could by {each.rival_finish:.4f}" for each in rivals]


def test_compare_of_a_mission_in_hours() -> None:
    console = Console(file=io.StringIO(), width=200, markup=False, highlight=False)
    with console.capture() as captured:
        for part in report(compare(HOURS, "nearest", "edf"), ("nearest", "edf"), 10):
            console.print(part)
    words = captured.get().replace(",", "").split()
    assert "0.0" not in words
    parting = compare(HOURS, "nearest", "edf").parting
    assert parting is not None
    assert parting.choices[0].finish is not None
    assert f"{parting.choices[0].finish:.4f}" in words


def test_completion_of_nearly_all() -> None:
    tasks = 3000
    scenario = Scenario(np.zeros((tasks, 2)), np.ones(tasks), np.zeros(tasks), [[0, 0]], [1.0], map_size=(1, 1))  # type: ignore[arg-type]
    score = verify(scenario, Plan((tuple(range(tasks - 1)),)))
    assert "completed 2999 of 3000 tasks (99.967 %)" in totals(score)
    assert "(99.967 %)" in score._repr_html_()
    row = Row("a", "nearest", tasks, 1, 2999, 2999 / 3000, 1.0, 1.0, 1.0, 0.00001)
    sheets = summary_tables([row], {"a": 3000})
    assert [sheet.rows[0][-1] for sheet in sheets] == ["99.967", "99.967", "0.0100"]
    assert "completion</td>" in row._repr_html_()
    assert "0.999667" in row._repr_html_()
    assert wording.percentage(Estimate(99.97, 99.93, 100.0, 30)) == "99.970 [99.9, 100.0]"


def test_small_times_keep_their_digits() -> None:
    assert [full(time) for time in (60.0, 33.333333, 999999.75, 123456789.5)] == [
        "60", "33.3333", "999999.75", "123456789.5"
    ]  # fmt: skip
    assert [decimals(largest, 2) for largest in (0.0, 1.2e-7, 0.018, 0.5, 3.0, 300.0)] == [2, 9, 4, 3, 2, 2]
