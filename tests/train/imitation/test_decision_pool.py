"""Decisions drawn from a pool are those of the plans, all of them, and equally often."""

from __future__ import annotations

from dataclasses import fields

import pytest
import torch
from strategies import seeded_scenarios

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.classical.local_search.eils import EilsConfig, EilsSolver
from mrta_zoo.policies.neural.capam.candidates import Candidates
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.rollout import Segment
from mrta_zoo.policies.neural.sharing import build_network
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.imitation.decision_pool import DecisionPool
from mrta_zoo.train.imitation.decisions import PlanBatch, follow
from mrta_zoo.train.imitation.experts import ExpertPlan, Routes

PLUS = NetworkConfig(embedding=8, heads=2, decoder="candidates", decision_layers=1, candidates=4, peers=1)
ATTENTION = NetworkConfig(embedding=8, heads=2)
CASES = seeded_scenarios(52, 30)


def routes_of(case: int) -> Routes:
    if case % 10 == 9:  # nothing to learn from
        return ((),) * CASES[case].num_robots
    return EilsSolver(config=EilsConfig(iterations_per_task=1, least_iterations=30)).solve(CASES[case]).routes


def followed(config: NetworkConfig) -> tuple[ScenarioBatch, list[Segment]]:
    network = build_network(config, "shared", 1, seed=0)
    batch = PlanBatch([ExpertPlan(case, routes_of(b)) for b, case in enumerate(CASES)], torch.device("cpu"))
    return batch.scenarios, follow(network, batch.scenarios, batch.routes)


def rows_of(scenarios: ScenarioBatch, segment: Segment) -> list[tuple[object, ...]]:
    """Each live decision as plain numbers, its scenario's included."""
    rows = []
    for row, q in segment.live.nonzero().tolist():
        tables = [getattr(segment.states, each.name)[row, q] for each in fields(DecisionStates)]
        if segment.features is not None:
            tables += [getattr(segment.features, each.name)[row, q] for each in fields(Candidates)]
        tables.append(scenarios.task_xy[segment.scenarios[row]])
        rows.append((int(segment.actions[row, q]), *(str(table.tolist()) for table in tables)))
    return rows


@pytest.mark.parametrize("config", [ATTENTION, PLUS], ids=["attention", "candidates"])
def test_draws_every_decision_and_no_other(config: NetworkConfig) -> None:
    scenarios, segments = followed(config)
    known = [row for segment in segments for row in rows_of(scenarios, segment)]
    pool = DecisionPool(scenarios, segments)
    assert int(pool.count.sum()) == len(pool.actions) == len(known) > 50
    assert pool.count[9] == pool.count[19] == pool.count[29] == 0
    drawn = rows_of(*pool.draw(500, 40, torch.Generator().manual_seed(0)))
    assert set(drawn) == set(known)


def test_plans_and_decisions_of_each_are_drawn_equally_often() -> None:
    scenarios, segments = followed(ATTENTION)
    pool = DecisionPool(scenarios, segments)
    of, drawn = pool.draw(6000, 8, torch.Generator().manual_seed(1))
    # Plans without decisions are drawn as often as others, and nothing of them is live.
    with_some = float((pool.count > 0).float().mean())
    assert with_some < 0.91
    assert float(drawn.live.all(1).float().mean()) == pytest.approx(with_some, abs=0.03)
    assert (drawn.live.all(1) == drawn.live.any(1)).all()
    # Of the plan with most decisions, each makes up its share of them.
    most = int(pool.count.argmax())
    same = (of.task_xy == scenarios.task_xy[most]).flatten(1).all(1)
    times = drawn.actions[same].flatten().bincount()
    assert (times > 0).sum() == pool.count[most]  # a plan does a task once
    assert times[times > 0].float().std() < 5 * times[times > 0].float().mean().sqrt()


def test_a_seed_gives_the_same_draw() -> None:
    scenarios, segments = followed(ATTENTION)
    pool = DecisionPool(scenarios, segments)
    first, again, other = (pool.draw(9, 5, torch.Generator().manual_seed(seed))[1].actions for seed in (4, 4, 5))
    assert torch.equal(first, again)
    assert not torch.equal(first, other)


def test_a_network_sees_what_it_saw_when_following() -> None:
    scenarios, segments = followed(PLUS)
    network = build_network(PLUS, "shared", 1, seed=3)
    of, drawn = DecisionPool(scenarios, segments).draw(40, 6, torch.Generator().manual_seed(2))
    encoding = network.encode(Tasks.of_batch(of))
    given = network(encoding, drawn.states, drawn.features)  # type: ignore[arg-type]
    anew = network(encoding, drawn.states)  # type: ignore[arg-type]
    live = drawn.live
    torch.testing.assert_close(given[live], anew[live])


def test_plans_without_any_decision_are_refused() -> None:
    batch = PlanBatch([ExpertPlan(CASES[9], routes_of(9))], torch.device("cpu"))
    segments = follow(build_network(ATTENTION, "shared", 1, seed=0), batch.scenarios, batch.routes)
    with pytest.raises(ConfigError, match="none of the plans to imitate has a task"):
        DecisionPool(batch.scenarios, segments)
