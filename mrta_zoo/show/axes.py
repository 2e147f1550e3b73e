"""The look of matplotlib's axes in our pictures."""

from __future__ import annotations

from typing import Any

from mrta_zoo.show.palette import FAINT, GROUND


def plain(axes: Any) -> None:
    """Give matplotlib axes a light background with a white grid, and no frame."""
    axes.set_facecolor(GROUND)
    axes.grid(color="white", linewidth=1.2)
    axes.set_axisbelow(True)
    axes.tick_params(which="both", colors=FAINT, labelsize=8, length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
