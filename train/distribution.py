"""The distribution of training scenarios that a configuration names."""

from __future__ import annotations

import numpy as np

from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import MixtureGenerator, ScenarioGenerator, TaptcGenerator, UniformGenerator
from mrta_zoo.train.config import TrainConfig


def draw_size(config: TrainConfig, rng: np.random.Generator) -> int:
    """A number of tasks, drawn from `config.tasks`; nothing is drawn if there is no choice."""
    if len(config.tasks) == 1:
        return config.tasks[0]
    bounds = np.cumsum(config.task_weights or [1.0] * len(config.tasks))
    return config.tasks[int(np.searchsorted(bounds, rng.random() * bounds[-1]))]


def team(config: TrainConfig, tasks: int) -> tuple[int, int]:
    """Fewest and most robots for this many tasks, in proportion to those for the configuration's reference size."""
    scale = tasks / config.reference_tasks
    return max(1, round(config.min_robots * scale)), max(1, round(config.max_robots * scale))


def most_robots(config: TrainConfig) -> int:
    """The most robots of any scenario of the run, and at least `config.max_robots`, for generators of your own."""
    return max(config.max_robots, *(team(config, tasks)[1] for tasks in config.tasks))


def training_generator(config: TrainConfig, tasks: int) -> ScenarioGenerator:
    """The generator of training and validation scenarios with this many tasks.

    "taptc" is fitted to the benchmark, "uniform" is the paper's §IV-A, "mixture" is 2/5 each of these two, and 1/5
    TAPTC-like with robots of capacity 1 or 2 at random and deadlines from a wider range.
    """
    size, robots = (tasks, tasks), team(config, tasks)
    taptc = TaptcGenerator(tasks=size, robots=robots)
    uniform = UniformGenerator(tasks=size, robots=robots)
    if config.generator == "taptc":
        return taptc
    if config.generator == "uniform":
        return uniform
    wide = TaptcGenerator(tasks=size, robots=robots, capacity="random", latest=(210.0, 320.0), min_deadline=20.0)
    return MixtureGenerator((taptc, wide, uniform), (0.4, 0.2, 0.4))


def check_distribution(config: TrainConfig) -> None:
    """Check that scenarios of every size can be drawn, and that all their robots have a network.

    Raises:
        ConfigError: if a size is out of range, or sharing is by capacity and the generator draws any capacity.
    """
    for tasks in config.tasks:
        training_generator(config, tasks)
    if config.sharing == "by-capacity" and config.generator != "taptc":
        raise ConfigError(
            f"sharing is 'by-capacity', a network for each of a few kinds of robots, and generator "
            f"{config.generator!r} draws any capacity; expected generator taptc, or one of your own"
        )
