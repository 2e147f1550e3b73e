"""Means with bootstrap intervals and paired tests, all computed by SciPy and statsmodels.

What cannot be said is said so, in a note, instead of a NaN: fewer than `LEAST` values, or values that are all equal.
"""

from __future__ import annotations

import warnings
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import stats
from statsmodels.stats.multitest import multipletests

Values = npt.NDArray[np.float64]

LEVEL = 0.95
"""Of all confidence intervals."""
SIGNIFICANT = 0.05
"""Adjusted p-values below it are called significant."""
LEAST = 5
"""Values that an interval or a test needs."""
LEAST_OF_STRATUM = 3
"""Values that every group needs for resampling within groups."""
RESAMPLES = 9999
DIGITS = 9
"""Decimals of a difference that count; what is beyond is rounding of the computer's."""

TOO_FEW, ALL_EQUAL, SAME_DIFFERENCE = "too few", "all equal", "same difference in every case"


@dataclass(frozen=True, slots=True)
class Estimate:
    """A mean with its interval.

    Attributes:
        mean: of the values, in their unit.
        low: lower end of the interval, None if there are too few values.
        high: upper end.
        n: number of values.
        note: `TOO_FEW`, `ALL_EQUAL` or empty.
    """

    mean: float
    low: float | None
    high: float | None
    n: int
    note: str = ""

    def columns(self, mean: str) -> dict[str, float | None]:
        """Mean, low and high, as columns of a table; the mean under this name."""
        return {mean: self.mean, "low": self.low, "high": self.high}


@dataclass(frozen=True, slots=True)
class PairedTest:
    """How two methods differ on the same cases. What does not apply is None, and the note says why.

    Attributes:
        difference: mean of first minus second, in their unit, with its interval.
        t_p: p-value of the paired t-test, two-sided.
        wilcoxon_p: p-value of the Wilcoxon signed-rank test, two-sided, equal cases dropped.
        effect: Cohen's d_z, the mean difference in standard deviations of the differences.
        wins: cases in which the first is ahead.
        losses: cases in which the second is ahead.
        note: `TOO_FEW`, `ALL_EQUAL`, `SAME_DIFFERENCE` or empty.
    """

    difference: Estimate
    t_p: float | None
    wilcoxon_p: float | None
    effect: float | None
    wins: int
    losses: int
    note: str = ""

    @property
    def ties(self) -> int:
        """Cases in which they are equal."""
        return self.difference.n - self.wins - self.losses


def estimate_mean(values: Sequence[float] | Values, seed: int, strata: Sequence[Hashable] | None = None) -> Estimate:
    """A mean with its bootstrap interval, bias-corrected and accelerated (BCa).

    Args:
        values: one for each case, at least one.
        seed: of the resampling.
        strata: group of each value, such as the case's number of robots, which is part of the design and no chance:
            resampling stays within groups. Left aside if a group has fewer than `LEAST_OF_STRATUM` values.
    """
    array = np.asarray(values, dtype=float)
    mean = float(array.mean())
    if len(array) < LEAST:
        return Estimate(mean, None, None, len(array), TOO_FEW)
    groups = _split(array, strata)
    if all(np.ptp(group) == 0 for group in groups):
        return Estimate(mean, mean, mean, len(array), ALL_EQUAL if np.ptp(array) == 0 else "")

    def mean_of(*samples: Values, axis: int) -> Any:
        return np.concatenate(samples, axis=axis).mean(axis=axis)

    for method in ("BCa", "percentile"):  # BCa has no answer when resamples hardly differ
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", stats.DegenerateDataWarning)
            found = stats.bootstrap(
                groups, mean_of, vectorized=True, n_resamples=RESAMPLES, confidence_level=LEVEL, method=method,
                random_state=np.random.default_rng(seed),
            ).confidence_interval  # fmt: skip
        if np.isfinite([found.low, found.high]).all():
            break
    return Estimate(mean, float(found.low), float(found.high), len(array))


def paired_test(
    first: Sequence[float] | Values,
    second: Sequence[float] | Values,
    seed: int,
    strata: Sequence[Hashable] | None = None,
) -> PairedTest:
    """Compare two methods on the same cases, in the same order.

    Args:
        first: one value for each case.
        second: the other method's.
        seed: of the bootstrap.
        strata: see `estimate_mean`; they count for the interval of the difference only.
    """
    one, other = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    differences = np.round(one - other, DIGITS) + 0.0
    n = len(differences)
    estimate = estimate_mean(differences, seed, strata)
    score = int(np.sum(differences > 0)), int(np.sum(differences < 0))
    if n < LEAST:
        return PairedTest(estimate, None, None, None, *score, TOO_FEW)
    if not differences.any():
        return PairedTest(estimate, None, None, None, *score, ALL_EQUAL)
    # It drops zeros itself, but of few pairs it then goes through all signs of all of them.
    wilcoxon_p = float(stats.wilcoxon(differences[differences != 0]).pvalue)
    if np.ptp(differences) == 0:  # no spread, so no t
        return PairedTest(estimate, None, wilcoxon_p, None, *score, SAME_DIFFERENCE)
    test = stats.ttest_rel(one, other)
    return PairedTest(estimate, float(test.pvalue), wilcoxon_p, float(test.statistic / np.sqrt(n)), *score)


def holm(p_values: Sequence[float | None]) -> list[float | None]:
    """p-values adjusted for their number by Holm's method; None, which is no test, stays None and does not count."""
    given = [p for p in p_values if p is not None]
    adjusted = iter(multipletests(given, method="holm")[1].tolist() if given else ())
    return [None if p is None else next(adjusted) for p in p_values]


def _split(values: Values, strata: Sequence[Hashable] | None) -> tuple[Values, ...]:
    if strata is None:
        return (values,)
    members: dict[Hashable, list[float]] = {}
    for value, stratum in zip(values.tolist(), strata, strict=True):
        members.setdefault(stratum, []).append(value)
    if min(map(len, members.values())) < LEAST_OF_STRATUM:
        return (values,)
    return tuple(map(np.asarray, members.values()))
