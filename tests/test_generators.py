"""Generators: bounds, distributions, determinism, and errors of their configuration."""

import pickle
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest

from mrta_zoo import Scenario
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import GENERATORS, MixtureGenerator, TaptcGenerator, UniformGenerator, make_generator


def draw(generator: Any, count: int, seed: int = 0) -> list[Scenario]:
    rng = np.random.default_rng(seed)
    return [generator(rng) for _ in range(count)]


def pooled(scenarios: list[Scenario], attribute: str) -> np.ndarray[Any, np.dtype[np.float64]]:
    return np.concatenate([getattr(scenario, attribute) for scenario in scenarios])


@pytest.mark.parametrize("name", GENERATORS)
def test_same_seed_same_scenarios(name: str) -> None:
    generator = make_generator(name)
    assert draw(generator, 20) == draw(generator, 20)
    assert draw(generator, 20) != draw(generator, 20, seed=1)
    assert draw(pickle.loads(pickle.dumps(generator)), 5) == draw(generator, 5)
    assert hash(generator) == hash(make_generator(name))


@pytest.mark.parametrize("name", GENERATORS)
def test_uses_no_other_randomness(name: str) -> None:
    np.random.seed(0)  # noqa: NPY002 the global one must not matter
    first = draw(make_generator(name), 5)
    np.random.seed(1)  # noqa: NPY002
    assert draw(make_generator(name), 5) == first


@pytest.mark.parametrize("name", GENERATORS)
def test_name_is_given_to_the_scenario(name: str) -> None:
    generator = make_generator(name)
    assert generator(np.random.default_rng(0), "mine").name == "mine"
    assert generator(np.random.default_rng(0), name="mine").name == "mine"


def test_uniform_follows_the_paper() -> None:
    scenarios = draw(UniformGenerator(), 400)
    assert {scenario.num_tasks for scenario in scenarios} == {100}
    assert {scenario.num_robots for scenario in scenarios} == {2, 3, 4, 5, 6, 7}
    for attribute, low, high, unit in (
        ("deadline", 50, 600, 1), ("workload", 10, 30, 1), ("capacity", 1, 3, 5), ("task_xy", 0, 100, 1),
        ("robot_xy", 0, 100, 5),
    ):  # fmt: skip
        values = pooled(scenarios, attribute)
        width = high - low
        assert low <= values.min() < low + 0.01 * width
        assert high - 0.01 * width < values.max() <= high
        assert values.mean() == pytest.approx((low + high) / 2, abs=0.006 * unit * width)
        assert values.std() == pytest.approx(width / np.sqrt(12), abs=0.006 * unit * width)
    assert set(pooled(scenarios, "speed")) == {1}


def test_uniform_takes_every_bound() -> None:
    generator = UniformGenerator(
        tasks=(1, 3), robots=(1, 2), deadline=(5, 6), workload=(0, 0), capacity=(2, 2), speed=(3, 4),
        map_size=(7, 9),
    )  # fmt: skip
    scenarios = draw(generator, 100)
    assert {scenario.num_tasks for scenario in scenarios} == {1, 2, 3}
    assert {scenario.num_robots for scenario in scenarios} == {1, 2}
    assert {scenario.map_size for scenario in scenarios} == {(7, 9)}
    assert set(pooled(scenarios, "workload")) == {0}
    assert set(pooled(scenarios, "capacity")) == {2}
    speeds, places = pooled(scenarios, "speed"), pooled(scenarios, "task_xy")
    assert speeds.min() >= 3
    assert 3.9 < speeds.max() <= 4
    assert 6.5 < places[:, 0].max() <= 7
    assert 8.5 < places[:, 1].max() <= 9


@pytest.mark.parametrize(("group", "factor"), [("tight", 1), ("slack", 2)])
@pytest.mark.parametrize("share", [0.25, 0.5, 0.75, 1.0])
def test_taptc_deadlines(group: Any, factor: int, share: float) -> None:
    # All latest deadlines equal, so that the normal part can be told apart: D = 250 * factor.
    generator = TaptcGenerator(group=group, normal_share=(share,), latest=(250, 250))
    latest = 250 * factor
    deadlines = np.array([scenario.deadline for scenario in draw(generator, 400)])
    assert np.array_equal(deadlines, np.rint(deadlines))
    assert deadlines.max() == latest
    assert deadlines.min() >= 30
    drawn = deadlines[deadlines < latest]
    # A drawn deadline may round up to D, so the share is met up to a few in a thousand.
    assert len(drawn) / deadlines.size == pytest.approx(share, abs=0.005)
    # mean (100 + D) / 2 and deviation (D - 100) / 5.5, both a little less for the missing upper tail
    assert drawn.mean() == pytest.approx((100 + latest) / 2, rel=0.01)
    assert drawn.std() == pytest.approx((latest - 100) / 5.5, rel=0.04)
    # Which tasks are the drawn ones says nothing: every position is drawn about as often.
    positions = (deadlines < latest).mean(axis=0)
    assert positions.std() < 0.04


def test_taptc_follows_the_published_cases() -> None:
    scenarios = draw(TaptcGenerator(), 300)
    assert set(pooled(scenarios, "workload")) == {20}
    assert set(pooled(scenarios, "speed")) == {1}
    places = pooled(scenarios, "task_xy")
    assert sorted(set(places.ravel())) == list(range(100))
    for scenario in scenarios:
        half = scenario.num_robots // 2
        assert scenario.capacity.tolist() == [2] * half + [1] * (scenario.num_robots - half)
    latest = np.array([scenario.deadline.max() for scenario in scenarios])
    # Half tight (up to 300), half slack (up to 600).
    assert np.mean(latest <= 300) == pytest.approx(0.5, abs=0.1)
    assert latest.max() <= 600


def test_taptc_like_the_double_size_cases() -> None:
    generator = TaptcGenerator(tasks=200, robots=14, group="tight", latest=230, capacity="random", integer=False)  # type: ignore[arg-type]
    scenarios = draw(generator, 200)
    capacities = pooled(scenarios, "capacity")
    assert set(capacities) == {1, 2}
    assert capacities.mean() == pytest.approx(1.5, abs=0.05)
    assert len({tuple(scenario.capacity) for scenario in scenarios}) > 100
    assert all(scenario.num_tasks == 200 and scenario.deadline.max() <= 230 for scenario in scenarios)
    places = pooled(scenarios, "task_xy")
    assert not np.array_equal(places, np.rint(places))


def test_redrawing_ends_even_for_narrow_windows() -> None:
    generator = TaptcGenerator(latest=(100.4, 100.4), low=98, min_deadline=98.5, spread=1, slack_factor=1)
    with pytest.raises(ConfigError, match=r"min_deadline is 99\.5; expected at most 99"):
        replace(generator, min_deadline=99.5)
    assert set(pooled(draw(generator, 20), "deadline")) == {99, 100}


def test_mixture_follows_its_weights() -> None:
    parts = tuple(UniformGenerator(tasks=(n, n)) for n in (1, 2, 3))
    counts = [
        [scenario.num_tasks for scenario in draw(MixtureGenerator(parts, weights), 600)]
        for weights in ((), (1, 0, 3), (0, 1, 0))
    ]
    assert [counts[0].count(n) / 600 for n in (1, 2, 3)] == pytest.approx([1 / 3] * 3, abs=0.06)
    assert [counts[1].count(n) / 600 for n in (1, 2, 3)] == pytest.approx([0.25, 0, 0.75], abs=0.06)
    assert counts[2] == [2] * 600


def test_single_numbers_and_lists_stand_for_ranges() -> None:
    generator = make_generator("uniform", tasks=5, robots=[2, 3], map_size=50)
    assert generator == UniformGenerator(tasks=(5, 5), robots=(2, 3), map_size=(50.0, 50.0))
    assert make_generator("taptc", normal_share=1) == TaptcGenerator(normal_share=(1.0,))


def test_unknown_names() -> None:
    with pytest.raises(ConfigError, match="no generator 'unifrom'; expected one of uniform, taptc, mixture"):
        make_generator("unifrom")
    with pytest.raises(ConfigError, match="generator 'uniform' has no field 'n_tasks'; it has tasks, robots"):
        make_generator("uniform", n_tasks=3)


NAN, INF = float("nan"), float("inf")
BAD = [
    *product(["uniform", "taptc"], ["tasks", "robots"], [0, -1, (3, 2), 2.5, "5", (1, 2, 3), None, NAN]),
    *product(["uniform"], ["deadline", "capacity", "speed", "map_size"], [0, (-1, 1), INF, NAN, "x", ()]),
    *product(["uniform"], ["deadline", "workload", "capacity", "speed"], [(2, 1), (1, INF)]),
    ("uniform", "workload", (-1, 2)),
    ("taptc", "group", "loose"),
    ("taptc", "group", []),
    ("taptc", "capacity", 2),
    *product(["taptc"], ["normal_share"], [(), 1.5, (0.5, -0.1), "half", (NAN,)]),
    *product(["taptc"], ["latest", "slack_factor", "spread", "min_deadline"], [0, -1, NAN, INF, "x"]),
    ("taptc", "spread", 0.5),
    ("taptc", "workload", -1),
    ("taptc", "low", 250),
    ("taptc", "low", -1),
    ("taptc", "min_deadline", 180),
    ("taptc", "map_size", 0.5),
    ("mixture", "generators", ()),
    ("mixture", "generators", ("uniform",)),
    *product(["mixture"], ["weights"], [(1,), (0, 0), (1, -1), (1, NAN)]),
]  # fmt: skip


@pytest.mark.parametrize(("name", "field", "value"), BAD)
def test_bad_fields(name: str, field: str, value: object) -> None:
    with pytest.raises(ConfigError, match=f"^{field} (is|has) .*expected|^{field} is .*need") as caught:
        make_generator(name, **{field: value})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("value", [1_000_001, (1, 1e10)])
def test_counts_have_a_greatest(value: object) -> None:
    with pytest.raises(ConfigError, match=r"expected .*whole numbers from 1 to 1000000"):
        make_generator("taptc", tasks=value)
    assert make_generator("taptc", tasks=1_000_000) is not None
    with pytest.raises(ConfigError, match=r"robots is 1000.*expected"):
        make_generator("uniform", robots=10**400)
