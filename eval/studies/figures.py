"""What the figures of all studies have in common: a panel for each question."""

from __future__ import annotations

from typing import Any

from mrta_zoo.eval.report.figure_style import INK, new_figure, plain
from mrta_zoo.eval.studies.design import Question
from mrta_zoo.eval.studies.study import Study
from mrta_zoo.extras import importing

with importing("report", "a figure"):
    from matplotlib.figure import Figure


def question_panels(
    study: Study, width: float, height: float, *, columns: int = 0, grid: str = "both", sharey: bool = False
) -> tuple[Figure, list[tuple[Any, Question]]]:
    """A figure, and its panels with their questions.

    Args:
        study: gives the questions.
        width: of a panel, in inches.
        height: likewise.
        columns: panels in a line, at most; 0 for all of them.
        grid: along which axes there are lines, see `plain`.
        sharey: whether all panels have the same scale.
    """
    questions = study.design.questions
    columns = min(columns or len(questions), len(questions))
    lines = -(-len(questions) // columns)
    figure = new_figure(width * columns, height * lines)
    panels = list(figure.subplots(lines, columns, squeeze=False, sharey=sharey).flat)
    for axes, question in zip(panels, questions, strict=False):
        plain(axes, grid)
        axes.set_title(question.title, fontsize=10, color=INK, loc="left")
    for axes in panels[len(questions) :]:
        axes.set_axis_off()
    return figure, list(zip(panels, questions, strict=False))
