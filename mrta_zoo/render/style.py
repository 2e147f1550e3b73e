"""What our pictures have in common."""

from __future__ import annotations

from typing import Any

INK, FAINT = "#22303c", "#6b7783"
"""Of text: what matters, and what helps to read it."""

GROUND = "#f5f6f8"
"""Of maps and charts."""

ROBOT_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#882255", "#4d4d4d")
"""One for each robot, from the start again after the last. Okabe and Ito's, which colour-blind people can tell apart
(without yellow and black, with wine and grey); robots are numbered in pictures all the same."""

URGENCY = ("#e03131", "#ff922b", "#ffd8a8", "#fff9ef")
"""Of tasks nobody has taken, from those whose deadline is now to those with all the time of the mission left."""

MISSED = "#000000"


def robot_colour(robot: int) -> str:
    """The colour of a robot in every picture."""
    return ROBOT_COLOURS[robot % len(ROBOT_COLOURS)]


def plain(axes: Any) -> None:
    """Give matplotlib axes a light background with a white grid, and no frame."""
    axes.set_facecolor(GROUND)
    axes.grid(color="white", linewidth=1.2)
    axes.set_axisbelow(True)
    axes.tick_params(colors=FAINT, labelsize=8, length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
