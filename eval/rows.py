"""One line for each method and case: the data behind every table and figure."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from dataclasses import astuple, dataclass, fields
from pathlib import Path

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.source import write_text


@dataclass(frozen=True, slots=True)
class Row:
    """What a method reached on a case. All scores are the verifier's, see `verify.Score`.

    Attributes:
        case: name of the case.
        method: the method, as it was asked for.
        tasks: number of tasks.
        robots: number of robots.
        completed: tasks finished by their deadline.
        completion: completed / tasks, 0 to 1.
        cost: the objective, Eq. 1 of the paper.
        distance: travelled by all robots together, in distance units.
        makespan: the latest finish, in time units.
        seconds: wall-clock time it took to plan.
    """

    case: str
    method: str
    tasks: int
    robots: int
    completed: int
    completion: float
    cost: float
    distance: float
    makespan: float
    seconds: float


COLUMNS = tuple(field.name for field in fields(Row))


def write_rows(rows: Iterable[Row], path: Path) -> None:
    """Write rows as CSV with a header, numbers in full precision; the whole file or nothing.

    Raises:
        ConfigError: if the file cannot be written.
    """
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows(astuple(row) for row in rows)
    write_text(stream.getvalue(), path, ConfigError)
