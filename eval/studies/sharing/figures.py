"""The study's two figures, and the data of the learning curves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from scipy import stats

from mrta_zoo.eval.report.figure_style import FAINT, INK
from mrta_zoo.eval.significance import LEVEL
from mrta_zoo.eval.studies.design import Question
from mrta_zoo.eval.studies.figures import question_panels
from mrta_zoo.eval.studies.study import Study
from mrta_zoo.extras import importing
from mrta_zoo.policies.neural.sharing import Sharing

with importing("report", "a figure"):
    from matplotlib.figure import Figure

LOOKS: dict[Sharing, tuple[str, str]] = {
    "shared": ("#0072b2", "o"), "by-capacity": ("#009e73", "s"), "independent": ("#d55e00", "^"),
}  # fmt: skip
"""Colour and marker."""
APART = 0.14
"""Of marks of the same number of robots, so that they do not hide one another."""


def curves_data(study: Study) -> pd.DataFrame:
    """One row per arm and validation: % completed, mean over runs, with its interval, and each run's."""
    lines = []
    for name, arm in study.design.arms.items():
        curves = [study.curves[name, seed] for seed in range(study.design.seeds)]
        for point, episodes in enumerate(curves[0].episodes):
            of_runs = [100 * curve.completion[point] for curve in curves]
            low, high = band(of_runs)
            lines.append(
                {"arm": name, "update": curves[0].updates[point], "episodes": episodes,
                 "episodes_a_network": episodes / arm.networks, "percent": float(np.mean(of_runs)), "low": low,
                 "high": high, **{f"seed_{seed}": value for seed, value in enumerate(of_runs)}}
            )  # fmt: skip
    return pd.DataFrame(lines)


def band(of_runs: Sequence[float]) -> tuple[float | None, float | None]:
    """Student's interval of the mean of some runs; none of a single one."""
    if len(of_runs) < 2:
        return None, None
    half = float(stats.t.ppf((1 + LEVEL) / 2, len(of_runs) - 1) * np.std(of_runs, ddof=1) / np.sqrt(len(of_runs)))
    mean = float(np.mean(of_runs))
    return mean - half, mean + half


def draw_curves(study: Study, data: pd.DataFrame) -> Figure:
    """A panel for each question: the arms' learning curves with bands, against what is equal in the end."""
    figure, panels = question_panels(study, 5.2, 4.1, sharey=True)
    for axes, question in panels:
        measure = _measure(question)
        for name in question.arms:
            of_arm = data[data["arm"] == name]
            x, (colour, _) = of_arm[measure], LOOKS[study.design.arms[name].config.sharing]
            if of_arm["low"].notna().all():
                axes.fill_between(x, of_arm["low"], of_arm["high"], color=colour, alpha=0.15, linewidth=0)
            for seed in range(study.design.seeds):
                axes.plot(x, of_arm[f"seed_{seed}"], color=colour, linewidth=0.7, alpha=0.5)
            axes.plot(x, of_arm["percent"], color=colour, linewidth=2, label=name)
        axes.set_xlabel(measure.replace("_", " "), fontsize=9, color=FAINT)
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
        axes.set_ylim(max(0, data["percent"].min() - 5), min(100, data["percent"].max() + 5))
        axes.legend(frameon=False, loc="lower right", fontsize=8.5, labelcolor=INK)
    panels[0][0].set_ylabel("validation: tasks completed, mean %", fontsize=9, color=FAINT)
    return figure


def draw_by_robots(study: Study, data: pd.DataFrame) -> Figure:
    """A panel for each question: % completed by number of robots with intervals, those trained on shaded."""
    figure, panels = question_panels(study, 5.2, 3.9, grid="y", sharey=True)
    counts = list(study.design.held_out.robots)
    trained = [place for place, robots in enumerate(counts) if robots in study.design.compared]
    for axes, question in panels:
        axes.axvspan(trained[0] - 0.5, trained[-1] + 0.5, color="#f2f4f6", zorder=0)
        nearest = data[data["arm"] == "nearest"]
        axes.plot(range(len(counts)), nearest["percent"], color=FAINT, linewidth=1, linestyle=":", label="nearest")
        for offset, name in enumerate(question.arms, start=-1):
            of_arm, (colour, marker) = data[data["arm"] == name], LOOKS[study.design.arms[name].config.sharing]
            x = [counts.index(robots) + APART * offset for robots in of_arm["robots"]]
            if of_arm["low"].notna().all():
                axes.vlines(x, of_arm["low"], of_arm["high"].clip(upper=100), color=colour, linewidth=1.6)
            axes.plot(x, of_arm["percent"], marker, color=colour, markersize=5.5, label=name)
        axes.set_xticks(range(len(counts)), [str(robots) for robots in counts])
        axes.set_xlabel("robots (shaded: numbers trained on)", fontsize=9, color=FAINT)
        axes.legend(frameon=False, loc="lower right", fontsize=8.5, labelcolor=INK)
    panels[0][0].set_ylabel("held-out scenarios: tasks completed, mean %", fontsize=9, color=FAINT)
    return figure


def _measure(question: Question) -> str:
    """The column that is equal at the end of the question's runs."""
    return "episodes" if question.name == "episodes" else "episodes_a_network"
