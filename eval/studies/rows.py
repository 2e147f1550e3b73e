"""One line for each run and held-out scenario: the data behind every table and figure of the study."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class RunRow:
    """What a trained variant reached on a scenario, in one greedy pass, by the verifier's count.

    Attributes:
        variant: name of the variant.
        seed: of its training.
        distribution: of the scenario.
        robots: number of robots.
        scenario: number of the scenario among those of its distribution and robots, from 0.
        completed: tasks finished by their deadline.
        tasks: number of tasks.
    """

    variant: str
    seed: int
    distribution: str
    robots: int
    scenario: int
    completed: int
    tasks: int
