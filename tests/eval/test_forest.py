"""Forest plots."""

from __future__ import annotations

import pytest

from mrta_zoo.eval.report.forest import Mark, draw_forest
from mrta_zoo.eval.significance import TOO_FEW, Estimate

LOOK = ("#0072b2", "o")


def test_what_a_forest_plot_shows() -> None:
    panels = {
        "one": {1: Mark(Estimate(2, 1, 4, 9), LOOK, True), 2: Mark(Estimate(-1, None, None, 2, TOO_FEW), LOOK, False)},
        "two": {1: Mark(Estimate(-30, -33, -27, 9), LOOK, True), 2: Mark(Estimate(0, 0, 0, 9), LOOK, False)},
    }
    one, two = draw_forest(["heading", "a", "b"], panels, "difference", width=2, furthest=10).axes
    assert [(*line.get_xdata(), *line.get_ydata()) for line in one.lines[1:]] == [(2, 1), (-1, 2)]
    assert [line.get_markerfacecolor() for line in one.lines[1:]] == ["#0072b2", "white"]
    (bar,) = one.collections  # of what has an interval
    assert bar.get_segments()[0].tolist() == [[1, 1], [4, 1]]
    assert [label.get_fontweight() for label in one.get_yticklabels()] == ["bold", "normal", "normal"]
    # From -1 to 4 with 6 % of that as room, in both panels; what is beyond is a number.
    assert one.get_xlim() == two.get_xlim() == pytest.approx((-1.3, 4.3))
    assert [text.get_text() for text in two.texts] == ["← −30.0"]
