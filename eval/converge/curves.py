"""Plan quality against planning time, as a table and as a figure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from mrta_zoo.digits import full, percentage, rounded
from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.figure_style import FAINT, INK, new_figure, plain, save_figure, style_of
from mrta_zoo.eval.rows import KEY, Row
from mrta_zoo.eval.significance import estimate_mean
from mrta_zoo.extras import importing
from mrta_zoo.io.outputs import Outputs
from mrta_zoo.io.source import write_text
from mrta_zoo.show.terminal.console import results_console, say
from mrta_zoo.show.terminal.sheet import Sheet
from mrta_zoo.wording import counted

with importing("report", "a figure"):
    from matplotlib.figure import Figure
    from matplotlib.patheffects import withStroke

NEAR = 2.0
"""Lines that end within this factor of each other have their names in one column."""
BUDGET_KEY = (*KEY, "budget")
"""The columns that tell rows apart."""
HALO = [withStroke(linewidth=3, foreground="white")]


@dataclass(frozen=True, slots=True)
class BudgetRow(Row):
    """A row of a method under a time budget.

    Attributes:
        budget: seconds that it was allowed, None if it had none.
    """

    budget: float | None = None


def curves_of(rows: Sequence[BudgetRow], order: Sequence[tuple[str, float | None]], seed: int) -> pd.DataFrame:
    """One line for each number of tasks, method and budget: measured mean seconds, mean % completed, its interval.

    Args:
        rows: of any methods, budgets and cases; those of methods and budgets not in `order` are left out.
        order: methods and budgets as they shall come.
        seed: of the bootstrap over cases, which stays within each number of robots.
    """
    by_point: dict[tuple[int, str, float | None], list[BudgetRow]] = {}
    for row in sorted(rows, key=lambda row: row.case):
        by_point.setdefault((row.tasks, row.method, row.budget), []).append(row)
    lines = []
    for tasks in sorted({row.tasks for row in rows}):
        for method, budget in order:
            found = by_point.get((tasks, method, budget))
            if not found:
                continue
            estimate = estimate_mean(
                [100 * row.completed / row.tasks for row in found], seed, [row.robots for row in found]
            )
            lines.append(
                {
                    "tasks": tasks, "method": method, "budget": budget, "cases": estimate.n,
                    "mean_seconds": float(np.mean([row.seconds for row in found])),
                    **estimate.columns("mean_percent"), "note": estimate.note,
                }
            )  # fmt: skip
    return pd.DataFrame(lines)


def draw_curves(curves: pd.DataFrame) -> Figure:
    """Mean % completed against measured seconds (logarithmic), a panel for each number of tasks, a line a method.

    Methods are named at the end of their lines, one above the other where they would overlap.
    """
    sizes = curves["tasks"].unique().tolist()
    methods = curves["method"].unique().tolist()
    figure = new_figure(7.6 * len(sizes), 4.8)
    for axes, tasks in zip(figure.subplots(1, len(sizes), squeeze=False)[0], sizes, strict=True):
        plain(axes, "both")
        axes.set_xscale("log")
        panel = curves[curves["tasks"] == tasks]
        low, high = panel["mean_seconds"].min(), panel["mean_seconds"].max()
        axes.set_xlim(low / (max(high / low, 10) ** 0.2), high * (max(high / low, 10) ** 0.22) * 1.3)
        ends = []
        for method in dict.fromkeys(panel["method"]):
            line = panel[panel["method"] == method].sort_values("mean_seconds")
            x, y = line["mean_seconds"].to_numpy(), line["mean_percent"].to_numpy()
            colour, marker = style_of(method, methods)
            with_budget = line["budget"].notna().to_numpy()
            if with_budget.any():
                axes.plot(x[with_budget], y[with_budget], "-", marker=marker, color=colour, markersize=6, linewidth=1.8,
                          zorder=3)  # fmt: skip
                ends.append((y[with_budget][-1], x[with_budget][-1], method, colour))
            for at, mean in zip(x[~with_budget], y[~with_budget], strict=True):
                axes.plot(at, mean, marker, color=colour, markersize=7, markerfacecolor="white", zorder=3)
                axes.annotate(f"{method},\nno budget", (at, mean), (-8, 0), textcoords="offset points", fontsize=9,
                              color=INK, ha="right", va="center", zorder=4, path_effects=HALO)  # fmt: skip
        _name_ends(axes, ends)
        axes.set_title(
            f"{counted(tasks, 'task')}, {counted(panel['cases'].max(), 'case')}", fontsize=10, color=INK, loc="left"
        )
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.set_xlabel("measured planning time a case, mean, seconds (logarithmic)", fontsize=9, color=FAINT)
        axes.set_ylabel(f"tasks completed in time, mean % of {tasks}", fontsize=9, color=FAINT)
    return figure


def _name_ends(axes: object, ends: Sequence[tuple[float, float, str, str]]) -> None:
    """Write names to the right of (y, x), moved apart where they lie closer than a line of text."""
    low, high = axes.get_ylim()  # type: ignore[attr-defined]
    line = (high - low) * 0.042
    furthest = max((x for _, x, _, _ in ends), default=1.0)
    placed: list[tuple[float, float]] = []
    for y, x, name, colour in sorted(ends):
        at, column = y, furthest if furthest < NEAR * x else x
        for other_x, other_y in placed:
            if abs(np.log10(x / other_x)) < 1.0 and at < other_y + line:
                at = other_y + line
        placed.append((x, at))
        axes.annotate(  # type: ignore[attr-defined]
            name, (x, y), (1.12 * column, at), fontsize=9, color=INK, va="center", zorder=4, path_effects=HALO,
            arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.7, "shrinkA": 0, "shrinkB": 3}
            if at != y else None,
        )  # fmt: skip


def publish_curves(curves: pd.DataFrame, folder: Path) -> None:
    """Write ``curves.csv`` and the figure, and print the table and where they are.

    Raises:
        ConfigError: if a file cannot be written.
    """
    text = curves.to_csv(index=False, lineterminator="\n")
    with Outputs() as outputs:
        outputs.write("data", folder / "curves.csv", lambda path: write_text(text, path, ConfigError))
        outputs.write(
            "figure", folder / "curves.png", lambda path: save_figure(draw_curves(curves), path.with_suffix(""))
        )
        tell_curves(curves)
        for line in outputs.written:
            say(results_console(), line)


def tell_curves(curves: pd.DataFrame) -> None:
    """Print the curves as a table."""
    console = results_console()
    console.print(_sheet(curves), crop=False)
    say(
        console,
        "The cases are the same for all methods: a difference between two methods can be sure even where their "
        "intervals overlap (mrta-zoo reproduce tests it).",
    )


def _sheet(curves: pd.DataFrame) -> Sheet:
    lines = [
        (
            str(line["tasks"]), line["method"], wording.DASH if pd.isna(line["budget"]) else full(line["budget"]),
            rounded(line["mean_seconds"], 3), f"{percentage(line['mean_percent'])} [{_ends(line)}]", str(line["cases"]),
        )
        for line in curves.to_dict("records")
    ]  # fmt: skip
    title = f"Tasks completed, mean % with its {wording.INTERVAL} over cases; budget and time taken in seconds"
    return Sheet(title, ("tasks", "method", "budget", "took", "completed", "cases"), lines, left=("method",))


def _ends(line: dict[str, Any]) -> str:
    return line["note"] if pd.isna(line["low"]) else f"{percentage(line['low'])}, {percentage(line['high'])}"
