"""Means with intervals and paired tests, against values worked out by hand and against their definitions."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mrta_zoo.eval.significance import ALL_EQUAL, SAME_DIFFERENCE, TOO_FEW, estimate_mean, holm, paired_test


def test_paired_test_by_hand() -> None:
    # Differences 1, 2, 3, 4, 5: mean 3, standard deviation sqrt(10 / 4) = 1.5811.
    # d_z = 3 / 1.5811 = 1.8974; t = 1.8974 * sqrt(5) = 4.2426 with 4 degrees of freedom, two-sided p = 0.01324.
    # All five ranks positive: 1 of 2^5 = 32 sign patterns at either end, p = 2 / 32 = 0.0625.
    found = paired_test([11, 22, 33, 44, 55], [10, 20, 30, 40, 50], seed=0)
    assert found.difference.mean == 3
    assert found.effect == pytest.approx(3 / math.sqrt(2.5))
    assert found.t_p == pytest.approx(0.01324, abs=1e-5)
    assert found.wilcoxon_p == pytest.approx(0.0625)
    assert (found.wins, found.ties, found.losses, found.note) == (5, 0, 0, "")


def test_turning_the_pair_round_turns_the_signs_round() -> None:
    rng = np.random.default_rng(1)
    one, other = rng.normal(50, 5, 30), rng.normal(52, 5, 30)
    there, back = paired_test(one, other, seed=0), paired_test(other, one, seed=0)
    assert there.t_p == pytest.approx(back.t_p)
    assert there.wilcoxon_p == pytest.approx(back.wilcoxon_p)
    assert there.effect == pytest.approx(-back.effect)  # type: ignore[operator]
    assert (there.wins, there.losses) == (back.losses, back.wins)


def test_interval_of_a_mean_is_about_two_standard_errors() -> None:
    values = np.random.default_rng(2).normal(60, 10, 200)
    found = estimate_mean(values, seed=0)
    # Large and normal: mean ± 1.96 standard errors, to within the bootstrap's own noise.
    error = values.std(ddof=1) / math.sqrt(200)
    assert found.mean == pytest.approx(values.mean())
    assert found.low == pytest.approx(values.mean() - 1.96 * error, abs=0.15 * error)
    assert found.high == pytest.approx(values.mean() + 1.96 * error, abs=0.15 * error)
    assert estimate_mean(values, seed=0) == found


def test_four_values_are_too_few_for_an_interval() -> None:
    found = estimate_mean([1, 2, 3, 6], seed=0)
    assert (found.mean, found.low, found.high, found.note) == (3, None, None, TOO_FEW)
    assert estimate_mean([1, 2, 3, 6, 8], seed=0).low is not None


def test_groups_are_no_chance() -> None:
    # 10 % with 2 robots and 90 % with 7, in every case: the mean of 50 % is certain for this design.
    values = [10.0] * 10 + [90.0] * 10
    found = estimate_mean(values, 0, [2] * 10 + [7] * 10)
    assert (found.mean, found.low, found.high, found.note) == (50, 50, 50, "")
    wide = estimate_mean(values, 0)
    assert wide.low is not None
    assert wide.low < 35
    # A group of two is too small to resample within, so all are resampled together.
    pooled = estimate_mean(values, 0, [2] * 18 + [7] * 2)
    assert pooled == wide


@pytest.mark.parametrize(
    ("one", "other", "note"),
    [
        ([1, 2], [2, 3], TOO_FEW),
        ([5.0] * 8, [5.0] * 8, ALL_EQUAL),
        ([0.1 + 0.2] * 8, [0.3] * 8, ALL_EQUAL),  # equal but for rounding
        ([3, 4, 5, 6, 7], [1, 2, 3, 4, 5], SAME_DIFFERENCE),
    ],
)
def test_what_cannot_be_tested_says_so(one: list[float], other: list[float], note: str) -> None:
    found = paired_test(one, other, seed=0)
    assert found.note == note
    assert found.t_p is None
    assert found.effect is None
    for value in (found.difference.low, found.difference.high, found.wilcoxon_p):
        assert value is None or math.isfinite(value)


@pytest.mark.parametrize("seed", range(40))
def test_nothing_is_ever_nan(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 12))
    one = rng.integers(0, 3, n).astype(float)
    other = np.where(rng.random(n) < 0.7, one, one + rng.integers(-1, 2, n))
    found = paired_test(one, other, seed=0, strata=rng.integers(0, 2, n).tolist())
    numbers = (
        found.difference.mean, found.difference.low, found.difference.high, found.t_p, found.wilcoxon_p,
        found.effect,
    )  # fmt: skip
    assert all(value is None or math.isfinite(value) for value in numbers)
    assert (found.t_p is None) == bool(found.note)


def test_holm_by_hand() -> None:
    # Sorted 0.01, 0.03, 0.04: times 3, 2, 1 gives 0.03, 0.06, 0.04; never falling: 0.03, 0.06, 0.06.
    assert holm([0.04, None, 0.01, 0.03]) == pytest.approx([0.06, None, 0.03, 0.06])
    assert holm([None]) == [None]
    assert holm([]) == []
