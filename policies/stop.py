"""Stopping criteria of searches, made once for each mission that is planned and handed down to all that search."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field
from threading import Event
from typing import Protocol

from mrta_zoo.errors import ConfigError

LOOKS = 100
"""A search looks at the clock at least about this often before its time is up."""


class StoppingCriterion(Protocol):
    """Says when a search ends. The search asks between iterations."""

    def progress(self, done: int, idle: int = 0) -> float:
        """How much of the search is over: 0 at its beginning, 1 or more at its end.

        Args:
            done: iterations so far.
            idle: iterations since the last improvement.
        """
        ...

    def next_look(self, done: int, progress: float) -> float:
        """How many iterations to do before asking again, >= 1 while `progress` is less than 1.

        Args:
            done: iterations so far.
            progress: what `progress` gave last.
        """
        ...


@dataclass(frozen=True, slots=True)
class MaxIterations:
    """Ends after `count` iterations, >= 1."""

    count: int

    def progress(self, done: int, idle: int = 0) -> float:
        return done / self.count

    def next_look(self, done: int, progress: float) -> float:
        return self.count - done


@dataclass(frozen=True, slots=True)
class NoImprovement:
    """Ends after `count` iterations in a row without an improvement, >= 1."""

    count: int

    def progress(self, done: int, idle: int = 0) -> float:
        return idle / self.count

    def next_look(self, done: int, progress: float) -> float:
        return max(1.0, self.count * (1.0 - progress))


class OutOfTimeError(Exception):
    """The time is up before there is a plan."""


@dataclass(frozen=True, slots=True)
class TimeLimit:
    """Ends at a moment. Both moments are by `time.perf_counter`.

    Attributes:
        begin: when the search began.
        end: when it ends.
    """

    begin: float
    end: float

    @classmethod
    def of(cls, seconds: float) -> TimeLimit:
        """From now on, for this many seconds."""
        now = time.perf_counter()
        return cls(now, now + seconds)

    def first(self, share: float) -> TimeLimit:
        """The first part of it, as long as this share of the whole."""
        return TimeLimit(self.begin, self.begin + share * (self.end - self.begin))

    def rest(self) -> TimeLimit:
        """From now on until the same end."""
        return TimeLimit(time.perf_counter(), self.end)

    def spent(self) -> float:
        """Seconds since it began."""
        return time.perf_counter() - self.begin

    def left(self) -> float:
        """Seconds until the end, 0 after it."""
        return max(0.0, self.end - time.perf_counter())

    @property
    def over(self) -> bool:
        """Whether the time is up."""
        return time.perf_counter() >= self.end

    def check(self) -> None:
        """Raise OutOfTimeError if the time is up."""
        if self.over:
            raise OutOfTimeError

    def progress(self, done: int, idle: int = 0) -> float:
        now = time.perf_counter()
        return (now - self.begin) / (self.end - self.begin) if now < self.end else 1.0

    def next_look(self, done: int, progress: float) -> float:
        return 1.0 + (done * min(1.0 / LOOKS, 1.0 - progress) / progress if progress > 0.0 else 0.0)


@dataclass(frozen=True, slots=True)
class Cancellation:
    """Ends the search once `cancel` is called, from any thread."""

    _cancelled: Event = field(default_factory=Event)

    def cancel(self) -> None:
        """End the search soon."""
        self._cancelled.set()

    def progress(self, done: int, idle: int = 0) -> float:
        return float(self._cancelled.is_set())

    def next_look(self, done: int, progress: float) -> float:
        return math.inf


@dataclass(frozen=True, slots=True)
class FirstOf:
    """Ends when the first of several criteria, one at least, ends the search."""

    criteria: tuple[StoppingCriterion, ...]

    def progress(self, done: int, idle: int = 0) -> float:
        return max(each.progress(done, idle) for each in self.criteria)

    def next_look(self, done: int, progress: float) -> float:
        return min(each.next_look(done, progress) for each in self.criteria)


def check_budget(budget: float) -> None:
    """Check a number of seconds for planning a mission.

    Raises:
        ConfigError: if it is not finite or not > 0.
    """
    if not 0 < budget < math.inf:
        raise ConfigError(f"budget is {budget:g}; expected a number of seconds > 0")
