"""What our pictures have in common."""

from __future__ import annotations

from typing import Any

INK, FAINT = "#22303c", "#6b7783"
"""Of text: what matters, and what helps to read it."""


def plain(axes: Any) -> None:
    """Give matplotlib axes a light background with a white grid, and no frame."""
    axes.set_facecolor("#f5f6f8")
    axes.grid(color="white", linewidth=1.2)
    axes.set_axisbelow(True)
    axes.tick_params(colors=FAINT, labelsize=8, length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
