"""When searches end."""

from __future__ import annotations

import math

import pytest

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.stop import (
    LOOKS,
    Cancellation,
    FirstOf,
    MaxIterations,
    NoImprovement,
    StoppingCriterion,
    TimeLimit,
    check_budget,
)


class Clock:
    """Tells the time that a test says."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr("time.perf_counter", clock)
    return clock


def test_iterations() -> None:
    stop = MaxIterations(8)
    assert [stop.progress(done) for done in (0, 2, 8)] == [0.0, 0.25, 1.0]
    assert stop.next_look(2, 0.25) == 6


def test_iterations_without_improvement() -> None:
    stop = NoImprovement(8)
    assert [stop.progress(100, idle) for idle in (0, 6, 9)] == [0.0, 0.75, 1.125]
    assert stop.next_look(100, 0.75) == 2


def test_time(clock: Clock) -> None:
    limit = TimeLimit.of(8.0)
    assert (limit, limit.left(), limit.spent(), limit.over) == (TimeLimit(100.0, 108.0), 8.0, 0.0, False)
    assert limit.progress(0) == 0.0
    clock.now = 102.0
    assert (limit.left(), limit.spent(), limit.progress(5)) == (6.0, 2.0, 0.25)
    assert limit.first(0.5) == TimeLimit(100.0, 104.0)
    assert limit.rest() == TimeLimit(102.0, 108.0)
    clock.now = 109.0
    assert (limit.left(), limit.over, limit.progress(5)) == (0.0, True, 1.0)
    assert limit.rest().progress(0) == 1.0


def test_a_search_looks_at_the_clock_often_enough() -> None:
    limit = TimeLimit(0.0, 1.0)
    assert limit.next_look(0, 0.0) == limit.next_look(0, 0.1) == limit.next_look(3, 0.0) == 1.0  # the pace is unknown
    assert limit.next_look(1000, 0.5) == pytest.approx(1 + 2000 / LOOKS)
    assert limit.next_look(1000, 0.999) == pytest.approx(1 + 1000 * 0.001 / 0.999)  # not far beyond the end


def test_the_first_of_several_ends_the_search(clock: Clock) -> None:
    cancellation = Cancellation()
    stop: StoppingCriterion = FirstOf((MaxIterations(10), TimeLimit.of(8.0), cancellation))
    clock.now = 104.0
    assert (stop.progress(1), stop.progress(6)) == (0.5, 0.6)
    assert stop.next_look(6, 0.6) == pytest.approx(1 + 6 / 0.6 / LOOKS)
    assert cancellation.next_look(6, 0.6) == math.inf
    cancellation.cancel()
    assert stop.progress(1) == 1.0


@pytest.mark.parametrize("budget", [0.0, -1.0, math.inf, math.nan])
def test_budgets(budget: float) -> None:
    with pytest.raises(ConfigError, match=r"budget is .*; expected a number of seconds > 0"):
        check_budget(budget)
