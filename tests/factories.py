"""Small scenarios and episodes for tests."""

from __future__ import annotations

from typing import Any

import numpy as np

from mrta_zoo import Scenario


def small_scenario(
    rng: np.random.Generator | int = 0, tasks: int = 8, robots: int = 3, latest: float = 120.0, name: str = "small"
) -> Scenario:
    """A random scenario on a 50 × 50 map in which some tasks can be completed and some usually cannot."""
    rng = np.random.default_rng(rng)
    return Scenario(
        task_xy=rng.uniform(0, 50, (tasks, 2)),
        deadline=rng.uniform(10, latest, tasks),
        workload=rng.uniform(0, 20, tasks),
        robot_xy=rng.uniform(0, 50, (robots, 2)),
        capacity=rng.uniform(1, 3, robots),
        speed=rng.uniform(0.8, 1.6, robots),
        map_size=(50.0, 50.0),
        name=name,
    )


def hopeless_scenario(robots: int = 2) -> Scenario:
    """One task that nobody can finish by its deadline: 50 distance units away, due at time 1."""
    return Scenario(
        task_xy=[[50.0, 0.0]], deadline=[1.0], workload=[5.0],
        robot_xy=[[0.0, 0.0]] * robots, capacity=[1.0] * robots, map_size=(50.0, 50.0), name="hopeless",
    )  # fmt: skip


def mask_of(observation: Any, info: dict[str, Any]) -> np.ndarray:
    """The action mask, wherever the form of the observation puts it."""
    return observation["action_mask"] if isinstance(observation, dict) else info["action_mask"]


def random_action(mask: np.ndarray, rng: np.random.Generator) -> int:
    """A legal action."""
    return int(rng.choice(np.flatnonzero(mask)))


def play(env: Any, seed: int = 0) -> tuple[list[tuple[str, int]], dict[str, float]]:
    """Finish an episode that has been reset, with random legal actions.

    Returns:
        The decisions (agent, action) and each agent's sum of the rewards that `last` showed it.
    """
    rng = np.random.default_rng(seed)
    decisions: list[tuple[str, int]] = []
    returns = dict.fromkeys(env.agents, 0.0)
    for agent in env.agent_iter():
        observation, reward, terminated, truncated, info = env.last()
        returns[agent] += reward
        if terminated or truncated:
            env.step(None)
            continue
        action = random_action(mask_of(observation, info), rng)
        decisions.append((agent, action))
        env.step(action)
    return decisions, returns
