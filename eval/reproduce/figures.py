"""The figures of the report: a row for each method, a panel for each group of cases."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.figure_style import FAINT, INK, draw_interval, new_figure, plain, style_of
from mrta_zoo.eval.reproduce.results import Group, Results
from mrta_zoo.eval.significance import LEAST, Estimate
from mrta_zoo.extras import importing
from mrta_zoo.wording import counted

with importing("report", "a figure"):
    from matplotlib.figure import Figure

PANELS_A_LINE = 4
ROW = 0.34
"""Height of a method's row, in inches."""
FURTHEST = 10.0
"""Percentage points that an axis of differences shows; what lies beyond is an arrow with its number."""


FURTHEST_BEHIND = 25.0
"""Likewise, that an axis of shares shows below the best."""


def _panels(results: Results, groups: Sequence[Group], width: float) -> tuple[Figure, list[Any]]:
    """A figure with a panel for each group, the first method on top, methods named at the left."""
    columns = min(len(groups), PANELS_A_LINE) if len(groups) != 5 else 5
    lines = math.ceil(len(groups) / columns)
    figure = new_figure(max(width * columns, 5.0) + 1.2, lines * (ROW * len(results.methods) + 0.95) + 0.1)
    grid = figure.subplots(lines, columns, sharey=True, squeeze=False)
    panels = list(grid.flat)
    for unused in panels[len(groups) :]:
        unused.remove()
    for axes, group in zip(panels, groups, strict=False):
        plain(axes)
        axes.locator_params(axis="x", nbins=5)
        axes.set_title(group.label, fontsize=10, color=INK, loc="left")
        axes.set_ylim(len(results.methods) - 0.45, -0.55)
    for line in grid[:, 0]:
        line.set_yticks(range(len(results.methods)), results.methods)
        for label in line.get_yticklabels():
            label.set(color=INK, fontsize=9.5)
    return figure, panels[: len(groups)]


def draw_boxes(results: Results, tasks: int) -> Figure:
    """Completion by method and number of robots as horizontal box plots over the cases."""
    groups = [group for group in results.groups(tasks) if group.robots is not None]
    figure, panels = _panels(results, groups, 2.75)
    everything = results.frame.loc[results.frame["tasks"] == tasks, "percent"]
    for axes, group in zip(panels, groups, strict=True):
        axes.set_xlim(everything.min() - 3, everything.max() + 3)
        for row, method in enumerate(results.methods):
            values = results.select(group, method)["percent"].to_numpy()
            colour, _ = style_of(method, results.methods)
            # Evenly spread over the row's height, by rank of a fixed shuffle: no chance, and no dot on another.
            spread = np.random.default_rng(0).permutation(len(values)) / max(len(values) - 1, 1) - 0.5
            axes.scatter(values, row + 0.4 * spread, s=6, color=colour, alpha=0.55, linewidths=0, zorder=3)
            if len(values) >= LEAST:
                axes.boxplot(
                    values, positions=[row], orientation="horizontal", widths=0.62, showfliers=False, patch_artist=True,
                    showmeans=True, manage_ticks=False, zorder=2,
                    boxprops={"facecolor": colour + "40", "edgecolor": colour, "linewidth": 1.2},
                    medianprops={"color": colour, "linewidth": 2.2},
                    whiskerprops={"color": colour, "linewidth": 1.2}, capprops={"color": colour, "linewidth": 1.2},
                    meanprops={"marker": "D", "markersize": 4.5, "markerfacecolor": "white",
                               "markeredgecolor": INK, "zorder": 5},
                )  # fmt: skip
    _name_x(figure, f"tasks completed in time, % of {tasks}")
    return figure


def draw_differences(
    results: Results, groups: Sequence[Group], found: Mapping[tuple[str, Group], tuple[Estimate, bool]]
) -> Figure:
    """Mean paired differences from the reference with intervals; filled where significant.

    Args:
        results: gives the methods' order.
        groups: a panel each.
        found: difference in percentage points, and whether it is significant, by method and group.
    """
    figure, panels = _panels(results, groups, 2.4)
    extremes = [
        max(abs(low or e.mean), abs(high or e.mean)) for e, _ in found.values() for low, high in [(e.low, e.high)]
    ]
    limit = 1.12 * (max([each for each in extremes if each <= FURTHEST], default=FURTHEST) or 1.0)
    for axes, group in zip(panels, groups, strict=True):
        axes.axvline(0, color=FAINT, linewidth=1.1, zorder=1)
        axes.set_xlim(-limit, limit)
        for row, method in enumerate(results.methods):
            if method == results.against:
                axes.text(0, row, " reference ", fontsize=8, color=FAINT, ha="center", va="center",
                          backgroundcolor="white")  # fmt: skip
                continue
            estimate, significant = found[method, group]
            look = style_of(method, results.methods)
            if abs(estimate.mean) > limit:
                side = math.copysign(limit, estimate.mean)
                _arrow(axes, row, wording.number(estimate.mean, signed=True), side, side * 0.62, look[0])
                continue
            draw_interval(axes, row, estimate, look, size=7, filled=significant, edge=1.4, solid_capstyle="butt")
    _name_x(figure, f"← {results.against} completes fewer        {results.against} completes more →\n"
                    f"mean difference, percentage points")  # fmt: skip
    return figure


def draw_intervals(results: Results, tasks: int, column: str, label: str) -> Figure:
    """Means of a column in % with intervals, by method and group of the cases with so many tasks."""
    groups = results.groups(tasks)
    figure, panels = _panels(results, groups, 2.2)
    found = {(method, group): estimate for method, group, estimate in results.estimates(tasks, column)}
    best = max(estimate.mean for estimate in found.values())
    lows = [e.mean if e.low is None else e.low for e in found.values()]
    left = min(low for low in [*lows, best] if low >= best - FURTHEST_BEHIND)
    room = 0.06 * (best - left) or 1.0
    for axes, group in zip(panels, groups, strict=True):
        axes.set_xlim(left - room, max(best, *(e.high or 0.0 for e in found.values())) + room)
        for row, method in enumerate(results.methods):
            estimate = found[method, group]
            look = style_of(method, results.methods)
            if estimate.mean < left:
                at = left - room
                _arrow(axes, row, wording.number(estimate.mean), at, at + 0.3 * (best - left + room), look[0])
                continue
            draw_interval(axes, row, estimate, look, size=5.5, solid_capstyle="butt")
    _name_x(figure, label)
    return figure


def draw_seconds(results: Results, times: pd.DataFrame) -> Figure:
    """Planning times on a logarithmic axis: median and range by method, a panel for each number of tasks."""
    figure, panels = _panels(results, [Group(tasks) for tasks in results.sizes], 4.2)
    low, high = times["fastest"].min(), times["slowest"].max()
    for axes, tasks in zip(panels, results.sizes, strict=True):
        axes.set_xscale("log")
        axes.tick_params(which="both", length=0)
        axes.set_xlim(low / 1.6, high * 5)
        axes.set_title(counted(tasks, "task"), fontsize=10, color=INK, loc="left")
        for row, method in enumerate(results.methods):
            (line,) = times[(times["tasks"] == tasks) & (times["method"] == method)].to_dict("records")
            colour, marker = style_of(method, results.methods)
            axes.plot([line["fastest"], line["slowest"]], [row, row], color=colour, linewidth=2, zorder=2)
            axes.plot(line["mean"], row, marker, color=colour, markersize=7, zorder=3)
            axes.text(line["slowest"] * 1.15, row, wording.seconds(line["mean"]), fontsize=8.5, color=INK, va="center")
        axes.xaxis.set_major_formatter(lambda value, _: wording.seconds(value))
        axes.xaxis.set_minor_formatter(lambda *_: "")
    _name_x(figure, "time to plan a whole mission (logarithmic)")
    return figure


def draw_gaps(results: Results, gaps: Mapping[str, Estimate]) -> Figure:
    """Mean optimality gap of each method with its interval."""
    methods = list(gaps)
    figure = new_figure(7.0, ROW * len(methods) + 1.0)
    axes = figure.subplots()
    plain(axes)
    for row, (method, estimate) in enumerate(gaps.items()):
        draw_interval(axes, row, estimate, style_of(method, results.methods), size=7)
    axes.set_yticks(range(len(methods)), methods, fontsize=9.5, color=INK)
    axes.set_ylim(len(methods) - 0.45, -0.55)
    axes.set_xlim(left=min(0.0, *(e.low if e.low is not None else e.mean for e in gaps.values())) - 0.3)
    _name_x(figure, "mean optimality gap, % of the tasks that the best plan completes")
    return figure


def _arrow(axes: Any, y: float, text: str, to: float, begin: float, colour: str) -> None:
    """What lies beyond the axis: an arrow towards it, beginning at its number."""
    axes.annotate(
        text, (to, y), (begin, y), color=INK, fontsize=8.5, ha="center", va="center",
        arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.4},
    )  # fmt: skip


def _name_x(figure: Figure, text: str) -> None:
    figure.supxlabel(text, fontsize=9, color=FAINT)
