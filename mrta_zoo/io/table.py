"""CSV files as tables of text that know where each row stands."""

from __future__ import annotations

import csv
import io

from mrta_zoo.counted import counted
from mrta_zoo.errors import MrtaError
from mrta_zoo.io.source import StrPath, read_text, shown


def read_table(path: StrPath, error: type[MrtaError]) -> list[tuple[str, list[str]]]:
    """Where each row of a CSV file stands, and its cells; at least the header.

    Rows and last columns with nothing in them, as spreadsheets leave them, are passed over; every row has as many
    cells as the header.

    Args:
        path: the file.
        error: what to raise.

    Raises:
        error: if the file is missing or is not such a table.
    """
    reader = csv.reader(io.StringIO(read_text(path, error), newline=""), strict=True)
    table: list[tuple[str, list[str]]] = []
    try:
        for cells in reader:
            stripped = [cell.strip() for cell in cells]
            if not any(stripped):
                continue
            where = f"{path}, line {reader.line_num}"
            if not table:
                _check_separator(where, stripped, error)
            if table and len(cells) != len(table[0][1]):
                raise error(
                    f"{where}: {shown(','.join(cells))} has {counted(len(cells), 'cell')}; "
                    f"expected {len(table[0][1])} as in the header"
                )
            table.append((where, stripped))
    except csv.Error as problem:
        raise error(f"{path}, line {reader.line_num}: {problem}; expected cells separated by commas") from None
    if not table:
        raise error(f"{path} has no rows; expected a header row")
    width = max(index for _, cells in table for index, cell in enumerate(cells, start=1) if cell)
    return [(where, cells[:width]) for where, cells in table]


def _check_separator(where: str, header: list[str], error: type[MrtaError]) -> None:
    for separator, name in ((";", "semicolons"), ("\t", "tabs")):
        if len(header) == 1 and separator in header[0]:
            raise error(
                f"{where}: cells are separated by {name}; expected commas, and points in numbers (1.5), "
                "as spreadsheets export them in English"
            )
