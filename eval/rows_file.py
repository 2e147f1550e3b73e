"""Rows in a CSV file that grows as they become known, so that an interruption loses at most the one in the making."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Sequence
from dataclasses import astuple, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import msgspec

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.records import write_records
from mrta_zoo.io.table import columns_in_use
from mrta_zoo.io.text_files import read_text, write_text
from mrta_zoo.wording import composed, counted

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

RowType = TypeVar("RowType", bound="DataclassInstance")


class RowsFile(Generic[RowType]):
    """A CSV file with a header and a line for each row; absent values are empty cells.

    Args:
        path: read if it exists, made with the first row if not. A last line without line end, which an interruption
            has left, is dropped; so are rows and columns with nothing in them, as spreadsheets leave them.
        of: the dataclass of the rows, of text, numbers, and numbers that may be None by default.

    Raises:
        ConfigError: if the file is malformed.
    """

    def __init__(self, path: Path, of: type[RowType]) -> None:
        self.path, self._of = path, of
        self._columns = [field.name for field in fields(of)]
        self._optional = {field.name for field in fields(of) if field.default is None}
        self.rows: list[RowType] = []
        self._whole_header = False
        if os.path.exists(path):
            self._read()

    def append(self, *rows: RowType) -> None:
        """Add rows, in memory and on disk.

        Raises:
            ConfigError: if the file cannot be written.
        """
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        if not self._whole_header:
            writer.writerow(self._columns)
        writer.writerows(map(astuple, rows))
        try:
            with self.path.open("a", encoding="utf-8", newline="") as file:
                file.write(stream.getvalue())
        except (OSError, ValueError) as error:  # ValueError: text that is not UTF-8
            reason = getattr(error, "strerror", None) or str(error)
            raise ConfigError(f"{self.path} cannot be written: {reason.lower()}") from None
        self._whole_header = True
        self.rows += rows

    def keep(self, rows: Sequence[RowType]) -> None:
        """Hold these rows alone, in this order; the file is written anew only if it does not hold just them.

        Raises:
            ConfigError: if the file cannot be written.
        """
        if list(rows) != self.rows:
            write_records(rows, self.path, self._of)
            self.rows, self._whole_header = list(rows), True

    def _read(self) -> None:
        text = composed(read_text(self.path, ConfigError)) if self.path.stat().st_size else ""
        whole = text[: text.rfind("\n") + 1]
        if whole != text:
            write_text(whole, self.path, ConfigError)
        if not whole:
            return
        try:
            given = list(csv.reader(io.StringIO(whole)))
        except csv.Error as error:
            raise ConfigError(f"{self.path}: {error}; expected rows of this command") from None
        header, *lines = rows = columns_in_use(given)
        if header != self._columns:
            raise ConfigError(f"{self.path}, line 1: the columns are {header}; expected {self._columns}")
        self._whole_header = True
        for number, cells in enumerate(lines, start=2):
            if not any(cells):  # as spreadsheets leave them
                continue
            self.rows.append(self._row(cells, f"{self.path}, line {number}"))
        if len(header) != len(given[0]):  # empty columns, under which what is appended would not stand aright
            stream = io.StringIO()
            csv.writer(stream, lineterminator="\n").writerows(filter(any, rows))
            write_text(stream.getvalue(), self.path, ConfigError)

    def _row(self, cells: list[str], where: str) -> RowType:
        if len(cells) != len(self._columns):
            raise ConfigError(f"{where}: {counted(len(cells), 'cell')}; expected {len(self._columns)}")
        given: dict[str, Any] = {
            name: cell
            for name, cell in zip(self._columns, cells, strict=True)
            if cell != "" or name not in self._optional
        }
        try:
            return msgspec.convert(given, self._of, strict=False)
        except msgspec.ValidationError as error:
            raise ConfigError(f"{where}: {error}") from None
