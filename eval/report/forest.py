"""Forest plots: differences with their intervals, one row each, in one panel or several."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.figure_style import new_figure
from mrta_zoo.eval.significance import Estimate
from mrta_zoo.extras import importing
from mrta_zoo.show.axes import plain
from mrta_zoo.show.palette import FAINT, INK

with importing("report", "a figure"):
    from matplotlib.figure import Figure

PANELS_PER_LINE = 5
ROW = 0.31
"""Height of a row, in inches."""


@dataclass(frozen=True, slots=True)
class Mark:
    """A difference in a forest plot.

    Attributes:
        estimate: the difference with its interval, which is a bar.
        look: colour and marker.
        significant: whether the marker is filled.
    """

    estimate: Estimate
    look: tuple[str, str]
    significant: bool


def draw_forest(
    rows: Sequence[str],
    panels: Mapping[str, Mapping[int, Mark]],
    label: str,
    *,
    width: float,
    furthest: float = math.inf,
) -> Figure:
    """Draw differences with their intervals.

    Args:
        rows: what each row is called, from the top; those without any mark are headings.
        panels: the marks by number of the row, for each panel by its title.
        label: of the x-axis.
        width: of a panel, in inches.
        furthest: difference that an axis shows at most; beyond it there is only the number.
    """
    columns = min(len(panels), PANELS_PER_LINE)
    lines = math.ceil(len(panels) / columns)
    figure = new_figure(width * columns + 1.2, lines * (ROW * len(rows) + 0.8) + 0.3)
    grid = figure.subplots(lines, columns, sharex=True, sharey=True, squeeze=False)
    marks = [mark.estimate for panel in panels.values() for mark in panel.values()]
    ends = [end for e in marks for end in (e.low, e.mean, e.high) if end is not None and abs(end) <= furthest]
    low, high = min(0.0, *ends, 0.0), max(0.0, *ends, 0.0)
    room = 0.06 * (high - low) or 1.0
    grid[0, 0].set_xlim(low - room, high + room)
    grid[0, 0].set_ylim(len(rows) - 0.45, -0.55)
    grid[0, 0].set_yticks(range(len(rows)), rows)
    for axes, (title, panel) in zip(grid.flat, panels.items(), strict=False):
        plain(axes)
        axes.set_title(title, fontsize=10, color=INK, loc="left")
        axes.axvline(0, color=FAINT, linewidth=1, zorder=1)
        for row, mark in panel.items():
            mean, (colour, marker) = mark.estimate.mean, mark.look
            if abs(mean) > furthest:
                text, side = wording.number(mean), "right" if mean > 0 else "left"
                axes.text(high if mean > 0 else low, row, f"{text} →" if mean > 0 else f"← {text}",
                          fontsize=8.5, color=INK, ha=side, va="center")  # fmt: skip
                continue
            if mark.estimate.low is not None and mark.estimate.high is not None:
                axes.hlines(row, mark.estimate.low, mark.estimate.high, color=colour, linewidth=2, zorder=2)
            axes.plot(mean, row, marker, color=colour, markersize=6.5, zorder=3,
                      markerfacecolor=colour if mark.significant else "white")  # fmt: skip
    marked = {row for panel in panels.values() for row in panel}
    for first in grid[:, 0]:
        for row, name in enumerate(first.get_yticklabels()):
            name.set(color=INK, fontsize=9, fontweight="normal" if row in marked else "bold")
    for unused in list(grid.flat)[len(panels) :]:
        unused.remove()
    (figure.supxlabel if len(panels) > 1 else axes.set_xlabel)(label, fontsize=9, color=FAINT)
    return figure
