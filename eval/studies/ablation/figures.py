"""The study's two figures."""

from __future__ import annotations

import pandas as pd

from mrta_zoo.eval.report.figure_style import FAINT, INK, draw_interval, new_figure, plain
from mrta_zoo.eval.significance import LEVEL
from mrta_zoo.eval.studies.figures import question_panels
from mrta_zoo.eval.studies.study import Contrast, Study
from mrta_zoo.extras import importing

with importing("report", "a figure"):
    from matplotlib.figure import Figure

SURE, UNSURE = "#0072b2", "#868f98"
COLOURS = ("#22303c", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00")
COLUMNS = 3


def draw_forest(study: Study) -> Figure:
    """Differences from the reference with their intervals, question by question, blue where they are sure."""
    lines: list[Contrast | str] = []
    for question in study.design.questions:
        lines.append(f"{question.title} (against {question.reference})")
        lines += [each for each in study.contrasts if each.question is question]
    figure = new_figure(9.6, 0.8 + 0.29 * len(lines))
    axes = figure.subplots()
    plain(axes, "x")
    axes.axvline(0, color=FAINT, linewidth=1, zorder=2)
    for y, line in enumerate(lines):
        if not isinstance(line, str):
            look = (SURE, "o") if line.sure else (UNSURE, "D")
            draw_interval(axes, y, line.effect.difference, look, size=6, filled=line.sure)
    axes.set_yticks(range(len(lines)), [_label(study, line) for line in lines])
    for label, line in zip(axes.get_yticklabels(), lines, strict=True):
        label.set_color(INK)
        label.set_fontweight("bold" if isinstance(line, str) else "normal")
    axes.set_ylim(len(lines) - 0.5, -0.7)
    axes.set_xlabel(
        f"difference in tasks completed, percentage points, with its {100 * LEVEL:.0f} % interval\n"
        "filled: sure after adjustment",
        fontsize=9, color=FAINT,
    )  # fmt: skip
    return figure


def draw_curves(study: Study, data: pd.DataFrame) -> Figure:
    """A panel for each question: validation completion against episodes, thin for runs, bold for their mean."""
    figure, panels = question_panels(study, 4.6, 3.5, columns=COLUMNS)
    for axes, question in panels:
        for arm, colour in zip(question.arms, COLOURS, strict=False):
            of_arm = data[data["variant"] == arm]
            for _, run in of_arm.groupby("seed"):
                axes.plot(run["episodes"], 100 * run["completion"], color=colour, linewidth=0.8, alpha=0.45)
            mean = of_arm.groupby("episodes")["completion"].mean()
            axes.plot(mean.index, 100 * mean, color=colour, linewidth=2, label=arm)
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
        axes.legend(
            frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=4, fontsize=8, labelcolor=INK,
            handlelength=1.2, columnspacing=1.0,
        )  # fmt: skip
    figure.supxlabel("episodes sampled", fontsize=9, color=FAINT)
    figure.supylabel("validation: tasks completed, mean %", fontsize=9, color=FAINT)
    return figure


def _label(study: Study, line: Contrast | str) -> str:
    if isinstance(line, str):
        return line
    where = f", on {line.distribution} scenarios" if len(line.question.distributions) > 1 else ""
    return f"{study.design.arms[line.arm].title}{where}"
