"""REINFORCE with nothing but the public PettingZoo AEC API: the example to copy for a trainer of your own.

One CapAM network serves all robots. Each scenario is played several times; a mission that completes more than the
others of its scenario makes its decisions likelier (leave-one-out baseline). `train.reinforce` does the same on the
batched simulator: 17 times faster with updates of this size, 113 times with 64 scenarios x 8 samples.

Run it with ``python -m mrta_zoo.train.aec_reinforce``, ``--help`` for more: 12 tasks, 2 robots, a quarter of a minute.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import torch
import tyro
from torch import Tensor

from mrta_zoo import mrta_v0
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.policies.cpu_threads import few_threads
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.sharing import build_network


def play(env: Any, network: Any, seed: int, sampler: torch.Generator | None) -> tuple[float, Tensor]:
    """Play one episode.

    Args:
        env: an AEC environment with Dict observations and the "completion" reward.
        network: chooses for every robot.
        seed: draws the scenario; the same seed gives the same one.
        sampler: draws the actions; None takes the likeliest.

    Returns:
        The completion rate, and the log-probability of all decisions together.
    """
    env.reset(seed=seed)
    first_agent = env.possible_agents[0]
    completion, log_prob, encoding = 0.0, torch.zeros(()), None
    for agent in env.agent_iter():
        observation, reward, termination, truncation, _ = env.last()
        if agent == first_agent:
            completion += reward  # every robot gets the team's reward; count it once
        if termination or truncation:
            env.step(None)
            continue
        if encoding is None:
            encoding = network.encode(Tasks.of_observations([observation]))
        log_probs = network(encoding, DecisionStates.of_observations([observation]))[0, 0]
        if sampler is None:
            action = int(log_probs.argmax())
        else:
            action = int(torch.multinomial(log_probs.detach().exp(), 1, generator=sampler))
        log_prob = log_prob + log_probs[action]
        env.step(action)
    return completion, log_prob


def train(
    env: Any, network: Any, *, updates: int = 100, scenarios: int = 4, samples: int = 4, seed: int = 0
) -> Iterator[float]:
    """Train `network` in place; yields the mean completion rate of each update's episodes."""
    optimizer = torch.optim.Adam(network.parameters(), lr=1e-3)
    sampler = torch.Generator().manual_seed(seed)
    for update in range(updates):
        losses, completions = [], []
        with few_threads():
            for scenario in range(scenarios):
                scenario_seed = 1_000_000 + seed * 10_000_000 + update * scenarios + scenario
                episodes = [play(env, network, scenario_seed, sampler) for _ in range(samples)]
                mean = sum(completion for completion, _ in episodes) / samples
                losses += [-(completion - mean) * log_prob for completion, log_prob in episodes]
                completions.append(mean)
            optimizer.zero_grad()
            (torch.stack(losses).mean() * 10).backward()  # completion rates differ by hundredths
            torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
            optimizer.step()
        yield sum(completions) / scenarios


def evaluate(env: Any, network: Any, episodes: int = 50) -> float:
    """Mean greedy completion rate over scenarios that training never sees."""
    with torch.no_grad(), few_threads():
        return sum(play(env, network, seed, None)[0] for seed in range(episodes)) / episodes


def small_problem() -> Any:
    """12 tasks, 2 robots, deadlines too tight for all of them."""
    generator = UniformGenerator(tasks=(12, 12), robots=(2, 2), deadline=(60, 250), workload=(10, 30))
    return mrta_v0.env(generator=generator, max_tasks=12, max_robots=2, reward="completion")


def main(updates: int = 100, seed: int = 0) -> None:
    """Train on the small problem and print the result.

    Args:
        updates: gradient steps.
        seed: seeds weights, scenarios and choices.
    """
    env = small_problem()
    network = build_network(NetworkConfig(embedding=32, heads=4), "shared", robots=2, seed=seed)
    print(f"greedy completion before training: {evaluate(env, network):.3f}")
    for update, completion in enumerate(train(env, network, updates=updates, seed=seed), start=1):
        if update % 10 == 0:
            print(f"update {update}: sampled completion {completion:.3f}")
    print(f"greedy completion after training: {evaluate(env, network):.3f}")


if __name__ == "__main__":
    tyro.cli(main)
