"""The built-in benchmark: 96 scenarios like the published TAPTC cases, the same for everyone, always."""

from __future__ import annotations

from typing import Literal

import numpy as np

from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.scenario import Scenario

SUITE_SEED = 20220523
ROBOTS = (2, 3, 5, 7)
INSTANCES = 3


def builtin_suite() -> list[Scenario]:
    """96 scenarios: 2 deadline groups x 4 shares of drawn deadlines x 2, 3, 5, 7 robots x 3 instances.

    Named like the published cases: ``r{G}{Q}a{n}i0{i}`` has tight (G = 1) or slack (G = 2) deadlines,
    normally drawn ones for Q quarters of its 100 tasks, n robots, and is instance i. Every scenario has its
    own random stream, so none depends on the others. Changing what this returns makes published results
    incomparable: a test holds its hash.
    """
    groups: tuple[Literal["tight", "slack"], ...] = ("tight", "slack")
    scenarios = []
    for group_number, group in enumerate(groups, start=1):
        for quarters in (1, 2, 3, 4):
            for robots in ROBOTS:
                generator = TaptcGenerator(robots=(robots, robots), group=group, normal_share=(quarters / 4,))
                for instance in range(INSTANCES):
                    rng = np.random.default_rng((SUITE_SEED, group_number, quarters, robots, instance))
                    name = f"r{group_number}{quarters}a{robots}i0{instance}"
                    scenarios.append(generator(rng, name))
    return scenarios
