"""The distribution of training scenarios that a configuration names."""

from __future__ import annotations

from mrta_zoo.generators import Mixture, ScenarioGenerator, TaptcGenerator, UniformGenerator
from mrta_zoo.train.config import TrainConfig


def training_generator(config: TrainConfig) -> ScenarioGenerator:
    """The generator of a run's training and validation scenarios."""
    tasks = (config.tasks, config.tasks)
    robots = (config.min_robots, config.max_robots)
    taptc = TaptcGenerator(tasks=tasks, robots=robots)
    uniform = UniformGenerator(tasks=tasks, robots=robots)
    if config.generator == "taptc":
        return taptc
    if config.generator == "uniform":
        return uniform
    return Mixture((taptc, uniform))
