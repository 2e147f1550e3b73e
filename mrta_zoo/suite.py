"""The built-in benchmarks, fixed for good: TAPTC-like cases of two sizes, and small scenarios."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

import numpy as np

from mrta_zoo.generators import TaptcGenerator, UniformGenerator
from mrta_zoo.scenario import Scenario

SUITE_SEED = 20220523
DOUBLE_SEED = 20220524
SMALL_SEED = 20220525
ROBOTS = (2, 3, 5, 7)
DOUBLE_ROBOTS = tuple(2 * robots for robots in ROBOTS)
INSTANCES = 3
SMALL_TASKS = (5, 6, 7, 8, 9)
SMALL_ROBOTS = (1, 2, 3)
SMALL_INSTANCES = 4


def builtin_suite() -> list[Scenario]:
    """96 scenarios: 2 deadline groups x 4 shares of drawn deadlines x 2, 3, 5, 7 robots x 3 instances.

    Named like the published cases: ``r{G}{Q}a{n}i0{i}`` has tight (G = 1) or slack (G = 2) deadlines,
    normally drawn ones for Q quarters of its 100 tasks, n robots, and is instance i. Every scenario has its
    own random stream, so none depends on the others. Changing what this returns makes published results
    incomparable: a test holds its hash.
    """
    return _taptc_suite(SUITE_SEED, 100, ROBOTS)


def double_suite() -> list[Scenario]:
    """96 scenarios of twice the size: 200 tasks and 4, 6, 10, 14 robots, everything else as in `builtin_suite`.

    Map, workloads, capacities and deadlines come from the same distribution, so that size is all that differs.
    A test holds its hash.
    """
    return _taptc_suite(DOUBLE_SEED, 200, DOUBLE_ROBOTS)


def small_suite() -> list[Scenario]:
    """60 scenarios small enough for an exact solver: 5 to 9 tasks x 1, 2, 3 robots x 4 instances.

    Deadlines are so tight that the best plan seldom completes every task; otherwise any method would be optimal. Named
    ``s{N}a{M}i0{i}``; even instances are uniform, odd ones TAPTC-like. A test holds its hash.
    """
    scenarios = []
    for tasks in SMALL_TASKS:
        for robots in SMALL_ROBOTS:
            size, team, latest = (tasks, tasks), (robots, robots), 60 + 150 / robots
            uniform = UniformGenerator(tasks=size, robots=team, deadline=(20, 60 + 240 / robots), capacity=(1, 2))
            taptc = TaptcGenerator(
                tasks=size, robots=team, group="tight", latest=(latest, latest), normal_share=(0.5, 1.0), low=0.0,
                spread=4.0, min_deadline=15.0,
            )  # fmt: skip
            for instance in range(SMALL_INSTANCES):
                rng = np.random.default_rng((SMALL_SEED, tasks, robots, instance))
                scenarios.append((uniform, taptc)[instance % 2](rng, f"s{tasks}a{robots}i0{instance}"))
    return scenarios


def _taptc_suite(seed: int, tasks: int, robot_counts: tuple[int, ...]) -> list[Scenario]:
    groups: tuple[Literal["tight", "slack"], ...] = ("tight", "slack")
    scenarios = []
    for group_number, group in enumerate(groups, start=1):
        for quarters in (1, 2, 3, 4):
            for robots in robot_counts:
                generator = TaptcGenerator(
                    tasks=(tasks, tasks), robots=(robots, robots), group=group, normal_share=(quarters / 4,)
                )
                for instance in range(INSTANCES):
                    rng = np.random.default_rng((seed, group_number, quarters, robots, instance))
                    name = f"r{group_number}{quarters}a{robots}i0{instance}"
                    scenarios.append(generator(rng, name))
    return scenarios


SUITES: dict[str, Callable[[], list[Scenario]]] = {"suite-100": builtin_suite, "suite-200": double_suite}
"""The suites by their names on the command line."""
