"""What a report consists of."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from mrta_zoo.extras import importing

with importing("report", "a figure"):
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Numbers for people, and the same numbers for machines.

    Attributes:
        name: of the CSV file behind it.
        caption: what it shows: unit, number of cases, what an interval is.
        shown: cells as text, the first column naming the row.
        data: what the CSV file holds, in full precision.
        bold: cells that stand out, (row, column) counted from 0.
    """

    name: str
    caption: str
    shown: pd.DataFrame
    data: pd.DataFrame
    bold: frozenset[tuple[int, int]] = frozenset()


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """A figure with what it shows.

    Attributes:
        name: of the files: PNG, SVG, and the CSV behind it.
        caption: what it shows: unit, number of cases, what marks and intervals are.
        figure: to be written.
        data: what the CSV file holds; None if a table of the same name has the same numbers.
    """

    name: str
    caption: str
    figure: Figure
    data: pd.DataFrame | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A part of the report, in the order text, pictures, tables.

    Attributes:
        title: its heading.
        text: paragraphs.
        pictures: with captions.
        tables: with captions.
    """

    title: str
    text: tuple[str, ...] = ()
    pictures: tuple[Picture, ...] = ()
    tables: tuple[Table, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Report:
    """All of it.

    Attributes:
        title: on top.
        summary: what it comes to, one point each.
        sections: in order.
        made: how it was made: what, and which.
    """

    title: str
    summary: tuple[str, ...]
    sections: tuple[Section, ...]
    made: tuple[tuple[str, str], ...]
