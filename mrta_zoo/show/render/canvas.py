"""A canvas of pixels, with the few shapes and the text that pictures of missions are made of.

Needs pygame (``mrta_zoo[render]``) but not its display, so that it draws in any thread and on any machine.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from functools import lru_cache
from io import BytesIO
from math import hypot

import numpy as np
import numpy.typing as npt

from mrta_zoo.extras import require
from mrta_zoo.show.shortened import shortened

os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")  # a library does not advertise in its users' output
require("render", "a picture")

import pygame  # noqa: E402  (after the check, whose message says how to install it)

Point = tuple[float, float]
SCALE = 2
"""Shapes are drawn this much larger, then shrunk, which makes their edges smooth."""
_IN_NO_FONT = "\uffff"


class Canvas:
    """A picture being drawn. Coordinates and sizes are in pixels of the finished picture, from its upper left corner.

    Args:
        size: width and height in pixels.
        background: its colour; this and all other colours are ``#rrggbb``.
    """

    def __init__(self, size: tuple[int, int], background: str) -> None:
        self.size = size
        self._surface = pygame.Surface((SCALE * size[0], SCALE * size[1]), depth=24)
        self._surface.fill(background)

    def finished(self) -> pygame.Surface:
        """The picture in its true size."""
        return pygame.transform.smoothscale(self._surface, self.size)

    def rectangle(self, corner: Point, size: Point, colour: str) -> None:
        """A filled rectangle, given its upper left corner."""
        self._surface.fill(colour, pygame.Rect(_big(corner), _big(size)))

    def square(self, centre: Point, side: float, fill: str, edge: str, width: float) -> None:
        """A filled square with an edge `width` pixels wide."""
        for length, colour in ((side, edge), (side - 2 * width, fill)):
            self.rectangle((centre[0] - length / 2, centre[1] - length / 2), (length, length), colour)

    def disc(self, centre: Point, radius: float, fill: str, edge: str, width: float) -> None:
        """A filled disc with an edge `width` pixels wide."""
        place = _big(centre)
        pygame.draw.circle(self._surface, edge, place, SCALE * radius)
        pygame.draw.circle(self._surface, fill, place, SCALE * (radius - width))

    def line(self, start: Point, end: Point, colour: str, width: float) -> None:
        """A straight line."""
        pygame.draw.line(self._surface, colour, _big(start), _big(end), round(SCALE * width))

    def dashes(self, start: Point, end: Point, colour: str, width: float, dash: float = 5.0) -> None:
        """A dashed line; dashes and gaps are `dash` pixels long."""
        length = hypot(end[0] - start[0], end[1] - start[1])
        for begin in np.arange(0.0, length, 2 * dash):
            a, b = begin / length, min(begin + dash, length) / length
            self.line(_between(start, end, a), _between(start, end, b), colour, width)

    def cross(self, centre: Point, radius: float, colour: str, width: float) -> None:
        """A cross in the shape of an x."""
        x, y = centre
        self.line((x - radius, y - radius), (x + radius, y + radius), colour, width)
        self.line((x - radius, y + radius), (x + radius, y - radius), colour, width)

    def text(self, text: str, place: Point, size: float, colour: str, align: float = 0.0) -> None:
        """One line of text, vertically centred on `place`; with `align` 0 it begins there, with 1 it ends there."""
        image = _written(text, round(SCALE * size), colour)
        x, y = _big(place)
        self._surface.blit(image, (x - align * image.get_width(), y - image.get_height() / 2))


def text_width(text: str, size: float) -> float:
    """The width of a line of text, in pixels of the finished picture."""
    return _font(round(SCALE * size)).size(_shown(text))[0] / SCALE


def fitted(name: str, otherwise: str, size: float, room: float, among: Sequence[str] = ()) -> str:
    """A name within `room` pixels, shortened if need be; `otherwise` if the font lacks one of its characters."""
    metrics = _font(round(SCALE * size)).metrics
    if metrics(_IN_NO_FONT)[0] in metrics(_shown(name)):  # which it draws as boxes
        return otherwise
    return shortened(name, lambda text: text_width(text, size) <= room, among) or "…"


def as_array(picture: pygame.Surface) -> npt.NDArray[np.uint8]:
    """(height, width, 3) uint8."""
    width, height = picture.get_size()
    return np.frombuffer(pygame.image.tobytes(picture, "RGB"), np.uint8).reshape(height, width, 3).copy()


def as_png(picture: pygame.Surface) -> bytes:
    """The contents of a PNG file."""
    file = BytesIO()
    pygame.image.save(picture, file, ".png")
    return file.getvalue()


@lru_cache(maxsize=1024)
def _written(text: str, size: int, colour: str) -> pygame.Surface:
    return _font(size).render(_shown(text), True, colour)


def _shown(text: str) -> str:
    """Text that pygame accepts, on one line: unprintable characters become spaces."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


@lru_cache(maxsize=32)
def _font(size: int) -> pygame.Font:
    pygame.font.init()
    return pygame.font.Font(None, size)  # pygame's own font, so that pictures are the same everywhere


def _big(point: Point) -> Point:
    return (SCALE * point[0], SCALE * point[1])


def _between(start: Point, end: Point, share: float) -> Point:
    return (start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1]))
