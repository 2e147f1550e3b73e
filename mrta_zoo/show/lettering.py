"""Lettering of pictures: how wide text is, and where labels have room. Lengths are in points, 1/72 of an inch.

Needs matplotlib (``mrta_zoo[plot]``), which it uses without its global state.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from threading import RLock

import numpy as np

from mrta_zoo.extras import importing
from mrta_zoo.scenario import FloatArray
from mrta_zoo.show.shortened import shortened

with importing("plot", "a picture"):
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

AROUND = ((1, 1), (1, -1), (-1, 1), (-1, -1), (1, 0), (-1, 0), (0, 1), (0, -1))
"""Where a label may lie relative to its place, in order of preference."""


_warnings = RLock()


@contextmanager
def any_letters() -> Iterator[None]:
    """Context in which matplotlib does not warn of letters that its font lacks.

    Only one thread at a time may be in it, as warning filters belong to the whole process.
    """
    with _warnings, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from")
        yield


@lru_cache(maxsize=4096)
def text_width(text: str, size: float, weight: str = "normal") -> float:
    """The width of a line of text in matplotlib's own font."""
    with any_letters():
        width, _, _ = text_to_path.get_text_width_height_descent(text, FontProperties(size=size, weight=weight), False)
    return float(width)


def fitted(text: str, room: float, size: float, weight: str = "normal", among: Sequence[str] = ()) -> str:
    """The text if it is no wider than the room, else shortened; see `shortened.shortened`."""
    return shortened(text, lambda form: text_width(form, size, weight) <= room, among)


def round_number(value: float) -> str:
    """A number beside an axis: all its digits except rounding errors."""
    return f"{value:.15g}"


def places_of_labels(
    places: FloatArray, texts: Sequence[str], size: float, clear: FloatArray, frame: tuple[float, float]
) -> dict[int, tuple[float, float]]:
    """Where labels lie beside their places so that none covers another, a mark or the frame.

    Args:
        places: (N, 2) the places to be labelled.
        texts: (N,) the labels.
        size: of the letters.
        clear: (K, 4) boxes to be kept clear: left, bottom, right, top.
        frame: its width and height; labels lie within.

    Returns:
        The lower left corner of each label for which there is room, by its index.
    """
    boxes = np.concatenate((clear, np.empty((len(texts), 4))))
    taken, found = len(clear), {}
    height = 0.8 * size
    for index, ((x, y), text) in enumerate(zip(places.tolist(), texts, strict=True)):
        width = text_width(text, size)
        for right, up in AROUND:
            gap = 3.5 if right and up else 5.0
            left = x + (gap if right > 0 else -gap - width if right < 0 else -width / 2)
            bottom = y + (gap - 1.0 if up > 0 else 1.0 - gap - height if up < 0 else -height / 2)
            box = (left, bottom, left + width, bottom + height)
            if left < 0 or bottom < 0 or box[2] > frame[0] or box[3] > frame[1] or covers(box, boxes[:taken]):
                continue
            boxes[taken] = box
            taken += 1
            found[index] = (left, bottom)
            break
    return found


def covers(box: tuple[float, float, float, float], others: FloatArray) -> bool:
    """Whether a box covers some of the others, each given as left, bottom, right, top."""
    left, bottom, right, top = box
    apart = (others[:, 2] <= left) | (others[:, 0] >= right) | (others[:, 3] <= bottom) | (others[:, 1] >= top)
    return not apart.all()
