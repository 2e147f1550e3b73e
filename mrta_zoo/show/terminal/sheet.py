"""Sheets: tables for a terminal of any width, in which no cell is cut or broken within a word."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from rich import box
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.measure import Measurement
from rich.table import Table
from rich.text import Text

from mrta_zoo.show.terminal.fold import fold, spelt_out

JOINED = "\N{NO-BREAK SPACE}"
"""Between a heading and what is under it, so that they stay on one line, where there is room."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """Rows under headings: a table or, where there is no room, a narrower one or else each row as a sentence.

    Attributes:
        title: above it, if any.
        headings: of the columns.
        rows: their cells.
        left: the headings of the columns whose text begins at the left.
        ends: the numbers of the rows below which a line is drawn.
        prose: the heading of the column whose text may be folded between words, if there is one.
    """

    title: str
    headings: Sequence[str]
    rows: Sequence[Sequence[str]]
    left: Collection[str] = ()
    ends: Collection[int] = ()
    prose: str = ""

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        if self.title:
            title = "\n".join(fold(spelt_out(self.title), options.max_width))
            yield Text(title, style="bold", no_wrap=True, overflow="ignore")
        if not self.rows:
            return
        for tight in (False, True):
            table = self._table(tight)
            if Measurement.get(console, options.update(max_width=10**6), table).minimum <= options.max_width:
                yield table
                return
        for number, row in enumerate(self.rows):
            for line in self._sentence(row, options.max_width):
                yield Text(spelt_out(line), no_wrap=True, overflow="ignore")
            if number in self.ends or number == len(self.rows) - 1:
                yield Text()

    def _table(self, tight: bool) -> Table:
        if tight:
            table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, padding=0)
        else:
            table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
        for heading, *cells in zip(self.headings, *self.rows, strict=True):
            folds = heading == self.prose != ""
            table.add_column(
                Text(spelt_out(heading)),
                justify="left" if heading in self.left else "right",
                no_wrap=not folds,
                min_width=None if folds else max(map(cell_len, (heading, *cells))),
            )
        for number, row in enumerate(self.rows):
            table.add_row(*(Text(spelt_out(cell)) for cell in row), end_section=number in self.ends)
        return table

    def _sentence(self, row: Sequence[str], width: int) -> list[str]:
        """Headings with their cells, in lines, without empty cells."""
        parts = [
            cell if cell.startswith(heading) else f"{heading} {cell}"
            for heading, cell in zip(self.headings, row, strict=True)
            if cell
        ]
        parts = [part.replace(" ", JOINED) if len(part) < width - 2 else part for part in parts]
        return [line.replace(JOINED, " ") for line in fold(", ".join(parts), width, "  ")]
