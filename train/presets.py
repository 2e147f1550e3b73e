"""Named training configurations."""

from __future__ import annotations

from dataclasses import replace

from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.train.config import TrainConfig

# The paper's architecture, from scratch: 33 minutes on one thread of a busy machine.
FAST = TrainConfig(
    generator="mixture",
    scenarios=12,
    samples=8,
    updates=1400,
    epoch=50,
    learning_rate=5e-4,
    final_learning_rate=2e-5,
    seed=1,
)

# What the shipped policies are trained on: several sizes of missions, more robots for more tasks.
BROAD = TrainConfig(
    generator="mixture",
    tasks=(50, 100, 200),
    task_weights=(0.1, 0.72, 0.18),
    imitation_plans=19_000,
    samples=8,
    seed=7,
)

# The paper's networks with the same budget each: 256,000 plans seen in imitation, then 1,024,000 episodes.
PAPER_NETWORK = replace(
    BROAD,
    imitation_updates=1000,
    imitation_batch=256,
    imitation_decisions=32,
    objective="relative",
    scenarios=128,
    samples=16,
    updates=500,
    epoch=100,
    validation_scenarios=256,
    learning_rate=2e-4,
    final_learning_rate=1e-5,
    temperature=0.5,
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
    "capam-plus": replace(
        BROAD,
        network=NetworkConfig(heads=4, decoder="candidates", decision_layers=3, candidates=20, peers=7),
        imitation_plans=31_500,
        imitation_updates=3000,
        imitation_batch=256,
        imitation_decisions=32,
        scenarios=128,
        updates=476,
        epoch=250,
        validation_scenarios=256,
        learning_rate=2e-4,
        final_learning_rate=5e-6,
        entropy=0.01,
        precision="bfloat16",
    ),
    "capam": PAPER_NETWORK,
    "capam-p1": replace(PAPER_NETWORK, network=NetworkConfig(moments=1)),
    "capam-p2": replace(PAPER_NETWORK, network=NetworkConfig(moments=2)),
    "am": replace(PAPER_NETWORK, network=NetworkConfig(encoder="attention", layers=3)),
    # A minute or so on one CPU thread: to see that everything works.
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
