"""Random scenarios: the paper's training distribution, one fitted to the TAPTC cases, and mixtures of them.

A generator is a frozen dataclass of bounds; calling it with a NumPy generator draws one `Scenario`. Equal
bounds and an equally seeded generator give equal scenarios.
"""

from __future__ import annotations

import dataclasses
import reprlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, Protocol, get_args

import numpy as np

from mrta_zoo.bounds import as_count_range, as_range, as_sides, is_number
from mrta_zoo.errors import ConfigError
from mrta_zoo.scenario import FloatArray, Scenario
from mrta_zoo.wording import counted


class ScenarioGenerator(Protocol):
    """Anything that draws a scenario when called with a random generator."""

    def __call__(self, rng: np.random.Generator, name: str = ...) -> Scenario:
        """Draw one scenario, using no other randomness than `rng`."""
        ...


DrawFunction = Callable[[np.random.Generator], Scenario]
"""The least that a generator has to be, which may be a user's own."""


def draw_scenario(generator: DrawFunction, rng: np.random.Generator) -> Scenario:
    """One scenario from a generator, which may be a user's own.

    Raises:
        ConfigError: if it gives something else.
    """
    scenario = generator(rng)
    if not isinstance(scenario, Scenario):
        raise ConfigError(f"the generator drew {reprlib.repr(scenario)}; expected a mrta_zoo.Scenario")
    return scenario


def _draw_count(rng: np.random.Generator, bounds: tuple[int, int]) -> int:
    return int(rng.integers(bounds[0], bounds[1], endpoint=True))


def _draw(rng: np.random.Generator, bounds: tuple[float, float], count: int) -> FloatArray:
    low, high = bounds
    if low == high:
        return np.full(count, low)
    return low + (high - low) * rng.random(count)


@dataclass(frozen=True, slots=True)
class UniformGenerator:
    """Everything uniform within bounds: the training distribution of the paper, §IV-A.

    Each bound is a pair (lowest, highest), both included; a single number stands for a pair of equal ones.

    Attributes:
        tasks: number of tasks, >= 1.
        robots: number of robots, >= 1.
        deadline: latest finish of a task in time units, > 0.
        workload: work at a task in work units, >= 0.
        capacity: work a robot does per time unit, > 0.
        speed: distance a robot travels per time unit, > 0.
        map_size: width and height of the map in distance units, > 0; all places are drawn inside it.

    Raises:
        ConfigError: if a bound is out of range, or the lowest exceeds the highest.
    """

    tasks: tuple[int, int] = (100, 100)
    robots: tuple[int, int] = (2, 7)
    deadline: tuple[float, float] = (50.0, 600.0)
    workload: tuple[float, float] = (10.0, 30.0)
    capacity: tuple[float, float] = (1.0, 3.0)
    speed: tuple[float, float] = (1.0, 1.0)
    map_size: tuple[float, float] = (100.0, 100.0)

    def __post_init__(self) -> None:
        for field in ("tasks", "robots"):
            object.__setattr__(self, field, as_count_range(field, getattr(self, field)))
        for field in ("deadline", "capacity", "speed"):
            object.__setattr__(self, field, as_range(field, getattr(self, field), positive=True))
        object.__setattr__(self, "workload", as_range("workload", self.workload, positive=False))
        object.__setattr__(self, "map_size", as_sides(self.map_size))

    def __call__(self, rng: np.random.Generator, name: str = "uniform") -> Scenario:
        """Draw one scenario, using no other randomness than `rng`."""
        n, m = _draw_count(rng, self.tasks), _draw_count(rng, self.robots)
        return Scenario(
            task_xy=rng.random((n, 2)) * self.map_size,
            deadline=_draw(rng, self.deadline, n),
            workload=_draw(rng, self.workload, n),
            robot_xy=rng.random((m, 2)) * self.map_size,
            capacity=_draw(rng, self.capacity, m),
            speed=_draw(rng, self.speed, m),
            map_size=self.map_size,
            name=name,
        )


DeadlineGroup = Literal["tight", "slack", "mixed"]
CapacityRule = Literal["half", "random"]


@dataclass(frozen=True, slots=True)
class TaptcGenerator:
    """Scenarios like the published TAPTC cases (Mitiche, Boughaci, Gini 2019), fitted to those files.

    The latest deadline D is drawn once per scenario. A share of the tasks has deadlines drawn from a normal
    distribution with mean (low + D) / 2 and standard deviation (D - low) / spread, redrawn while outside
    [min_deadline, D]; all other tasks have deadline D. In the slack group D is twice what the tight group
    draws, and the same formula then gives its other deadlines.

    Attributes:
        tasks: least and greatest number of tasks, >= 1.
        robots: least and greatest number of robots, >= 1.
        group: ``"tight"`` or ``"slack"`` deadlines, or ``"mixed"``: each with probability 1/2.
        normal_share: shares of tasks with normally drawn deadlines, in 0..1; one is picked for each scenario.
        latest: range of the tight group's D, in time units.
        slack_factor: D of the slack group as a multiple of the tight group's, > 0.
        low: nominal start of the deadline window in time units, < D.
        spread: width of the window D - low in standard deviations, >= 1 (measured: 5.2 tight, 6 slack).
        min_deadline: least deadline, in time units, > 0 and at most (low + D) / 2.
        workload: work of every task, >= 0.
        capacity: ``"half"``: the first floor(M/2) robots have capacity 2, the others 1, as in the published
            cases with 100 tasks; ``"random"``: 1 or 2 by fair coin, as in the double-size cases.
        integer: whole coordinates (from 0 to side - 1) and deadlines, as in the published cases.
        map_size: width and height of the map in distance units, >= 1.

    Raises:
        ConfigError: if a value is out of range.
    """

    tasks: tuple[int, int] = (100, 100)
    robots: tuple[int, int] = (2, 7)
    group: DeadlineGroup = "mixed"
    normal_share: tuple[float, ...] = (0.25, 0.5, 0.75, 1.0)
    latest: tuple[float, float] = (250.0, 300.0)
    slack_factor: float = 2.0
    low: float = 100.0
    spread: float = 5.5
    min_deadline: float = 30.0
    workload: float = 20.0
    capacity: CapacityRule = "half"
    integer: bool = True
    map_size: tuple[float, float] = (100.0, 100.0)

    def __post_init__(self) -> None:
        for field in ("tasks", "robots"):
            object.__setattr__(self, field, as_count_range(field, getattr(self, field)))
        object.__setattr__(self, "latest", as_range("latest", self.latest, positive=True))
        object.__setattr__(self, "map_size", as_sides(self.map_size))
        for field, allowed in (("group", DeadlineGroup), ("capacity", CapacityRule)):
            if getattr(self, field) not in get_args(allowed):
                raise ConfigError(
                    f"{field} is {getattr(self, field)!r}; expected one of {', '.join(get_args(allowed))}"
                )
        self._check_shares()
        self._check_numbers()
        self._check_earliest_deadlines()
        if self.integer and min(self.map_size) < 1:
            raise ConfigError(f"map_size is {self.map_size}; whole coordinates need sides >= 1")

    def _check_shares(self) -> None:
        given: Any = self.normal_share
        shares: tuple[Any, ...] = tuple(given) if isinstance(given, (tuple, list)) else (given,)
        if not shares or not all(is_number(share) and 0 <= share <= 1 for share in shares):
            raise ConfigError(f"normal_share is {given!r}; expected one or more numbers from 0 to 1")
        object.__setattr__(self, "normal_share", tuple(float(share) for share in shares))

    def _check_numbers(self) -> None:
        for field, least in (("slack_factor", 0.0), ("spread", 1.0), ("min_deadline", 0.0), ("workload", 0.0)):
            value = getattr(self, field)
            strict = field in ("slack_factor", "min_deadline")
            if not is_number(value) or value < least or (strict and value == least):
                bound = f"{'>' if strict else '>='} {least:g}"
                raise ConfigError(f"{field} is {value!r}; expected a finite number {bound}")

    def _check_earliest_deadlines(self) -> None:
        """Redrawing soon ends only if the mean lies between the bounds even with the earliest D."""
        earliest = float(np.floor(self.latest[0])) if self.integer else self.latest[0]
        if self.group != "tight":
            earliest *= self.slack_factor if self.group == "slack" else min(1.0, self.slack_factor)
        if not is_number(self.low) or not 0 <= self.low < earliest:
            raise ConfigError(f"low is {self.low!r}; expected a number >= 0 and < {earliest:g}, the earliest D")
        mean = (self.low + earliest) / 2
        most = float(np.floor(mean)) if self.integer else mean
        if self.min_deadline > most:
            raise ConfigError(
                f"min_deadline is {self.min_deadline!r}; expected at most {most:g}, "
                "the least mean of the drawn deadlines"
            )

    def __call__(self, rng: np.random.Generator, name: str = "taptc") -> Scenario:
        """Draw one scenario, using no other randomness than `rng`."""
        n, m = _draw_count(rng, self.tasks), _draw_count(rng, self.robots)
        slack = self.group == "slack" or (self.group == "mixed" and rng.random() < 0.5)
        share = self.normal_share[rng.integers(len(self.normal_share))]
        if self.capacity == "half":
            capacity: FloatArray = np.ones(m)
            capacity[: m // 2] = 2.0
        else:
            capacity = np.where(rng.random(m) < 0.5, 2.0, 1.0)
        return Scenario(
            task_xy=self._places(rng, n),
            deadline=self._deadlines(rng, n, share, self.slack_factor if slack else 1.0),
            workload=np.full(n, float(self.workload)),
            robot_xy=self._places(rng, m),
            capacity=capacity,
            map_size=self.map_size,
            name=name,
        )

    def _places(self, rng: np.random.Generator, count: int) -> FloatArray:
        if self.integer:
            return np.floor(rng.random((count, 2)) * np.floor(self.map_size))
        return rng.random((count, 2)) * self.map_size

    def _deadlines(self, rng: np.random.Generator, n: int, share: float, factor: float) -> FloatArray:
        """(n,) deadlines, the drawn ones at random positions."""
        latest = rng.uniform(*self.latest)
        latest = (round(latest) if self.integer else latest) * factor
        mean, deviation = (self.low + latest) / 2, (latest - self.low) / self.spread
        least = np.ceil(self.min_deadline) if self.integer else self.min_deadline
        drawn: FloatArray = rng.normal(mean, deviation, round(share * n))
        while (outside := (drawn < least) | (drawn > latest)).any():
            drawn[outside] = rng.normal(mean, deviation, int(outside.sum()))
        deadline: FloatArray = np.full(n, latest)
        deadline[rng.permutation(n)[: len(drawn)]] = drawn
        return np.rint(deadline) if self.integer else deadline


@dataclass(frozen=True, slots=True)
class MixtureGenerator:
    """Draws from one of several generators, picked anew for each scenario.

    Attributes:
        generators: what to draw from, at least one.
        weights: relative frequency of each, >= 0, not all 0; empty means equal.

    Raises:
        ConfigError: if there is no generator, or the weights do not fit.
    """

    generators: tuple[ScenarioGenerator, ...] = (UniformGenerator(), TaptcGenerator())
    weights: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "generators", tuple(self.generators))
        object.__setattr__(self, "weights", tuple(self.weights))
        if not self.generators or not all(callable(generator) for generator in self.generators):
            raise ConfigError(f"generators is {self.generators!r}; expected one or more generators")
        if not self.weights:
            return
        if len(self.weights) != len(self.generators):
            raise ConfigError(
                f"weights has {counted(len(self.weights), 'entry', 'entries')}; expected "
                f"{len(self.generators)}, one for each generator"
            )
        if not all(is_number(weight) and weight >= 0 for weight in self.weights) or sum(self.weights) == 0:
            raise ConfigError(f"weights is {self.weights}; expected finite numbers >= 0, not all 0")

    def __call__(self, rng: np.random.Generator, name: str = "mixture") -> Scenario:
        """Pick a generator and draw one scenario from it, using no other randomness than `rng`."""
        weights = self.weights or (1.0,) * len(self.generators)
        threshold = rng.random() * sum(weights)
        # The last one with a weight catches a threshold that rounding has put at the very end.
        chosen = max(index for index, weight in enumerate(weights) if weight > 0)
        for index, weight in enumerate(weights):
            if threshold < weight:
                chosen = index
                break
            threshold -= weight
        return self.generators[chosen](rng, name)


GENERATORS: dict[str, type[UniformGenerator] | type[TaptcGenerator] | type[MixtureGenerator]] = {
    "uniform": UniformGenerator,
    "taptc": TaptcGenerator,
    "mixture": MixtureGenerator,
}
"""Generators by the name used in configurations and on the command line."""


def make_generator(name: str, **overrides: Any) -> ScenarioGenerator:
    """The named generator with some of its fields changed.

    Raises:
        ConfigError: if there is no generator of that name, it has no such field, or a value is out of range.
    """
    if name not in GENERATORS:
        raise ConfigError(f"there is no generator {name!r}; expected one of {', '.join(GENERATORS)}")
    cls = GENERATORS[name]
    fields = [field.name for field in dataclasses.fields(cls)]
    for override in overrides:
        if override not in fields:
            raise ConfigError(f"generator {name!r} has no field {override!r}; it has {', '.join(fields)}")
    return cls(**overrides)
