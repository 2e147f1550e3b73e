"""CSV files as tables of text that know where each row stands."""

from __future__ import annotations

import csv
import io

from mrta_zoo.errors import MrtaError
from mrta_zoo.io.source import StrPath, read_text, shown


def read_table(path: StrPath, error: type[MrtaError]) -> list[tuple[str, list[str]]]:
    """Where each row of a CSV file stands, and its cells; at least the header.

    Blank lines are skipped; every other row has as many cells as the header.

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
            if not any(cell.strip() for cell in cells) and len(cells) <= 1:
                continue
            where = f"{path}, line {reader.line_num}"
            if table and len(cells) != len(table[0][1]):
                raise error(
                    f"{where}: {shown(','.join(cells))} has {len(cells)} cells; "
                    f"expected {len(table[0][1])} as in the header"
                )
            table.append((where, [cell.strip() for cell in cells]))
    except csv.Error as problem:
        raise error(f"{path}, line {reader.line_num}: {problem}; expected cells separated by commas") from None
    if not table:
        raise error(f"{path} has no rows; expected a header row")
    return table
