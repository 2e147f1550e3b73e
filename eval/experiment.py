"""The engine of all experiments: a folder in which cells leave their rows, and which can be resumed."""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from operator import attrgetter
from pathlib import Path

import msgspec
from filelock import FileLock

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.cells import Cell, Key, perform_all
from mrta_zoo.eval.machine import Machine, this_machine
from mrta_zoo.eval.manifest import Manifest
from mrta_zoo.eval.rows_file import RowsFile, RowType
from mrta_zoo.io.lock import lock_folder
from mrta_zoo.io.paths import make_folder
from mrta_zoo.io.text_files import read_text, write_text
from mrta_zoo.show.terminal.console import progress_bar, say
from mrta_zoo.wording import composed

MANIFEST = "manifest.json"
_LOCKS: list[FileLock] = []  # held until the process ends


class Experiment:
    """A folder for one command: new, empty, or left by the same command, which then goes on where it stopped.

    One process at a time may use it.

    Args:
        folder: made if it does not exist.
        manifest: what is measured.
        threads: CPU threads of trained networks, for the record.

    Raises:
        ConfigError: if the folder holds anything else, is in use, or cannot be made.
    """

    def __init__(self, folder: Path, manifest: Manifest, threads: int = 1) -> None:
        open_folder(folder, manifest)
        self.folder, self.manifest = folder, manifest
        self._threads, self._noted = threads, False
        self._machines = RowsFile(folder / "sessions.csv", Machine)

    @property
    def machines(self) -> list[Machine]:
        """What it was measured on, one entry per uninterrupted stretch."""
        return self._machines.rows

    def measure(
        self, name: str, of: type[RowType], key: Sequence[str], cells: Sequence[Cell[RowType]], workers: int = 1
    ) -> list[RowType]:
        """The rows of all cells, in their order: those that the folder holds, and those of the cells it lacks.

        The rows of a cell are written as soon as it is done, so an interruption loses at most the cells in the making.

        Args:
            name: of the file.
            of: the class of the rows.
            key: the columns that tell rows apart.
            cells: what to measure.
            workers: cells at a time, each in a process of its own; one is done in this process.

        Raises:
            MrtaError: if a cell fails, the file has a row twice or a row that no cell makes, or cannot be written.
        """
        file = RowsFile(self.folder / name, of)
        key_of = attrgetter(*key)
        found = {_composed(key_of(row)): row for row in file.rows}
        _check_rows(file, key, [_composed(key_of(row)) for row in file.rows], cells)
        kept = {cell.keys for cell in cells if found.keys() >= set(cell.keys) and cell.kept()}
        missing = [cell for cell in cells if cell.keys not in kept]
        whole = {key for keys in kept for key in keys}
        file.keep([row for key, row in found.items() if key in whole])
        if missing and not self._noted:
            self._machines.append(this_machine(self._threads))
            self._noted = True
        _perform(cells, missing, file, workers)
        found = {_composed(key_of(row)): row for row in file.rows}
        rows = [found[key] for cell in cells for key in cell.keys]
        if missing:
            file.keep(rows)  # in order, whatever the order in which workers were done
        return rows


def _perform(
    cells: Sequence[Cell[RowType]], missing: Sequence[Cell[RowType]], file: RowsFile[RowType], workers: int
) -> None:
    """Do what is missing, with a progress bar if there is a terminal, and a line for each cell that wants one."""
    shares: dict[int, float] = {}
    done = len(cells) - len(missing)
    with progress_bar() as progress:
        bar = progress.add_task("", total=len(cells), completed=done)

        def tell(cell: Cell[RowType], share: float) -> None:
            progress.update(bar, advance=share - shares.get(id(cell), 0.0), description=cell.label)
            shares[id(cell)] = share

        with closing(perform_all(missing, workers, tell)) as performed:  # ends worker processes whatever happens here
            for cell, rows in performed:
                file.append(*rows)
                tell(cell, 1.0)
                done += 1
                if cell.announcement:
                    say(progress.console, f"{cell.announcement} ({done} of {len(cells)})")


def _check_rows(
    file: RowsFile[RowType], columns: Sequence[str], keys: Sequence[Key], cells: Sequence[Cell[RowType]]
) -> None:
    def shown(key: Key) -> str:
        return ", ".join(f"{column} {value}" for column, value in zip(columns, key, strict=True) if value is not None)

    twice = [key for key, count in Counter(keys).items() if count > 1]
    if twice:
        raise ConfigError(f"{file.path} has two rows for {shown(twice[0])}; expected one")
    asked = {key for cell in cells for key in cell.keys}
    strange = [key for key in keys if key not in asked]
    if strange:
        raise ConfigError(
            f"{file.path} has a row for {shown(strange[0])}, which this command does not ask for; expected its own "
            "rows alone"
        )


def _composed(key: Key) -> Key:
    return tuple(composed(value) if isinstance(value, str) else value for value in key)


def open_folder(folder: Path, manifest: Manifest) -> None:
    """Make the folder, or make sure that what it holds was measured by the same command. See `Experiment`."""
    path = folder / MANIFEST
    try:
        _check_ours(folder)
        make_folder(folder)
        _LOCKS.append(lock_folder(folder))
        if not os.path.lexists(path):
            _check_ours(folder)
            write_text(manifest.text, path, ConfigError)
            return
        text = composed(read_text(path, ConfigError, "what this command has written"))
        earlier = msgspec.json.decode(text, type=Manifest)
    except OSError as error:
        raise ConfigError(f"{folder} cannot be used: {(error.strerror or str(error)).lower()}") from None
    except msgspec.MsgspecError as error:
        raise ConfigError(f"{path}: {error}; expected what this command has written there") from None
    if difference := msgspec.json.decode(manifest.text, type=Manifest).difference_from(earlier):
        raise ConfigError(
            f"{folder} holds results of another run: {difference}; expected the same command on the same cases, or a "
            "new folder"
        )


def _check_ours(folder: Path) -> None:
    if os.path.exists(folder) and not os.path.isdir(folder):
        raise ConfigError(f"{folder} is a file; expected a folder, new, empty, or of this command")
    if os.path.lexists(folder / MANIFEST) or not os.path.isdir(folder):
        return
    if any(not name.startswith(".") for name in os.listdir(folder)):
        raise ConfigError(
            f"{folder} is not empty and holds no {MANIFEST}; expected a folder that is new, empty, or of this command"
        )


@contextmanager
def resumable() -> Iterator[None]:
    """For a command that keeps what it has measured: after Ctrl-C, say how to go on."""
    try:
        yield
    except KeyboardInterrupt:
        print("the same command goes on where it stopped", file=sys.stderr)
        raise
