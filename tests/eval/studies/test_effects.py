"""Differences between variants, by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from mrta_zoo.eval.significance import ALL_EQUAL, TOO_FEW, Estimate
from mrta_zoo.eval.studies.effects import Effect, arrange, effect_of, run_values
from mrta_zoo.eval.studies.rows import RunRow


def rows(variant: str, seed: int, completed: dict[int, list[int]]) -> list[RunRow]:
    """Rows of a run on scenarios with 10 tasks, by number of robots."""
    return [
        RunRow(variant, seed, "taptc", robots, index, count, 10)
        for robots, counts in completed.items()
        for index, count in enumerate(counts)
    ]


EQUAL = {1: 0.5, 2: 0.5}
# By hand, in %: run means with one robot and with two, and their mean.
ROWS = [
    *rows("a", 0, {1: [2, 4], 2: [6, 8]}),  # 30, 70: 50
    *rows("a", 1, {1: [4, 6], 2: [6, 8]}),  # 50, 70: 60
    *rows("b", 0, {1: [1, 2], 2: [5, 6]}),  # 15, 55: 35
    *rows("b", 1, {1: [2, 3], 2: [6, 7]}),  # 25, 65: 45
    *rows("c", 0, {1: [5, 5], 2: [5, 5]}),  # 50, 50: 50
    *rows("c", 1, {1: [5, 5], 2: [9, 9]}),  # 50, 90: 70
]
RUNS = {name: of for (name, _), of in arrange(ROWS).items()}


def test_rows_become_percentages_by_scenario() -> None:
    assert {robots: values.tolist() for robots, values in RUNS["a"][1].items()} == {1: [40, 60], 2: [60, 80]}
    assert {robots: v.tolist() for robots, v in arrange(reversed(ROWS))["a", "taptc"][1].items()} == {
        1: [40, 60], 2: [60, 80],
    }  # fmt: skip
    assert run_values(RUNS["a"], EQUAL) == pytest.approx([50, 60])
    assert run_values(RUNS["b"], {1: 1.0, 2: -1.0}) == pytest.approx([-40, -40])


def test_a_difference_with_its_interval() -> None:
    effect = effect_of(RUNS, {"a": 1.0, "b": -1.0}, EQUAL)
    # Means 55 and 40: 15. Runs: (50, 60), (35, 45), (50, 70) scatter by 2·5² + 2·5² + 2·10² = 300 with 3 degrees of
    # freedom: s² = 100. Two runs each: 100 · (1/2 + 1/2) = 100.
    # Scenarios, runs averaged: one robot 30 − 15, 50 − 25 = 15, 25, variance 50; two robots 60 − 55, 80 − 65 = 5, 15,
    # variance 50. Each weighs 0.5² · 50/2 = 6.25, with 1 degree of freedom.
    # Together 112.5; degrees of freedom 112.5² / (100²/3 + 6.25² + 6.25²) = 12656.25 / 3411.458 = 3.70992.
    error, freedom = 112.5**0.5, 12656.25 / (10000 / 3 + 78.125)
    half = stats.t.ppf(0.975, freedom) * error
    assert effect.difference.mean == pytest.approx(15)
    assert effect.difference.n == 4
    assert (effect.runs_error, effect.scenarios_error) == pytest.approx((10, 12.5**0.5))
    assert effect.freedom == pytest.approx(freedom) == pytest.approx(3.70992, abs=1e-4)
    assert (effect.difference.low, effect.difference.high) == pytest.approx((15 - half, 15 + half))
    assert effect.p == pytest.approx(2 * stats.t.sf(15 / error, freedom))
    # t with 3.7 degrees of freedom is near 2.9, so ± 30: two seeds do not show that 15 points are there.
    assert effect.difference.low == pytest.approx(-15.4, abs=0.3)
    assert effect.p > 0.2


def test_a_contrast_of_three_variants_and_of_robots() -> None:
    # (55 + 60) / 2 − 40 = 17.5; Σ c²/n = (0.25 + 0.25 + 1) / 2 = 0.75, so runs weigh 75.
    effect = effect_of(RUNS, {"a": 0.5, "c": 0.5, "b": -1.0}, EQUAL)
    assert effect.difference.mean == pytest.approx(17.5)
    assert effect.runs_error == pytest.approx(75**0.5)
    # One robot: 40 − 20 = 20; two: 70 − 60 = 10; the gap is 10 larger with one. Runs, one minus two:
    # a −40, −20; b −40, −40; c 0, −40: scatter 200 + 0 + 800 = 1000 over 3.
    gap = effect_of(RUNS, {"a": 1.0, "b": -1.0}, {1: 1.0, 2: -1.0})
    assert gap.difference.mean == pytest.approx(10)
    assert gap.runs_error == pytest.approx((1000 / 3) ** 0.5)


def test_more_variants_say_more_about_how_runs_scatter() -> None:
    alone = effect_of({name: RUNS[name] for name in "ab"}, {"a": 1.0, "b": -1.0}, EQUAL)
    # s² = (50 + 50) / 2 = 50, with 2 degrees of freedom; 50 + 12.5 = 62.5 together.
    assert alone.runs_error == pytest.approx(50**0.5)
    assert alone.freedom == pytest.approx(62.5**2 / (2500 / 2 + 2 * 6.25**2))


def test_variants_that_scatter_otherwise_are_not_pooled() -> None:
    kinds = {"a": "x", "b": "x", "c": "y"}
    # a and b: s² = (50 + 50) / 2 = 50 with 2 degrees of freedom; c: s² = 200 with 1. 50/2 + 200/2 = 125 for c − a.
    # Scenarios, runs averaged, c − a: one robot 20, 0, variance 200; two robots 10, −10, variance 200; each 0.25 · 100.
    effect = effect_of(RUNS, {"c": 1.0, "a": -1.0}, EQUAL, kinds)
    assert effect.runs_error == pytest.approx(125**0.5)
    assert effect.freedom == pytest.approx(175**2 / (25**2 / 2 + 100**2 / 1 + 25**2 + 25**2))
    # Where c has no part, its scatter counts for nothing.
    alone = effect_of({name: RUNS[name] for name in "ab"}, {"a": 1.0, "b": -1.0}, EQUAL)
    assert effect_of(RUNS, {"a": 1.0, "b": -1.0}, EQUAL, kinds) == alone
    # One run of c: nobody knows how much runs like it scatter.
    few = {**RUNS, "c": {0: RUNS["c"][0]}}
    assert effect_of(few, {"c": 1.0, "a": -1.0}, EQUAL, kinds).difference.note == TOO_FEW


def test_intervals_from_two_seeds_hold_the_true_difference_as_often_as_they_say() -> None:
    rng, held = np.random.default_rng(0), 0
    for _ in range(300):
        # No difference but by chance: of scenarios for each variant (4 points), of runs (1), and of both (4).
        pool = {}
        for name in "abc":
            of_scenarios = rng.normal(0, 4, (2, 16))
            pool[name] = {
                seed: dict(zip((1, 2), of_scenarios + rng.normal(0, 1) + rng.normal(0, 4, (2, 16)), strict=True))
                for seed in (0, 1)
            }
        difference = effect_of(pool, {"a": 1.0, "b": -1.0}, EQUAL).difference
        assert difference.low is not None
        assert difference.high is not None
        held += difference.low <= 0 <= difference.high
    # 95 % of 300 is 285; the standard deviation is 3.8.
    assert 274 <= held <= 298


def test_one_run_has_no_interval_and_equal_runs_no_width() -> None:
    single = {name: {0: runs[0]} for name, runs in RUNS.items()}
    effect = effect_of(single, {"a": 1.0, "b": -1.0}, EQUAL)
    assert effect == Effect(difference=Estimate(15.0, None, None, 2, TOO_FEW))
    same = {"a": {0: RUNS["c"][0], 1: RUNS["c"][0]}, "b": {0: RUNS["c"][0], 1: RUNS["c"][0]}}
    assert effect_of(same, {"a": 1.0, "b": -1.0}, EQUAL).difference == Estimate(0, 0, 0, 4, ALL_EQUAL)
