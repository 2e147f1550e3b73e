"""The trainer on the public AEC API alone learns a tiny problem."""

from __future__ import annotations

from test_reinforce import Detour

from mrta_zoo import mrta_v0
from mrta_zoo.policies.capam.config import NetworkConfig
from mrta_zoo.policies.sharing import build_network
from mrta_zoo.train.aec_reinforce import evaluate, train


def test_learns_to_pass_the_near_task_by() -> None:
    env = mrta_v0.env(generator=Detour(), max_tasks=2, max_robots=1, reward="completion")
    network = build_network(NetworkConfig(embedding=32, heads=4), "shared", robots=1, seed=0)
    for _ in train(env, network, updates=60):
        pass
    # Nearest first completes 0.5, far first 1.0 (see Detour).
    assert evaluate(env, network) > 0.95
