"""The trainer on the public AEC API alone learns a tiny problem."""

from __future__ import annotations

from test_reinforce import FirstThingsFirst

from mrta_zoo import mrta_v0
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.sharing import build_network
from mrta_zoo.train.aec_reinforce import evaluate, train


def test_learns_to_do_first_what_is_due_first() -> None:
    env = mrta_v0.env(generator=FirstThingsFirst(), max_tasks=2, max_robots=1, reward="completion")
    network = build_network(NetworkConfig(embedding=32, heads=4), "shared", robots=1, seed=0)
    before = evaluate(env, network)
    for _ in train(env, network, updates=15):
        pass
    # Going by places alone completes 3/4 (see FirstThingsFirst).
    assert before < 0.9
    assert evaluate(env, network) > 0.95
