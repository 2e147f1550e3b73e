"""Random awkward scenarios, and choosers of legal actions.

One recipe serves Hypothesis, which shrinks failures, and plain seeded loops, which are many times faster.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
from hypothesis import strategies as st

from mrta_zoo.scenario import Scenario

Chooser = Callable[[npt.NDArray[np.bool_]], int]
"""Takes a mask with at least one legal task, returns the task to take."""


class Source(Protocol):
    """Where the recipe gets its numbers."""

    def integer(self, low: int, high: int) -> int:
        """An integer from `low` to `high`, both included."""

    def real(self, low: float, high: float) -> float:
        """A float from `low` to `high`."""

    def pick(self, options: Sequence[Any]) -> Any:
        """One of `options`."""


class SeededSource:
    """Numbers from a generator."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng

    def integer(self, low: int, high: int) -> int:
        return int(self._rng.integers(low, high, endpoint=True))

    def real(self, low: float, high: float) -> float:
        return float(self._rng.uniform(low, high))

    def pick(self, options: Sequence[Any]) -> Any:
        return options[self._rng.integers(len(options))]


class HypothesisSource:
    """Numbers from Hypothesis, which prefers the awkward ones."""

    def __init__(self, draw: st.DrawFn) -> None:
        self._draw = draw

    def integer(self, low: int, high: int) -> int:
        return self._draw(st.integers(low, high))

    def real(self, low: float, high: float) -> float:
        return self._draw(st.floats(low, high, allow_subnormal=False))

    def pick(self, options: Sequence[Any]) -> Any:
        return self._draw(st.sampled_from(options))


def make_scenario(source: Source, max_tasks: int = 12, max_robots: int = 4) -> Scenario:
    """A scenario on a small integer grid (ties everywhere), of awkward floats, or with nothing feasible."""
    n, m = source.integer(1, max_tasks), source.integer(1, max_robots)
    kind = source.pick(("grid", "grid", "floats", "floats", "hopeless"))
    return {"grid": _grid, "floats": _floats, "hopeless": _hopeless}[kind](source, n, m)


def seeded_scenarios(seed: int, count: int, max_tasks: int = 12, max_robots: int = 4) -> list[Scenario]:
    """`count` scenarios, the same ones for the same seed."""
    source = SeededSource(np.random.default_rng(seed))
    return [make_scenario(source, max_tasks, max_robots) for _ in range(count)]


@st.composite
def scenarios(draw: st.DrawFn, max_tasks: int = 12, max_robots: int = 4) -> Scenario:
    """The same recipe for Hypothesis."""
    return make_scenario(HypothesisSource(draw), max_tasks, max_robots)


def seeded_chooser(seed: int) -> Chooser:
    """Picks uniformly among the legal tasks."""
    rng = np.random.default_rng(seed)

    def choose(mask: npt.NDArray[np.bool_]) -> int:
        legal = np.flatnonzero(mask)
        return int(legal[rng.integers(len(legal))])

    return choose


def decisions(max_tasks: int = 12) -> st.SearchStrategy[Chooser]:
    """Choosers that shrink towards always taking the first legal task."""
    return st.lists(st.integers(0, max_tasks - 1), max_size=max_tasks).map(_scripted)


def _scripted(script: list[int]) -> Chooser:
    rest = iter(script)

    def choose(mask: npt.NDArray[np.bool_]) -> int:
        legal = np.flatnonzero(mask)
        return int(legal[next(rest, 0) % len(legal)])

    return choose


def _grid(source: Source, n: int, m: int, least_work: int = 0) -> Scenario:
    """Few distinct places and times: zero distances, zero workloads, robots that arrive together."""
    side = source.pick((1, 2, 4, 12))
    latest = source.pick((2, 6, 20, 60))
    most_work = source.pick((least_work, 1, 4))
    speeds = source.pick(((1.0,), (0.5, 1.0, 2.0)))

    def places(count: int) -> list[list[int]]:
        return [[source.integer(0, side), source.integer(0, side)] for _ in range(count)]

    return Scenario(
        task_xy=np.array(places(n)),
        deadline=np.array([source.integer(1, latest) for _ in range(n)]),
        workload=np.array([source.integer(least_work, most_work) for _ in range(n)]),
        robot_xy=np.array(places(m)),
        capacity=np.array([source.pick((0.5, 1.0, 1.0, 2.0)) for _ in range(m)]),
        speed=np.array([source.pick(speeds) for _ in range(m)]),
        map_size=(side, side),
        name="grid",
    )


def _floats(source: Source, n: int, m: int) -> Scenario:
    """Numbers that round badly, in several magnitudes; some deadlines are met, or missed, by one bit."""
    side = source.pick((1e-4, 1.0, 97.3, 1e6))
    pace = source.pick((1.0, 1e-3, 37.7))
    crossing = side / pace
    horizon = crossing * source.pick((0.7, 2.5, 9.0))
    task_xy = [[source.real(0, side), source.real(0, side)] for _ in range(n)]
    robot_xy = [[source.real(0, side), source.real(0, side)] for _ in range(m)]
    workload = [source.real(0, 1) * crossing for _ in range(n)]
    capacity = [source.real(0.2, 5) for _ in range(m)]
    speed = [pace * source.real(0.3, 3) for _ in range(m)]
    deadline = [horizon * source.real(0.001, 1) for _ in range(n)]

    def finish(robot: int, start: list[float], ready: float, task: int) -> float:
        dx, dy = task_xy[task][0] - start[0], task_xy[task][1] - start[1]
        return ready + math.sqrt(dx * dx + dy * dy) / speed[robot] + workload[task] / capacity[robot]

    for task in range(n):
        tie = source.pick((None, None, "first", "second", "missed"))
        robot, before = source.integer(0, m - 1), source.integer(0, n - 1)
        if tie is None:
            continue
        exact = finish(robot, robot_xy[robot], 0.0, task)
        if tie == "second" and before != task:
            ready = finish(robot, robot_xy[robot], 0.0, before)
            exact = finish(robot, task_xy[before], ready, task)
        if tie == "missed":
            exact = math.nextafter(exact, 0.0)
        if exact >= 1e-12:
            deadline[task] = exact
    return Scenario(
        task_xy=np.array(task_xy),
        deadline=np.array(deadline),
        workload=np.array(workload),
        robot_xy=np.array(robot_xy),
        capacity=np.array(capacity),
        speed=np.array(speed),
        map_size=(side, side),
        name="floats",
    )


def _hopeless(source: Source, n: int, m: int) -> Scenario:
    """No robot can finish any task by its deadline: one unit of work takes longer than there is time."""
    base = _grid(source, n, m, least_work=1)
    return Scenario(
        base.task_xy, base.deadline * 0.001, base.workload, base.robot_xy, base.capacity, base.speed,
        base.map_size, "hopeless",
    )  # fmt: skip
