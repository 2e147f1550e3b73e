"""Markup for notebooks: a table, and a small map as SVG. Needs no library."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from unicodedata import bidirectional

from mrta_zoo.digits import full, rounded
from mrta_zoo.show.palette import FAINT, GROUND, URGENCY, blend, robot_colour

MOST_ROWS = 20
"""The most rows of a table; the others are only counted."""
_SIDE = 320.0
LITERAL = "tex2jax_ignore mathjax_ignore"
"""The classes of elements in which notebooks leave dollar signs alone instead of reading them as mathematics."""
_CELL = "text-align:left;padding:2px 12px 2px 0"


def table(title: str, header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table under a title; floats are rounded, see `digits.rounded`.

    Args:
        title: plain text, as are all cells.
        header: names of the columns.
        rows: their values; only the first `MOST_ROWS` are shown.
    """
    every = list(rows)
    lines = [f'<div class="{LITERAL}"><div><b>{escape(title)}</b></div><table style="border-collapse:collapse"><tr>']
    lines += [f'<th style="{_CELL}">{escape(name)}</th>' for name in header]
    lines.append("</tr>")
    for row in every[:MOST_ROWS]:
        cells = (f'<td style="{_CELL}">{escape(_text(value))}</td>' for value in row)
        lines.append(f"<tr>{''.join(cells)}</tr>")
    lines.append("</table>")
    if len(every) > MOST_ROWS:
        lines.append(f"<div>and {len(every) - MOST_ROWS} more</div>")
    lines.append("</div>")
    return "".join(lines)


def in_order(names: Iterable[object]) -> str:
    """Names as plain text, in order from left to right even if some are in right-to-left scripts."""
    return " → ".join(set_apart(str(name)) for name in names)


def set_apart(name: str) -> str:
    """A name as plain text; in a right-to-left script it is isolated, so that the text after it stays after it."""
    return f"\u2068{name}\u2069" if any(map(_from_right, name)) else name


def map_of(
    low: tuple[float, float],
    size: tuple[float, float],
    tasks: Sequence[tuple[str, float, float, float]],
    robots: Sequence[tuple[str, float, float]],
    horizon: float,
) -> str:
    """A map as SVG: tasks, redder the earlier their deadlines, and a square where each robot starts.

    Args:
        low: the lowest x and y that are shown.
        size: width and height of the part shown, in distance units, > 0.
        tasks: name, place and deadline of each.
        robots: name and place of each.
        horizon: the deadline, > 0, from which on tasks are palest.
    """
    scale = _SIDE / max(size)
    width, height = (scale * side for side in size)
    radius = max(1.5, min(4.0, 40.0 / len(tasks) ** 0.5))
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width + 20:.0f}" height="{height + 20:.0f}" '
        f'viewBox="-10 -10 {width + 20:.1f} {height + 20:.1f}">'
        f'<rect x="-10" y="-10" width="{width + 20:.1f}" height="{height + 20:.1f}" fill="{GROUND}"/>'
    ]
    for name, x, y, deadline in tasks:
        lines.append(
            f'<circle cx="{scale * (x - low[0]):.1f}" cy="{height - scale * (y - low[1]):.1f}" r="{radius:.1f}" '
            f'fill="{blend(URGENCY, deadline / horizon)}" stroke="{FAINT}" stroke-width="0.7">'
            f"<title>{escape(name)}, deadline {full(deadline)}</title></circle>"
        )
    for robot, (name, x, y) in enumerate(robots):
        lines.append(
            f'<rect x="{scale * (x - low[0]) - 4:.1f}" y="{height - scale * (y - low[1]) - 4:.1f}" '
            f'width="8" height="8" fill="{robot_colour(robot)}" stroke="#ffffff"><title>{escape(name)}</title></rect>'
        )
    lines.append("</svg>")
    return "".join(lines)


def _from_right(character: str) -> bool:
    return bidirectional(character) in ("R", "AL")


def _text(value: object) -> str:
    return rounded(value) if isinstance(value, float) else str(value)
