"""The small problem that every integration learns, and how well a policy does on it."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt
import tyro

from mrta_zoo.env.settings import ObservationForm
from mrta_zoo.plan import Plan
from mrta_zoo.policies.aec_loop import run_in_environment
from mrta_zoo.policies.classical.heuristics import NearestPolicy, RandomPolicy
from mrta_zoo.policies.protocol import Policy
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify

TASKS, ROBOTS = 10, 2
UNSEEN = 1_000_000
"""Seed of the first scenario that policies are judged on; training draws its own from generators seeded lower."""

Planner = Callable[[Scenario], Plan]


class Site:
    """The same 10 tasks every day, and 2 robots that start anywhere, with other capacities each day.

    Random legal choices complete about 53 % of them, and the nearest task 73 %.

    Attributes:
        tasks: fewest and most tasks, from which the environment knows how much room it needs.
        robots: likewise for robots.
    """

    tasks: ClassVar = (TASKS, TASKS)
    robots: ClassVar = (ROBOTS, ROBOTS)

    def __call__(self, rng: np.random.Generator, name: str = "site") -> Scenario:
        """Draw one day."""
        site = np.random.default_rng(1)
        return Scenario(
            task_xy=site.uniform(0, 100, (TASKS, 2)),
            deadline=site.uniform(20, 200, TASKS),
            workload=site.uniform(5, 25, TASKS),
            robot_xy=rng.uniform(0, 100, (ROBOTS, 2)),
            capacity=rng.uniform(1, 3, ROBOTS),
            map_size=(100.0, 100.0),
            name=name,
        )


def options(observation: ObservationForm) -> dict[str, Any]:
    """Options of the environment, in any of its forms: ``mrta_v0.env(**options("flat"))``."""
    return {"generator": Site(), "reward": "completion", "observation": observation}


def in_aec_loop(policy: Policy) -> Planner:
    """A planner by a policy in the environment, with the form of observation that the policy asks for, if any."""
    form: ObservationForm = getattr(policy, "observation", "dict")
    return lambda scenario: run_in_environment(policy, scenario, observation=form)


def completions(plan: Planner, episodes: int = 200) -> npt.NDArray[np.float64]:
    """(episodes,) share of the tasks completed in each of as many unseen scenarios, by the verifier."""
    unseen = (Site()(np.random.default_rng(UNSEEN + episode)) for episode in range(episodes))
    return np.array([verify(scenario, plan(scenario)).completed / TASKS for scenario in unseen])


def show(train: Callable[..., Any]) -> None:
    """Command line of an integration: train, with the function's arguments as flags, and print the result."""
    begun = time.perf_counter()
    trained = tyro.cli(train, prog=f"python -m mrta_zoo.train.integrations.{Path(sys.argv[0]).stem}")
    took = time.perf_counter() - begun
    planners = {
        "random": in_aec_loop(RandomPolicy()),
        "nearest": in_aec_loop(NearestPolicy()),
        "trained": trained.plan if hasattr(trained, "plan") else in_aec_loop(trained),
    }
    for name, plan in planners.items():
        share = completions(plan)
        error = share.std(ddof=1) / np.sqrt(len(share))
        print(f"{name:8} {100 * share.mean():5.1f} % completed (standard error {100 * error:.1f})")
    print(f"trained in {took:.0f} s ({time.process_time():.0f} s of CPU time in all)")
