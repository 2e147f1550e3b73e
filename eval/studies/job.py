"""One run of the study: trained, or trained on from its last checkpoint, then evaluated."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.rows_file import RowsFile
from mrta_zoo.eval.studies.held_out import Distribution, HeldOut
from mrta_zoo.eval.studies.rows import RunRow
from mrta_zoo.io.records import write_records
from mrta_zoo.policies.neural.policy import NeuralPolicy, load_policy
from mrta_zoo.train import checkpoint
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.reinforce import Reinforce, Validation
from mrta_zoo.verify import verify
from mrta_zoo.wording import counted

Tell = Callable[[float], None]
"""Is told the share of the run that is done, 0 to 1, after each update; stops the run by raising."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """A variant with a seed.

    Attributes:
        variant: its name.
        folder: of the run.
        config: with the seed.
        held_out: what it is evaluated on.
        distributions: of those scenarios.
    """

    variant: str
    folder: Path
    config: TrainConfig
    held_out: HeldOut
    distributions: tuple[Distribution, ...]

    @property
    def seed(self) -> int:
        """Of the run."""
        return self.config.seed

    @property
    def rows_file(self) -> Path:
        """There once the run is finished, and whole."""
        return self.folder / "rows.csv"


def perform(job: Job, tell: Tell) -> None:
    """Do what there is to do of a run, which leaves its rows in its folder.

    Raises:
        ConfigError: if the folder's files are damaged or of another run, or training diverges.
    """
    if job.rows_file.exists():
        return
    run, seconds = _begin(job)
    begun = time.perf_counter() - seconds
    total = job.config.total_updates
    tell(run.update / total)
    for event in run.run():
        if isinstance(event, Validation):
            checkpoint.save(job.folder, run, time.perf_counter() - begun)
        tell(run.update / total)
    write_records(evaluate(job), job.rows_file)


def evaluate(job: Job) -> list[RunRow]:
    """Greedy plans by the run's best policy (by validation), every one scored by the verifier."""
    policy = trained_policy(job.folder)
    rows = []
    for distribution in job.distributions:
        for robots in job.held_out.robots:
            scenarios = job.held_out.scenarios(distribution, robots)
            for index, (scenario, plan) in enumerate(zip(scenarios, policy.solve_batch(scenarios), strict=True)):
                completed = verify(scenario, plan).completed
                rows.append(RunRow(job.variant, job.seed, distribution, robots, index, completed, scenario.num_tasks))
    return rows


def trained_policy(folder: Path) -> NeuralPolicy:
    """What a finished run has learned.

    Raises:
        ConfigError: if its files are lost or damaged.
    """
    with mendable(folder):
        return load_policy(folder)


def seconds_of(folder: Path) -> float:
    """Wall-clock time that a run's training took.

    Raises:
        ConfigError: if its files are lost or damaged.
    """
    with mendable(folder):
        return checkpoint.seconds_spent(folder)


@contextmanager
def mendable(folder: Path) -> Iterator[None]:
    """Say what to do about a run whose files are lost or damaged."""
    try:
        yield
    except ConfigError as error:
        raise ConfigError(f"{error}; to have this run done again, delete {folder} and repeat the command") from None


def rows_of(job: Job) -> list[RunRow]:
    """The rows of a finished run.

    Raises:
        ConfigError: if they are not those that its job asks for.
    """
    rows = RowsFile(job.rows_file, RunRow).rows
    for row in rows:
        if row.tasks != job.held_out.tasks or not 0 <= row.completed <= row.tasks:
            raise ConfigError(
                f"{job.rows_file} has {row.completed} of {counted(row.tasks, 'task')} completed; expected 0 to "
                f"{job.held_out.tasks} of {job.held_out.tasks}; delete the file, and run the command again"
            )
    wanted = [
        (job.variant, job.seed, distribution, robots, index)
        for distribution in job.distributions
        for robots in job.held_out.robots
        for index in range(job.held_out.count)
    ]
    if [(row.variant, row.seed, row.distribution, row.robots, row.scenario) for row in rows] != wanted:
        raise ConfigError(f"{job.rows_file} holds other rows than its run has; delete it, and run the command again")
    return rows


def _begin(job: Job) -> tuple[Reinforce, float]:
    if not (job.folder / "config.json").exists():
        shutil.rmtree(job.folder, ignore_errors=True)  # killed before anything was decided
        return checkpoint.start(job.folder, job.config), 0.0
    if checkpoint.saved_config(job.folder) != job.config:
        raise ConfigError(f"{job.folder} holds a run of another configuration; expected a new folder for the study")
    with mendable(job.folder):
        return checkpoint.resume(job.folder)
