"""The distribution of training scenarios that a configuration names."""

from __future__ import annotations

from mrta_zoo.generators import Mixture, ScenarioGenerator, TaptcGenerator, UniformGenerator


def training_generator(name: str, tasks: int, min_robots: int, max_robots: int) -> ScenarioGenerator:
    """The generator of training and validation scenarios of one size.

    Args:
        name: "taptc" (fitted to the benchmark), "uniform" (paper §IV-A), or "mixture": 2/5 each of these two, and 1/5
            TAPTC-like with robots of capacity 1 or 2 at random and deadlines from a wider range.
        tasks: number of tasks.
        min_robots: fewest robots.
        max_robots: most robots.
    """
    size, team = (tasks, tasks), (min_robots, max_robots)
    taptc = TaptcGenerator(tasks=size, robots=team)
    uniform = UniformGenerator(tasks=size, robots=team)
    if name == "taptc":
        return taptc
    if name == "uniform":
        return uniform
    wide = TaptcGenerator(tasks=size, robots=team, capacity="random", latest=(210.0, 320.0), min_deadline=20.0)
    return Mixture((taptc, wide, uniform), (0.4, 0.2, 0.4))
