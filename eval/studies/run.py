"""One run of a study: trained, or trained on from its last checkpoint, then evaluated."""

from __future__ import annotations

import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.cells import Cell, Tell
from mrta_zoo.eval.studies.held_out import Distribution, HeldOut
from mrta_zoo.eval.studies.rows import RunRow
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.neural.policy import NeuralPolicy, load_policy
from mrta_zoo.train import checkpoint
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.reinforce import Reinforce, Validation
from mrta_zoo.verify import verify


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """An arm with a seed.

    Attributes:
        variant: name of the arm.
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
    def key(self) -> tuple[str, int]:
        """Arm and seed."""
        return self.variant, self.config.seed

    @property
    def cell(self) -> Cell[RunRow]:
        """The run as the engine knows it."""
        label = f"{self.variant}, seed {self.config.seed}"
        return Cell(
            label=label,
            keys=tuple(
                (*self.key, distribution, robots, index, self.held_out.tasks)
                for distribution in self.distributions
                for robots in self.held_out.robots
                for index in range(self.held_out.count)
            ),
            perform=self.perform,
            kept=self._begun,
            announcement=f"{label}: trained and compared",
        )

    def perform(self, tell: Tell) -> list[RunRow]:
        """Train what is left to train, with one CPU thread, and evaluate.

        Raises:
            ConfigError: if the folder's files are damaged or of another run, or training diverges.
        """
        with cpu_threads(1):
            run, seconds = self._begin()
            begun = time.perf_counter() - seconds
            for event in run.run():
                if isinstance(event, Validation):
                    checkpoint.save(self.folder, run, time.perf_counter() - begun)
                tell(run.update / self.config.total_updates)
            return self._evaluate()

    def _begun(self) -> bool:
        return (self.folder / "config.json").exists()

    def _begin(self) -> tuple[Reinforce, float]:
        if not self._begun():
            shutil.rmtree(self.folder, ignore_errors=True)  # killed before anything was decided
            return checkpoint.start(self.folder, self.config), 0.0
        if checkpoint.saved_config(self.folder) != self.config:
            raise ConfigError(
                f"{self.folder} holds a run of another configuration; expected a new folder for the study"
            )
        with mendable(self.folder):
            return checkpoint.resume(self.folder)

    def _evaluate(self) -> list[RunRow]:
        """Greedy plans by the run's best policy (by validation), every one scored by the verifier."""
        policy = trained_policy(self.folder)
        rows = []
        for distribution in self.distributions:
            for robots in self.held_out.robots:
                scenarios = self.held_out.scenarios(distribution, robots)
                for index, (scenario, plan) in enumerate(zip(scenarios, policy.solve_batch(scenarios), strict=True)):
                    completed = verify(scenario, plan).completed
                    rows.append(RunRow(*self.key, distribution, robots, index, completed, scenario.num_tasks))
        return rows


def trained_policy(folder: Path) -> NeuralPolicy:
    """What a finished run has learned.

    Raises:
        ConfigError: if its files are lost or damaged.
    """
    with mendable(folder):
        return load_policy(folder)


@contextmanager
def mendable(folder: Path) -> Iterator[None]:
    """Say what to do about a run whose files are lost or damaged."""
    try:
        yield
    except ConfigError as error:
        raise ConfigError(f"{error}; to have this run done again, delete {folder} and repeat the command") from None
