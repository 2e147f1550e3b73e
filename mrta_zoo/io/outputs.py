"""Writing results, so that none is lost when another cannot be written."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import TracebackType

from mrta_zoo.errors import ConfigError, MrtaError


class Outputs:
    """Writes one result after the other; failures are reported at the end, when all else is written and printed.

    A result that cannot be written to its place, because the disk is full or the folder has gone, is written to a new
    temporary folder.

    >>> with Outputs() as outputs:
    ...     outputs.write("plan", Path("plan.json"), lambda path: write_plan(plan, path))
    ...     print(*outputs.written)

    Attributes:
        written: one line per result that was written to its place, "plan written to plan.json".
    """

    def __init__(self) -> None:
        self.written: list[str] = []
        self._problems: list[Exception] = []

    def write(self, what: str, path: Path, write: Callable[[Path], object]) -> Path | None:
        """Write a result.

        Args:
            what: the name of the result.
            path: its place.
            write: writes it to the path given.

        Returns:
            Where it was written; None if nowhere.
        """
        try:
            write(path)
        except (MrtaError, OSError) as error:
            place = write_elsewhere(path, write)
            instead = f"; it is in {place} instead" if place else ""
            self._problems.append(ConfigError(f"{_complaint(error, path)}{instead}"))
            return place
        except Exception as error:  # a bug of ours, which must not cost later results
            self._problems.append(error)
            return None
        self.written.append(f"{what} written to {path}")
        return path

    def __enter__(self) -> Outputs:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        if not self._problems or not (error is None or isinstance(error, OSError)):
            return
        faults = [each for each in self._problems if not isinstance(each, ConfigError)]
        raise faults[0] if faults else ConfigError("; ".join(map(str, self._problems))) from None


def write_elsewhere(path: Path, write: Callable[[Path], object]) -> Path | None:
    """Write a result that could not be written to its place to a new temporary folder.

    Args:
        path: its place, whose name it keeps.
        write: writes it to the path given.

    Returns:
        Where it was written; None if it cannot be written there either.
    """
    with suppress(Exception):
        folder = Path(tempfile.mkdtemp(prefix="mrta_zoo."))
        try:
            write(folder / path.name)
        except Exception:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        return folder / path.name
    return None


def _complaint(error: MrtaError | OSError, path: Path) -> str:
    if isinstance(error, MrtaError):
        return str(error)
    return f"{path} cannot be written: {(error.strerror or str(error)).lower()}"
