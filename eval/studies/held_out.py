"""The scenarios that trained networks are compared on: none of them is drawn in training."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import ScenarioGenerator, TaptcGenerator, UniformGenerator
from mrta_zoo.scenario import Scenario

Distribution = Literal["taptc", "uniform"]

HELD_OUT_SEED = 20220526
"""Of a stream of random numbers that training, whose seeds are small, has nothing to do with."""
MOST = 10_000
"""More would take much memory, and tell nothing."""


@dataclass(frozen=True, slots=True)
class HeldOut:
    """Which scenarios.

    Attributes:
        tasks: of each scenario.
        count: scenarios of each distribution and number of robots.
        robots: the numbers of robots.
    """

    tasks: int
    count: int
    robots: tuple[int, ...]

    def __post_init__(self) -> None:
        if not 2 <= self.count <= MOST:
            raise ConfigError(f"held_out is {self.count}; expected 2 to {MOST:,} scenarios for each number of robots")

    def scenarios(self, distribution: Distribution, robots: int) -> list[Scenario]:
        """Those of a distribution with so many robots, the first ones the same whatever the count."""
        size, team = (self.tasks, self.tasks), (robots, robots)
        generator: ScenarioGenerator = (
            TaptcGenerator(tasks=size, robots=team)
            if distribution == "taptc"
            else UniformGenerator(tasks=size, robots=team)
        )
        stream = get_args(Distribution).index(distribution)
        return [
            generator(
                np.random.default_rng((HELD_OUT_SEED, stream, robots, index)), f"{distribution}-a{robots}-{index:03d}"
            )
            for index in range(self.count)
        ]
