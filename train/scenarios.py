"""The scenarios of a run: for each update, perhaps drawn ahead by other processes, and for validation."""

from __future__ import annotations

from collections import deque
from collections.abc import Generator
from concurrent.futures import Future
from dataclasses import dataclass
from itertools import count

from mrta_zoo.generators import ScenarioGenerator, draw_scenario
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.child_process import pool_of
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.distribution import draw_size, team, training_generator
from mrta_zoo.train.random_streams import Stream, random_numbers

AHEAD = 4
"""Updates that each worker process draws ahead."""


@dataclass(frozen=True, slots=True)
class UpdateInput:
    """The input of one update: scenarios of one size, and the seed with which missions are sampled."""

    update: int
    scenarios: ScenarioBatch
    seed: int


def draw_input(config: TrainConfig, generator: ScenarioGenerator | None, update: int) -> UpdateInput:
    """The scenarios of an update of REINFORCE, on the CPU; they follow from the run's seed and the update's number."""
    rng = random_numbers(config.seed, Stream.UPDATES, update)
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
    return UpdateInput(update, scenarios, int(rng.integers(2**63)))


def draw_validation(config: TrainConfig, generator: ScenarioGenerator | None) -> ScenarioBatch:
    """The scenarios that a run is validated on, on the CPU; `generator` as for `draw_input`."""
    rng = random_numbers(config.seed, Stream.VALIDATION)
    drawn = [
        draw_scenario(generator or training_generator(config, draw_size(config, rng)), rng)
        for _ in range(config.validation_scenarios)
    ]
    return ScenarioBatch.of(drawn, mask_rule=config.mask_rule)


def draw_inputs(
    config: TrainConfig, generator: ScenarioGenerator | None, first: int, workers: int = 0
) -> Generator[UpdateInput, None, None]:
    """The input of each update from number `first` on, without end.

    Args:
        config: the run.
        generator: draws the scenarios; None for the configuration's.
        first: number of the first update.
        workers: processes that draw ahead; they end when this iterator is closed. 0 draws in this process.

    Raises:
        ConfigError: if one of the processes dies.
    """
    if not workers:
        yield from (draw_input(config, generator, update) for update in count(first))
    else:
        with pool_of(workers) as pool:
            ahead: deque[Future[UpdateInput]] = deque()
            for update in count(first):
                ahead.append(pool.submit(draw_input, config, generator, update))
                if len(ahead) > AHEAD * workers:
                    yield ahead.popleft().result()
