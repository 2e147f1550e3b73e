"""Small scenarios and episodes for tests."""

from __future__ import annotations

from typing import Any

import numpy as np

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.generators import UniformGenerator

GENERATOR = UniformGenerator(tasks=(3, 10), robots=(2, 5), deadline=(20, 200))
FORMS = ["dict", "masked", "flat"]
"""The forms of observations."""


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


def started(seed: int = 0, make: Any = mrta_v0.env, **options: Any) -> Any:
    """An environment after its first reset."""
    env = make(**options)
    env.reset(seed=seed)
    return env


def same(a: Any, b: Any) -> bool:
    """Equal, also in type and dtype, through dictionaries and arrays."""
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and np.array_equal(a, b)
    return type(a) is type(b) and a == b


def record(env: Any, seed: int) -> list[Any]:
    """Everything that an episode shows, from its present state to the end."""
    rng = np.random.default_rng(seed)
    seen = []
    for agent in env.agent_iter():
        observation, reward, terminated, truncated, info = env.last()
        seen.append({"agent": agent, "observation": observation, "reward": reward, "info": info,
                     "rewards": dict(env.rewards), "state": env.state(), "over": (terminated, truncated)})  # fmt: skip
        env.step(None if terminated or truncated else random_action(mask_of(observation, info), rng))
    return seen


def completion_rate(env: Any) -> float:
    """The completion rate of the mission so far."""
    mission = env.unwrapped.mission
    return mission.completed() / mission.scenario.num_tasks


def named_scenario() -> Scenario:
    """Five tasks and two robots, most with names that could be mistaken for markup.

    Ann can do valve-A from 0 to 15 (10 of way, 5 of work) and then pump #3 <b> from 15 to 45 (20 and 10). Bob & Co,
    twice as fast and strong, can do =SUM(A1) until 17 (30 / 2 and 4 / 2) or else $x$ until 21 (40 / 2 and 2 / 2),
    not both in time. 弁[red] is due at 20, when Ann has come 20 of 100 and Bob & Co 40 of 141 units.
    """
    return Scenario(
        task_xy=[[10, 0], [30, 0], [100, 30], [0, 100], [60, 0]],
        deadline=[20, 50, 30, 20, 25],
        workload=[5, 10, 4, 0, 2],
        robot_xy=[[0, 0], [100, 0]],
        capacity=[1, 2],
        speed=[1, 2],
        map_size=(100, 100),
        name="named",
        task_names=("valve-A", "pump #3 <b>", "=SUM(A1)", "弁[red]", "$x$"),
        robot_names=("Ann", "Bob & Co"),
    )
