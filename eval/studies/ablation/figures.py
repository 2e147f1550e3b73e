"""The study's two figures, each with the data that it shows."""

from __future__ import annotations

import pandas as pd

from mrta_zoo.eval.report.figure_style import FAINT, INK, new_figure, plain
from mrta_zoo.eval.significance import LEVEL
from mrta_zoo.eval.studies.ablation.study import Comparison, Study
from mrta_zoo.extras import importing

with importing("report", "a figure"):
    from matplotlib.figure import Figure

SURE, UNSURE = "#0072b2", "#868f98"
COLOURS = ("#22303c", "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00")
COLUMNS = 3


def forest_data(comparisons: list[Comparison]) -> pd.DataFrame:
    """One line for each comparison, as drawn and tabulated."""
    return pd.DataFrame(
        [
            {
                "question": each.question.name,
                "held_out": each.distribution,
                "variant": each.variant,
                "reference": each.question.reference,
                "difference": each.effect.difference.mean,
                "low": each.effect.difference.low,
                "high": each.effect.difference.high,
                "p": each.effect.p,
                "adjusted_p": each.adjusted,
                "runs_standard_error": each.effect.runs_error,
                "scenarios_standard_error": each.effect.scenarios_error,
                "degrees_of_freedom": each.effect.freedom,
                "runs": each.effect.difference.n,
                "note": each.effect.difference.note,
            }
            for each in comparisons
        ]
    )


def draw_forest(study: Study, comparisons: list[Comparison]) -> Figure:
    """Differences from the reference with their intervals, question by question, blue where they are sure."""
    lines: list[Comparison | str] = []
    for question in study.questions:
        lines.append(f"{question.title} (against {question.reference})")
        lines += [each for each in comparisons if each.question is question]
    figure = new_figure(9.6, 0.8 + 0.29 * len(lines))
    axes = figure.subplots()
    plain(axes, "x")
    axes.axvline(0, color=FAINT, linewidth=1, zorder=2)
    for y, line in enumerate(lines):
        if isinstance(line, str):
            continue
        difference, colour = line.effect.difference, SURE if line.sure else UNSURE
        if difference.low is not None and difference.high is not None:
            axes.plot((difference.low, difference.high), (y, y), color=colour, linewidth=2, zorder=3)
        axes.plot(difference.mean, y, "o" if line.sure else "D", color=colour, markersize=6, zorder=4,
                  markerfacecolor=colour if line.sure else "white")  # fmt: skip
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


def curves_data(study: Study) -> pd.DataFrame:
    """One line for each validation of each run."""
    return pd.DataFrame(
        [
            {"variant": variant, "seed": seed, "episodes": episodes, "completion": completion}
            for (variant, seed), curve in study.curves.items()
            for episodes, completion in zip(curve.episodes, curve.completion, strict=True)
        ]
    )


def draw_curves(study: Study) -> Figure:
    """A panel for each question: validation completion against episodes, thin for runs, bold for their mean."""
    rows = -(-len(study.questions) // COLUMNS)
    columns = min(COLUMNS, len(study.questions))
    figure = new_figure(4.6 * columns, 3.5 * rows)
    panels = list(figure.subplots(rows, columns, squeeze=False).flat)
    data = curves_data(study)
    for axes, question in zip(panels, study.questions, strict=False):
        plain(axes, "both")
        for variant, colour in zip(question.variants, COLOURS, strict=False):
            of_variant = data[data["variant"] == variant]
            for _, run in of_variant.groupby("seed"):
                axes.plot(run["episodes"], 100 * run["completion"], color=colour, linewidth=0.8, alpha=0.45)
            mean = of_variant.groupby("episodes")["completion"].mean()
            axes.plot(mean.index, 100 * mean, color=colour, linewidth=2, label=variant)
        axes.set_title(question.title, fontsize=10, color=INK, loc="left")
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
        axes.legend(
            frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=4, fontsize=8, labelcolor=INK,
            handlelength=1.2, columnspacing=1.0,
        )  # fmt: skip
    for axes in panels[len(study.questions) :]:
        axes.set_axis_off()
    figure.supxlabel("episodes sampled", fontsize=9, color=FAINT)
    figure.supylabel("validation: tasks completed, mean %", fontsize=9, color=FAINT)
    return figure


def _label(study: Study, line: Comparison | str) -> str:
    if isinstance(line, str):
        return line
    where = f", on {line.distribution} scenarios" if len(line.question.distributions) > 1 else ""
    return f"{study.variants[line.variant].title}{where}"
