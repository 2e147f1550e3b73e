"""Dataclasses as the rows of a CSV file, one column a field: text, numbers and truth values."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import astuple, fields
from typing import TYPE_CHECKING, Any, TypeVar, get_type_hints

import msgspec

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.source import StrPath, shown, write_text
from mrta_zoo.io.table import read_table

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    Record = TypeVar("Record", bound=DataclassInstance)

_EXPECTED = {int: "a whole number", float: "a finite number", bool: "True or False"}


def write_records(rows: Sequence[DataclassInstance], path: StrPath) -> None:
    """Write rows of one class as CSV with a header, numbers in full precision; the whole file or nothing.

    Args:
        rows: at least one, as their class gives the header.
        path: the file.

    Raises:
        ConfigError: if there is no row or the file cannot be written.
    """
    if not rows:
        raise ConfigError(f"{path} cannot be written: there are no rows; expected at least one")
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(field.name for field in fields(rows[0]))
    writer.writerows(astuple(row) for row in rows)
    write_text(stream.getvalue(), path, ConfigError)


def read_records(path: StrPath, of: type[Record]) -> list[Record]:
    """The rows that `write_records` wrote.

    Args:
        path: the file.
        of: the class of the rows.

    Raises:
        ConfigError: if the file is missing, is no CSV table, has other columns than the class has fields, or a value
            that its field cannot have; the message names the line.
    """
    (where, header), *rows = read_table(path, ConfigError, strip=False)
    names = [field.name for field in fields(of)]
    if header != names:
        raise ConfigError(f"{where}: header is {shown(','.join(header), 200)}; expected {','.join(names)}")
    hints = get_type_hints(of)
    return [
        of(*(_value(text, hints[name], f"{where}: {name}") for name, text in zip(names, cells, strict=True)))
        for where, cells in rows
    ]


def _value(text: str, of: type, what: str) -> Any:
    try:
        value: Any = msgspec.convert(text, of, strict=False)
    except msgspec.ValidationError:
        value = math.nan
    if isinstance(value, float) and not math.isfinite(value):
        raise ConfigError(f"{what} is {shown(text)}; expected {_EXPECTED.get(of, of)}")
    return value
