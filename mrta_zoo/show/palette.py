"""The colours of all our pictures and pages, as ``#rrggbb``."""

from __future__ import annotations

from collections.abc import Sequence

INK, FAINT = "#22303c", "#6b7783"
"""Colours of text: what matters, and what helps to read it."""

GROUND = "#f5f6f8"
"""The background of maps and charts."""

ROBOT_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#882255", "#4d4d4d")
"""One for each robot, starting again after the last. Okabe and Ito's, which colour-blind people can tell apart (without
yellow and black, with wine and grey); even so, pictures number the robots."""

URGENCY = ("#e03131", "#ff922b", "#ffd8a8", "#fff9ef")
"""Colours of tasks nobody has taken, from those due now to those with all the time of the mission left."""

MISSED = "#000000"


def robot_colour(robot: int) -> str:
    """The colour of a robot in every picture."""
    return ROBOT_COLOURS[robot % len(ROBOT_COLOURS)]


def blend(colours: Sequence[str], share: float) -> str:
    """The colour at `share`, 0 to 1, of the way from the first to the last; outside that range, the nearer end's."""
    place = min(max(share, 0.0), 1.0) * (len(colours) - 1)
    index = min(int(place), len(colours) - 2)
    below, above = (bytes.fromhex(colour[1:]) for colour in colours[index : index + 2])
    mix = (round(a + (place - index) * (b - a)) for a, b in zip(below, above, strict=True))
    return "#" + bytes(mix).hex()
