"""`BatchMission.step(where=)` and `retire`: missions that wait, and robots that give up, on many random scenarios."""

from __future__ import annotations

from typing import get_args

import numpy as np
import pytest
import torch
from strategies import seeded_chooser, seeded_scenarios

from mrta_zoo.batch import BatchMission
from mrta_zoo.mission import Mission
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.verify import verify

RULES = get_args(MaskRule)


@pytest.mark.parametrize("rule", RULES)
def test_missions_that_take_turns_are_as_if_alone(rule: MaskRule) -> None:
    cases = seeded_scenarios(40, 150)
    batch, rng = BatchMission(ScenarioBatch.of(cases), rule), np.random.default_rng(0)
    missions, choosers = [Mission(case, rule) for case in cases], [seeded_chooser(b) for b in range(len(cases))]
    while not batch.done.all():
        where = rng.random(len(cases)) < 0.5
        choice = torch.zeros(len(cases), dtype=torch.int64)
        for b in np.flatnonzero(where & ~batch.done.numpy()):
            choice[b] = choosers[b](missions[b].mask(missions[b].actor))
            missions[b].assign(int(choice[b]))
        batch.step(choice, torch.from_numpy(where))
        assert batch.actor.tolist() == [mission.actor for mission in missions]
        assert batch.time.tolist() == [mission.time for mission in missions]
    for b, (mission, plan) in enumerate(zip(missions, batch.plans(), strict=True)):
        n, m = mission.scenario.num_tasks, mission.scenario.num_robots
        assert [list(route) for route in plan.routes] == mission.routes
        assert batch.ready[b, :m].tolist() == mission.ready
        assert batch.retired[b, :m].tolist() == mission.retired
        assert (batch.finish_if[b, :m, :n].numpy() == mission.finish_if).all()
        assert int(batch.completed()[b]) == mission.completed()


@pytest.mark.parametrize("rule", RULES)
def test_robots_that_give_up_at_random(rule: MaskRule) -> None:
    """A robot that gives up is never asked again, everyone else goes on by the rules, and the scores are right."""
    cases = seeded_scenarios(41, 150)
    batch, rng = BatchMission(ScenarioBatch.of(cases), rule), np.random.default_rng(1)
    choosers = [seeded_chooser(b) for b in range(len(cases))]
    gave_up: list[set[int]] = [set() for _ in cases]
    while not batch.done.all():
        leaves = torch.from_numpy(rng.random(len(cases)) < 0.2) & ~batch.done
        for b in leaves.nonzero().flatten().tolist():
            gave_up[b].add(int(batch.actor[b]))
        batch.retire(leaves)
        live = ~batch.done & ~leaves
        choice, masks = torch.zeros(len(cases), dtype=torch.int64), batch.mask().numpy()
        for b, actor in enumerate(batch.actor.tolist()):
            if actor < 0:
                continue
            assert actor not in gave_up[b]
            # Of those who have not given up and have a choice, the first to be free, then the lowest number.
            waiting = [
                (float(batch.ready[b, robot]), robot)
                for robot in range(cases[b].num_robots)
                if robot not in gave_up[b] and _may(rule, batch, b, robot)
            ]
            assert (float(batch.time[b]), actor) == min(waiting)
            assert masks[b].any()
            if live[b]:
                choice[b] = choosers[b](masks[b])
        batch.step(choice, where=live)
    assert sum(map(len, gave_up)) > 50
    assert batch.retired.all()
    for b, plan in enumerate(batch.plans()):
        score = verify(cases[b], plan)
        assert int(batch.completed()[b]) == score.completed
        assert float(batch.time[b]) == score.makespan
        assert float(batch.cost()[b]) == pytest.approx(score.cost, rel=1e-9, abs=0)


def _may(rule: MaskRule, batch: BatchMission, b: int, robot: int) -> bool:
    """Whether the rule leaves the robot any task, restated."""
    free = batch.untaken[b]
    deadline, finish, ready = batch.scenarios.deadline[b], batch.finish_if[b, robot], batch.ready[b, robot]
    in_time = {"feasible": finish <= deadline, "active": ready <= deadline, "unvisited": free}[rule]
    return bool((free & in_time).any())
