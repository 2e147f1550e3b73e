"""A study: a folder with a run for each way to train and each seed, and what its report says of how it was made."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol, TypeVar

from mrta_zoo import __version__
from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.experiment import Manifest, open_experiment
from mrta_zoo.eval.machine import Session, this_session
from mrta_zoo.eval.plot_history import LearningCurve, read_history
from mrta_zoo.eval.rows_file import RowsFile
from mrta_zoo.eval.studies.job import Job, mendable, rows_of
from mrta_zoo.eval.studies.pool import train_all
from mrta_zoo.eval.studies.rows import RunRow
from mrta_zoo.io.records import write_records
from mrta_zoo.policies.cpu_threads import cpu_threads

MAX_SEEDS, MAX_WORKERS = 1000, 1024


def check_counts(seeds: int, workers: int) -> None:
    """Make sure that there can be so many runs of each kind, and so many at a time.

    Raises:
        ConfigError: if not.
    """
    if not 1 <= seeds <= MAX_SEEDS:
        raise ConfigError(f"seeds is {seeds}; expected a whole number from 1 to {MAX_SEEDS}")
    if not 1 <= workers <= MAX_WORKERS:
        raise ConfigError(f"workers is {workers}; expected a whole number from 1 to {MAX_WORKERS}")


class Named(Protocol):
    """What has a name."""

    @property
    def name(self) -> str:
        """Its name."""


Question = TypeVar("Question", bound=Named)


def choose(names: Sequence[str], questions: Mapping[str, Question]) -> list[Question]:
    """Those of a study's questions that are named, in the study's order.

    Raises:
        ConfigError: if there is none of some name.
    """
    for name in names:
        if name not in questions:
            raise ConfigError(f"there is no question {name!r}; expected some of {', '.join(questions)}")
    return [question for question in questions.values() if question.name in names]


def perform_study(
    out: Path, manifest: Manifest, jobs: Sequence[Job], workers: int
) -> tuple[list[RunRow], list[Session]]:
    """Do the runs that are missing, and write ``rows.csv``; the rows of all runs, and the sessions they took.

    Args:
        out: folder of the study, new, empty, or of the same one.
        manifest: of the study.
        jobs: all its runs.
        workers: runs at a time.

    Raises:
        MrtaError: if the folder holds anything else, a file cannot be read or written, or training diverges.
    """
    with cpu_threads(1):
        open_experiment(out, manifest)
        sessions = RowsFile(out / "sessions.csv", Session)
        missing = [job for job in jobs if not job.rows_file.exists()]
        if missing:
            sessions.append(this_session(1))
        train_all(jobs, missing, workers)
    rows = [row for job in jobs for row in rows_of(job)]
    write_records(rows, out / "rows.csv")
    return rows, sessions.rows


def read_curves(jobs: Iterable[Job]) -> dict[tuple[str, int], LearningCurve]:
    """The learning curve of each (variant, seed)."""
    curves = {}
    for job in jobs:
        with mendable(job.folder):
            curves[job.variant, job.seed] = read_history(job.folder)
    return curves


def command_line(manifest: Manifest, *names: str) -> tuple[tuple[str, str], ...]:
    """What makes the study again: the command with these settings as flags, and the version.

    Args:
        manifest: of the study.
        names: of settings, those with a list of names given separated by commas.
    """

    def shown(value: Any) -> str:
        return ",".join(value) if isinstance(value, list) else str(value)

    flags = " ".join(f"--{name.replace('_', '-')} {shown(manifest.settings[name])}" for name in names)
    return (("Command", f"mrta-zoo {manifest.command} --out DIR {flags}"), ("Version", f"mrta_zoo {__version__}"))


def trained_on(sessions: Sequence[Session]) -> tuple[tuple[str, str], ...]:
    """The machine of each session in which runs were trained, and how busy it was."""
    return tuple(
        (
            f"Trained from {session.started}",
            f"{session.processor}, {session.cores} cores usable, load "
            f"{'unknown' if session.load is None else f'{session.load:g}'} at the beginning, one torch thread a "
            f"process, {session.system}; {session.libraries}",
        )
        for session in sessions
    )
