"""How figures of comparisons look: one colour and one marker for each method, the same in all of them.

Needs matplotlib, which it uses without its global state.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from threading import Lock

from mrta_zoo.extras import importing
from mrta_zoo.io.atomic import replacing
from mrta_zoo.show.figure import LiteralFigure

with importing("report", "a figure"):
    import matplotlib
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

STYLES = {
    "random": ("#b0b7be", "o"),
    "edf": ("#868f98", "s"),
    "nearest": ("#59626b", "D"),
    "big-mrta": ("#e69f00", "P"),
    "ils": ("#d55e00", "^"),
    "eils": ("#882255", "v"),
    "pyvrp": ("#000000", "X"),
    "exact": ("#000000", "*"),
    "am": ("#cc79a7", "h"),
    "capam-p1": ("#a6d4f2", "<"),
    "capam-p2": ("#56b4e9", ">"),
    "capam": ("#0072b2", "o"),
    "capam-plus": ("#009e73", "s"),
    "capam-plus+polish": ("#004d3a", "p"),
}
"""Colour and marker by method. Okabe and Ito's colours, which colour-blind people can tell apart, greys for the simple
heuristics, and shades of one blue for the variants of one network; figures name their methods beside the marks, too."""

OTHERS = (("#6a3d9a", "p"), ("#7f5a2b", "d"), ("#4d4d4d", "H"), ("#b5a100", "8"), ("#1f4e79", "*"))
"""For methods of the user's, in order."""


def style_of(method: str, methods: Sequence[str]) -> tuple[str, str]:
    """Colour and marker of one of the methods that a report is about."""
    if method in STYLES:
        return STYLES[method]
    strangers = [each for each in methods if each not in STYLES]
    return OTHERS[strangers.index(method) % len(OTHERS)]


def new_figure(width: float, height: float) -> Figure:
    """An empty figure, sides in inches."""
    layout = ConstrainedLayoutEngine(h_pad=0.06, w_pad=0.06, hspace=0.06, wspace=0.05)
    return LiteralFigure(figsize=(width, height), facecolor="white", layout=layout)


_setting = Lock()
"""One thread at a time: matplotlib's settings are the whole process's."""


def save_figure(figure: Figure, stem: Path) -> None:
    """Write ``stem.png`` and ``stem.svg``; equal figures give equal files."""
    with replacing(stem.with_suffix(".png")) as partial:
        figure.savefig(partial, format="png", dpi=140, metadata={"Software": None})
    with replacing(stem.with_suffix(".svg")) as partial, _setting, matplotlib.rc_context({"svg.hashsalt": "mrta_zoo"}):
        figure.savefig(partial, format="svg", metadata={"Date": None, "Creator": None})
