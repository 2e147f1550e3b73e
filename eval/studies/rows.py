"""One row per run and held-out scenario: the data behind every table and figure of a study."""

from __future__ import annotations

from dataclasses import dataclass

from mrta_zoo.errors import ConfigError

RUN_KEY = ("variant", "seed", "distribution", "robots", "scenario", "tasks")
"""The columns that tell rows apart."""


@dataclass(frozen=True, slots=True)
class RunRow:
    """What a trained network reached on a scenario, in one greedy pass, by the verifier's count.

    Attributes:
        variant: name of the arm.
        seed: of its training.
        distribution: of the scenario.
        robots: number of robots.
        scenario: number of the scenario among those of its distribution and robots, from 0.
        completed: tasks finished by their deadline.
        tasks: number of tasks.

    Raises:
        ConfigError: if more tasks are completed than there are, or fewer than none.
    """

    variant: str
    seed: int
    distribution: str
    robots: int
    scenario: int
    completed: int
    tasks: int

    def __post_init__(self) -> None:
        if not 0 <= self.completed <= self.tasks:
            raise ConfigError(f"completed is {self.completed}; expected 0 to {self.tasks}, the number of tasks")
