"""Plan quality against planning time: a line for each method, and how it was made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import pandas as pd

from mrta_zoo.digits import full
from mrta_zoo.eval.machine import Machine
from mrta_zoo.eval.manifest import Manifest
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.figure_style import new_figure, style_of
from mrta_zoo.eval.report.made import busy_note, how_made
from mrta_zoo.eval.report.parts import Picture, Report, Section, Table
from mrta_zoo.eval.rows import KEY, Row
from mrta_zoo.eval.significance import estimate_mean
from mrta_zoo.extras import importing
from mrta_zoo.show.axes import plain
from mrta_zoo.show.palette import FAINT, INK
from mrta_zoo.wording import counted

with importing("report", "a figure"):
    from matplotlib.figure import Figure

BUDGET_KEY = (*KEY, "budget")
"""The columns that tell rows apart."""


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
    frame = pd.DataFrame(map(asdict, rows)).sort_values("case", kind="stable").astype({"budget": float})
    lines = []
    for tasks, of_size in frame.groupby("tasks"):
        for method, budget in order:
            of_budget = of_size["budget"].isna() if budget is None else of_size["budget"] == budget
            found = of_size[of_budget & (of_size["method"] == method)]
            if found.empty:
                continue
            percent = 100 * found["completed"] / found["tasks"]
            estimate = estimate_mean(percent.to_numpy(), seed, found["robots"].tolist())
            lines.append(
                {
                    "tasks": tasks, "method": method, "budget": budget, "cases": estimate.n,
                    "mean_seconds": float(found["seconds"].to_numpy().mean()), **estimate.columns("mean_percent"),
                    "note": estimate.note, "estimate": estimate,
                }
            )  # fmt: skip
    return pd.DataFrame(lines)


def curves_report(curves: pd.DataFrame, manifest: Manifest, machines: Sequence[Machine]) -> Report:
    """All of it.

    Args:
        curves: see `curves_of`.
        manifest: what they depend on.
        machines: on which they were measured.
    """
    shown = pd.DataFrame(
        {
            "method": curves["method"],
            "tasks": curves["tasks"].map(str),
            "budget": [wording.DASH if pd.isna(budget) else f"{full(budget)} s" for budget in curves["budget"]],
            "took": curves["mean_seconds"].map(wording.seconds),
            "completed": [wording.percentage(estimate) for estimate in curves["estimate"]],
            "cases": curves["cases"].map(str),
        }
    )
    caption = (
        f"Tasks completed in time, mean % with its {wording.INTERVAL} over cases (BCa bootstrap), against the measured "
        "planning time per case, mean. The cases are the same for all methods: a difference between two methods can be "
        "significant even where their intervals overlap (mrta-zoo reproduce tests it)."
    )
    section = Section(
        title="Tasks completed against planning time",
        text=busy_note(machines),
        pictures=(Picture(name="curves", caption=f"{caption} Hollow: no budget.", figure=draw_curves(curves)),),
        tables=(Table(name="curves", caption=caption, shown=shown, data=curves.drop(columns="estimate")),),
    )
    summary = []
    for tasks, of_size in curves.groupby("tasks"):
        longest = of_size.groupby("method", sort=False).tail(1).sort_values("mean_percent", ascending=False)
        ranking = ", ".join(
            f"{line.method} {line.mean_percent:.1f} % in {wording.seconds(line.mean_seconds)}"
            for line in longest.itertuples()
        )
        cases = f"{counted(tasks, 'task')} ({counted(longest['cases'].max(), 'case')})"
        summary.append(f"{cases}, tasks completed in time, mean, at the longest budget: {ranking}.")
    return Report(
        title="Quality of plans against planning time",
        summary=tuple(summary),
        sections=(section,),
        made=how_made(manifest, manifest.settings, machines),
    )


def draw_curves(curves: pd.DataFrame) -> Figure:
    """Mean % completed against measured seconds (logarithmic), a panel for each number of tasks, a line a method."""
    sizes = curves["tasks"].unique().tolist()
    methods = curves["method"].unique().tolist()
    figure = new_figure(7.6 * len(sizes), 4.8)
    for axes, tasks in zip(figure.subplots(1, len(sizes), squeeze=False)[0], sizes, strict=True):
        plain(axes)
        panel = curves[curves["tasks"] == tasks]
        named = []  # to matplotlib itself, a label that begins with _ is none
        for method, line in panel.sort_values("mean_seconds").groupby("method", sort=False):
            colour, marker = style_of(method, methods)
            for budgeted, points in line.groupby(line["budget"].notna()):
                (drawn,) = axes.plot(points["mean_seconds"], points["mean_percent"], "-" if budgeted else "",
                                     marker=marker, color=colour, markersize=6.5, linewidth=1.8,
                                     markerfacecolor=colour if budgeted else "white")  # fmt: skip
                named.append((points["mean_percent"].iloc[-1], drawn, method if budgeted else f"{method}, no budget"))
        _, lines, names = zip(*sorted(named, key=lambda each: -each[0]), strict=True)
        axes.legend(lines, names, frameon=False, loc="lower right", fontsize=9, labelcolor=INK)
        axes.set_title(
            f"{counted(tasks, 'task')}, {counted(panel['cases'].max(), 'case')}", fontsize=10, color=INK, loc="left"
        )
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.set_xlabel("measured planning time per case, mean, seconds (logarithmic)", fontsize=9, color=FAINT)
        axes.set_ylabel(f"tasks completed in time, mean % of {tasks}", fontsize=9, color=FAINT)
    return figure
