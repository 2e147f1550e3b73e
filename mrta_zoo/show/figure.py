"""Figures that show text literally, and the file formats in which they can be saved.

Needs matplotlib (``mrta_zoo[plot]``), which it uses without its global state.
"""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Any

from mrta_zoo.errors import ConfigError
from mrta_zoo.extras import importing
from mrta_zoo.io.atomic import replacing
from mrta_zoo.io.paths import check_no_url, suffix_of
from mrta_zoo.show.lettering import any_letters

with importing("plot", "a picture"):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.text import Text

NOT_OFFERED = ("pgf", "raw", "rgba")
"""Formats of matplotlib that are not offered: ``pgf`` reads all text as TeX, and nothing opens the others."""


class LiteralFigure(Figure):
    """A figure in which no text is markup: matplotlib reads dollar signs, which names may hold, as mathematics."""

    def draw(self, renderer: Any) -> None:
        """Draw all of it; letters that the font lacks become boxes."""
        for text in self.findobj(Text):
            text.set(parse_math=False, usetex=False)
        with any_letters():
            super().draw(renderer)


def check_format(path: Path) -> None:
    """Make sure that pictures can be written in the format of the suffix.

    Raises:
        ConfigError: if there is no such format, or the library that writes it is not installed.
    """
    problem = _problem(_format_of(path))
    if problem is not None:
        expected = ", ".join(f".{name}" for name in sorted(_known()) if _problem(name) is None)
        raise ConfigError(f"{path} has the suffix {path.suffix!r}{problem}; expected one of {expected}")


def save_picture(figure: Figure, path: Path, **options: Any) -> None:
    """Write a figure, whole or not at all, in the format of the suffix: ``.png``, ``.svg``, ``.pdf``…

    Args:
        figure: the figure.
        path: the file.
        options: of matplotlib's `savefig`.

    Raises:
        ConfigError: if there is no such format here, or the file cannot be written.
    """
    check_no_url(path, ConfigError)
    check_format(path)
    try:
        with replacing(path) as partial:
            figure.savefig(partial, format=_format_of(path), **options)
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        reason = getattr(error, "strerror", None) or str(error)
        raise ConfigError(f"{path} cannot be written: {reason.lower()}") from None


def _format_of(path: Path) -> str:
    return suffix_of(path)[1:]


def _known() -> set[str]:
    return set(FigureCanvasAgg.get_supported_filetypes()) - set(NOT_OFFERED)


def _problem(format_: str) -> str | None:
    """Why a format cannot be written, found by trying it on a small figure; None if it can."""
    if format_ not in _known():
        return ""
    figure = LiteralFigure(figsize=(0.5, 0.5))
    figure.text(0.5, 0.5, "a")
    try:
        figure.savefig(BytesIO(), format=format_)
    except Exception as error:  # whatever the library that a format needs raises
        return f", which cannot be written here ({' '.join(str(error).split())})"
    return None
