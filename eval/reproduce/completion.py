"""How many tasks each method completes: Fig. 3 of the paper, as box plots and as a table."""

from __future__ import annotations

import pandas as pd

from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.figure_style import new_figure, style_of
from mrta_zoo.eval.report.parts import Picture, Section, Table
from mrta_zoo.eval.reproduce.results import BOOTSTRAP, Results
from mrta_zoo.extras import importing
from mrta_zoo.show.axes import plain
from mrta_zoo.show.palette import FAINT, INK
from mrta_zoo.wording import counted

with importing("report", "a figure"):
    from matplotlib.figure import Figure


def completion_section(results: Results) -> Section:
    """Box plots and means by number of robots, one of each for each number of tasks."""
    pictures, tables = [], []
    for tasks in results.sizes:
        pictures.append(
            Picture(
                name=f"completion_{tasks}",
                caption=f"Tasks completed in time, % of the {counted(tasks, 'task')} of a case (as Fig. 3 of the "
                f"paper). {case_counts(results, tasks)} Box: middle half of the cases with the median; "
                "whiskers: furthest case within 1.5 times the length of the box; dots: cases beyond; diamond: mean. "
                "Single cases are in rows.csv.",
                figure=draw_boxes(results, tasks),
            )
        )
        tables.append(
            estimate_table(
                results, tasks, "percent", f"completion_{tasks}",
                f"Tasks completed in time, mean % of the {counted(tasks, 'task')} of a case.",
            )
        )  # fmt: skip
    return Section(title="Tasks completed", pictures=tuple(pictures), tables=tuple(tables))


def draw_boxes(results: Results, tasks: int) -> Figure:
    """Completion by method and number of robots as horizontal box plots over the cases."""
    groups, methods = [each for each in results.groups(tasks) if each.robots is not None], results.methods
    figure = new_figure(2.6 * len(groups) + 1.4, 0.34 * len(methods) + 1.0)
    for axes, group in zip(
        figure.subplots(1, len(groups), sharex=True, sharey=True, squeeze=False)[0], groups, strict=True
    ):
        plain(axes)
        axes.set_title(group.label, fontsize=10, color=INK, loc="left")
        boxes = axes.boxplot(
            [results.select(group, method)["percent"].to_numpy() for method in methods],
            orientation="horizontal", manage_ticks=False, widths=0.62, patch_artist=True, showmeans=True,
            flierprops={"marker": ".", "markersize": 4, "markeredgecolor": FAINT},
            meanprops={"marker": "D", "markersize": 4.5, "markerfacecolor": "white", "markeredgecolor": INK},
            medianprops={"color": INK, "linewidth": 1.8}, whiskerprops={"color": FAINT}, capprops={"color": FAINT},
        )  # fmt: skip
        for box, method in zip(boxes["boxes"], methods, strict=True):
            box.set(facecolor=style_of(method, methods)[0], alpha=0.45, edgecolor="none")
    figure.axes[0].set_yticks(range(1, len(methods) + 1), methods, color=INK)
    axes.set_ylim(len(methods) + 0.5, 0.5)
    figure.supxlabel(f"tasks completed in time, % of {tasks}", fontsize=9, color=FAINT)
    return figure


def case_counts(results: Results, tasks: int) -> str:
    """How many cases each column stands on."""
    whole, *by_robots = results.groups(tasks)
    each = ", ".join(f"{results.cases(group)} with {group.label}" for group in by_robots)
    return f"n = {counted(results.cases(whole), 'case')}{f': {each}' if each else ''}."


def estimate_table(results: Results, tasks: int, column: str, name: str, caption: str) -> Table:
    """Means of a column with intervals: a line for each method, a column for each group of cases.

    Args:
        results: what was measured.
        tasks: of cases with so many tasks.
        column: of the results' frame, in %; more is better.
        name: of the table.
        caption: what the column is.
    """
    data = results.estimates(tasks, column)
    labels = [group.label for group in results.groups(tasks)]
    shown = pd.DataFrame({"method": results.methods})
    bold = set()
    for place, (label, (_, found)) in enumerate(zip(labels, data.groupby("robots", sort=False), strict=True), start=1):
        shown[label] = [wording.percentage(estimate) for estimate in found["estimate"]]
        means = found[f"mean_{column}"].round(6).to_numpy()
        bold |= {(row, place) for row in range(len(means)) if len(means) > 1 and means[row] == means.max()}
    caption = (
        f"{caption} In brackets the {wording.INTERVAL} ({BOOTSTRAP}). {case_counts(results, tasks)} Bold: the highest "
        "mean of a column, be the lead significant or not."
    )
    data = data.drop(columns="estimate")
    return Table(name=name, caption=caption, shown=shown, data=data, bold=frozenset(bold))
