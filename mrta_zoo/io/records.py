"""Dataclasses as the rows of a CSV file, one column per field: text, numbers and booleans."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import astuple, fields
from typing import TYPE_CHECKING

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.text_files import StrPath, write_text

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def write_records(rows: Sequence[DataclassInstance], path: StrPath, of: type[DataclassInstance] | None = None) -> None:
    """Write rows of one class as CSV with a header, numbers in full precision; the whole file or nothing.

    Args:
        rows: at least one, unless their class is given.
        path: the file.
        of: their class, which gives the header; by default the class of the first row.

    Raises:
        ConfigError: if there is no row or the file cannot be written.
    """
    if not rows and of is None:
        raise ConfigError(f"{path} cannot be written: there are no rows; expected at least one")
    write_text(records_text(rows, of), path, ConfigError)


def records_text(rows: Sequence[DataclassInstance], of: type[DataclassInstance] | None = None) -> str:
    """What `write_records` writes."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(field.name for field in fields(of or rows[0]))
    writer.writerows(astuple(row) for row in rows)
    return stream.getvalue()
