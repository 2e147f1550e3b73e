"""Schedules of the step size and the entropy bonus, through imitation and then REINFORCE."""

from __future__ import annotations

import math

from mrta_zoo.train.config import TrainConfig

WARM_UP = 20
"""Gradient steps over which the step size grows to its full value."""


def learning_rate(config: TrainConfig, update: int) -> float:
    """Adam's step size: along a cosine in each of the two phases, after a linear warm-up.

    Args:
        config: the run.
        update: number of updates done so far.
    """
    if update < config.imitation_updates:
        first, last, done = config.imitation_learning_rate, config.imitation_learning_rate / 10, update
    else:
        first, last, done = config.learning_rate, config.final_learning_rate, update - config.imitation_updates
    return last + (first * min(1.0, (done + 1) / WARM_UP) - last) * cosine(config, update)


def cosine(config: TrainConfig, update: int) -> float:
    """From 1 at the beginning of imitation, and again of REINFORCE, to 0 at its end."""
    if update < config.imitation_updates:
        progress = update / config.imitation_updates
    else:
        progress = (update - config.imitation_updates) / config.updates
    return (1 + math.cos(math.pi * progress)) / 2
