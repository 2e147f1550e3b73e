"""CSV tables as rows of text, each with its place in the file."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

from mrta_zoo.errors import MrtaError
from mrta_zoo.io.text_files import StrPath, read_text, shown
from mrta_zoo.wording import counted


def read_table(path: StrPath, error: type[MrtaError]) -> list[tuple[str, list[str]]]:
    """The place and the cells of each row of a CSV file; at least the header.

    Empty rows and columns, as spreadsheets leave them, are skipped; every row has as many cells as
    the header, or fewer if those at its end are empty.

    Args:
        path: the file.
        error: what to raise.

    Raises:
        error: if the file is missing or is not such a table.
    """
    reader = csv.reader(io.StringIO(read_text(path, error), newline=""), strict=True)
    places: list[str] = []
    rows: list[list[str]] = []
    try:
        for cells in reader:
            if any(cell.strip() for cell in cells):
                places.append(f"{path}, line {reader.line_num}")
                rows.append(cells)
    except csv.Error as problem:
        raise error(f"{path}, line {reader.line_num}: {problem}; expected cells separated by commas") from None
    if not rows:
        raise error(f"{path} has no rows; expected a header row")
    used = [[cell.strip() for cell in row] for row in columns_in_use(rows)]
    _check_separator(places[0], used[0], error)
    for where, row, cells in zip(places, rows, used, strict=True):
        if len(cells) != len(used[0]):
            raise error(
                f"{where}: {shown(','.join(row))} has {counted(len(row), 'cell')}; "
                f"expected {len(rows[0])} as in the header"
            )
    return list(zip(places, used, strict=True))


def columns_in_use(rows: Sequence[Sequence[str]]) -> list[list[str]]:
    """The rows without blank columns; rows that were too short still are."""
    used = sorted({index for row in rows for index, cell in enumerate(row) if cell.strip()})
    return [[row[index] for index in used if index < len(row)] for row in rows]


def _check_separator(where: str, header: list[str], error: type[MrtaError]) -> None:
    for separator, name in ((";", "semicolons"), ("\t", "tabs")):
        if len(header) == 1 and separator in header[0]:
            raise error(
                f"{where}: cells are separated by {name}; expected commas, and points in numbers (1.5), "
                "as spreadsheets export them in English"
            )
