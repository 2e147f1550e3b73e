"""Scenarios of updates: the same whoever draw_inputs them, and the right ones wherever a run goes on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from itertools import islice
from multiprocessing import active_children

import pytest
import torch

from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.reinforce import Reinforce
from mrta_zoo.train.scenarios import UpdateInput, draw_input, draw_inputs

TINY = TrainConfig(
    network=NetworkConfig(embedding=8, heads=2), tasks=(10, 20), reference_tasks=10, min_robots=2, max_robots=3,
    generator="mixture", scenarios=2, samples=2, updates=3, device="cpu",
)  # fmt: skip


def same(one: UpdateInput, other: UpdateInput) -> bool:
    return (one.update, one.seed) == (other.update, other.seed) and all(
        torch.equal(getattr(one.scenarios, each.name), getattr(other.scenarios, each.name))
        for each in fields(ScenarioBatch)
        if each.name != "scales"
    )


def test_other_processes_draw_the_same_scenarios_and_are_missed_when_they_die() -> None:
    ahead: Iterator[UpdateInput] = draw_inputs(TINY, None, 1, workers=2)
    drawn = list(islice(ahead, 4))  # beyond the last update, too: a run may be made longer
    assert all(same(*each) for each in zip(drawn, draw_inputs(TINY, None, 1), strict=False))
    assert not same(drawn[0], drawn[1])
    for process in active_children():
        process.kill()
    with pytest.raises(ConfigError, match="a worker process was killed"):
        list(islice(ahead, 20))


def test_processes_end_when_nobody_wants_more() -> None:
    ahead = draw_inputs(TINY, None, 0, workers=1)
    next(ahead)
    (process,) = active_children()
    ahead.close()
    process.join(20)
    assert not process.is_alive()


def test_each_update_has_its_own_scenarios_whatever_came_before() -> None:
    run = Reinforce(TINY)
    for update in (0, 1, 1, 4, 2):  # as they come, after an update that failed, and resumed elsewhere
        run.update = update
        assert same(run._next_input(), draw_input(TINY, None, update))


def test_a_given_generator_draws_the_scenarios() -> None:
    generator = UniformGenerator(tasks=(7, 7), robots=(2, 2))
    scenarios = next(draw_inputs(TINY, generator, 0)).scenarios
    assert (len(scenarios), scenarios.num_tasks, scenarios.num_robots) == (2, 7, 2)
