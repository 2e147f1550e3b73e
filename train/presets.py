"""Named training configurations."""

from __future__ import annotations

from dataclasses import replace

from mrta_zoo.policies.capam.config import NetworkConfig
from mrta_zoo.train.config import TrainConfig

# The paper's architecture; such runs took 47 to 94 minutes on one thread of a busy machine.
FAST = TrainConfig(
    generator="mixture",
    scenarios=12,
    samples=8,
    updates=6000,
    epoch=50,
    learning_rate=5e-4,
    final_learning_rate=2e-5,
    seed=1,
)

PRESETS: dict[str, TrainConfig] = {
    # Table I of the paper: 100 epochs of 500,000 samples, an update every 500, Adam at 1e-4, greedy-rollout
    # baseline tested on 10,000 validation samples. Some 50 million episodes: meant for a GPU.
    "paper": TrainConfig(
        generator="uniform",
        mask_rule="unvisited",
        objective="cost",
        baseline="rollout",
        normalise=False,
        scenarios=500,
        samples=1,
        updates=100_000,
        epoch=1000,
        learning_rate=1e-4,
        final_learning_rate=1e-4,
        validation_scenarios=10_000,
    ),
    "fast": FAST,
    # The same with decision-time features in the decoder: better, and slower to train.
    "fast-plus": replace(FAST, network=NetworkConfig(decoder="candidates"), updates=4000),
    # Less than a minute on one CPU thread: to see that everything works.
    "smoke": TrainConfig(
        network=NetworkConfig(embedding=64),
        tasks=(40,),
        reference_tasks=40,
        max_robots=4,
        scenarios=12,
        samples=8,
        updates=240,
        epoch=40,
        learning_rate=1e-3,
        final_learning_rate=1e-4,
        validation_scenarios=64,
    ),
}
