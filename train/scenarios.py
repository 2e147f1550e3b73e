"""The scenarios of each update, drawn ahead of time by other processes if there are any to spare."""

from __future__ import annotations

import multiprocessing
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass

import numpy as np

from mrta_zoo.batch import ScenarioBatch
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import ScenarioGenerator, draw_scenario
from mrta_zoo.train.child_process import DIED, obey_parent
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.distribution import draw_size, team, training_generator

AHEAD = 4
"""Updates that each worker process draws ahead."""


@dataclass(frozen=True, slots=True)
class Drawn:
    """What one update is made of: scenarios of one size, and the seed of what is sampled on them."""

    scenarios: ScenarioBatch
    seed: int


def draw(config: TrainConfig, generator: ScenarioGenerator | None, update: int) -> Drawn:
    """The scenarios of an update of REINFORCE, on the CPU; they follow from the run's seed and the update's number."""
    rng = np.random.default_rng((config.seed, 0, update))
    if generator is None:
        tasks = draw_size(config, rng)
        generator, most_robots = training_generator(config, tasks), team(config, tasks)[1]
    else:
        most_robots = None
    scenarios = ScenarioBatch.of(
        [draw_scenario(generator, rng) for _ in range(config.scenarios)],
        max_robots=most_robots,
        mask_rule=config.mask_rule,
    )
    return Drawn(scenarios, int(rng.integers(2**63)))


class Feed:
    """Draws for one update after another.

    Args:
        config: the run.
        generator: draws the scenarios; None for the configuration's.
        workers: processes that draw ahead; 0 to draw when asked.
    """

    def __init__(self, config: TrainConfig, generator: ScenarioGenerator | None, workers: int = 0) -> None:
        self._config, self._generator, self._workers = config, generator, workers
        self._pool: ProcessPoolExecutor | None = None
        self._ahead: dict[int, Future[Drawn]] = {}

    def take(self, update: int) -> Drawn:
        """What belongs to an update.

        Raises:
            ConfigError: if one of the processes dies.
        """
        if not self._workers:
            return draw(self._config, self._generator, update)
        if self._pool is None:
            self._pool = ProcessPoolExecutor(self._workers, multiprocessing.get_context("spawn"), obey_parent)
        last = min(update + AHEAD * self._workers, self._config.total_updates)
        for number in range(update, max(last, update + 1)):  # the run may have been made longer since
            if number not in self._ahead:
                self._ahead[number] = self._pool.submit(draw, self._config, self._generator, number)
        try:
            return self._ahead.pop(update).result()
        except BrokenProcessPool:
            raise ConfigError(DIED) from None

    def close(self) -> None:
        """End the processes."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
            self._pool = None
            self._ahead.clear()
