"""`Mission`, `BatchMission` and `verify` mean the same, decision by decision, on thousands of scenarios.

`expected` states the rules once more, in plain Python on top of the verifier, so that a mistake in the
formulas that mission and batch share is found too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import get_args

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import Chooser, decisions, scenarios, seeded_chooser, seeded_scenarios

from mrta_zoo.batch import BatchMission
from mrta_zoo.mission import Finished, Mission
from mrta_zoo.plan import Plan
from mrta_zoo.rules import MaskReason, MaskRule, Status
from mrta_zoo.scenario import Scenario
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.verify import verify

RULES = get_args(MaskRule)
ACTIVE, ASSIGNED, COMPLETED, MISSED = Status
CHOOSABLE, TAKEN, DEADLINE_PASSED, TOO_LATE, *_ = map(int, MaskReason)


@dataclass(frozen=True, slots=True)
class Expected:
    """What a mission must look like after the routes taken so far."""

    time: float
    actor: int
    ready: list[float]
    retired: list[bool]
    free: list[int]
    masks: list[list[bool]]
    finish_if: list[list[float]]
    finish: list[float]
    status: list[Status]


def expected(scenario: Scenario, routes: list[list[int]], rule: MaskRule) -> Expected:
    """The rules, restated."""
    schedule = verify(scenario, Plan.of(routes)).schedule
    finish = [math.inf] * scenario.num_tasks
    for route in schedule:
        for visit in route:
            finish[visit.task] = visit.finish
    deadlines, workloads = scenario.deadline.tolist(), scenario.workload.tolist()
    places = scenario.task_xy.tolist()
    ready, masks, finish_if = [], [], []
    for robot, route in enumerate(schedule):
        now = route[-1].finish if route else 0.0
        x, y = places[route[-1].task] if route else scenario.robot_xy[robot].tolist()
        speed, capacity = float(scenario.speed[robot]), float(scenario.capacity[robot])
        mask, ends = [], []
        for task, (to_x, to_y) in enumerate(places):
            way = math.sqrt((to_x - x) * (to_x - x) + (to_y - y) * (to_y - y))
            end = now + way / speed + workloads[task] / capacity
            in_time = {
                "feasible": end <= deadlines[task],
                "active": now <= deadlines[task],
                "unvisited": True,
            }
            mask.append(math.isinf(finish[task]) and in_time[rule])
            ends.append(end)
        ready.append(now)
        masks.append(mask)
        finish_if.append(ends)
    with_choice = [(now, robot) for robot, now in enumerate(ready) if any(masks[robot])]
    time, actor = min(with_choice, default=(max(ready), -1))
    retired = [not any(masks[robot]) and (actor < 0 or (now, robot) < (time, actor)) for robot, now in enumerate(ready)]
    status = []
    for end, deadline in zip(finish, deadlines, strict=True):
        if math.isinf(end):
            status.append(MISSED if deadline < time else ACTIVE)
        elif end > time:
            status.append(ASSIGNED)
        else:
            status.append(COMPLETED if end <= deadline else MISSED)
    free = [robot for now, robot in with_choice if now == time]
    return Expected(time, actor, ready, retired, free, masks, finish_if, finish, status)


def check_mission(mission: Mission, want: Expected) -> None:
    """The mission is as it must be, and its parts fit together."""
    assert mission.time == want.time
    assert mission.actor == want.actor
    assert mission.done == (want.actor < 0)
    assert mission.ready == want.ready
    assert mission.retired == want.retired
    assert mission.free() == want.free
    assert [mission.mask(robot).tolist() for robot in range(mission.scenario.num_robots)] == want.masks
    assert mission.finish_if.tolist() == want.finish_if
    assert mission.finish.tolist() == want.finish
    assert mission.status.tolist() == want.status
    if not mission.done:
        assert mission.ready[mission.actor] == mission.time
        assert mission.mask(mission.actor).any(), "a mask is never all zeros for a robot that must act"
    reasons = mission.reasons
    late = mission.finish_if > mission.scenario.deadline
    over = mission.scenario.deadline < np.array(mission.ready)[:, None]
    assert ((reasons == CHOOSABLE) == want.masks).all()
    assert ((reasons == TAKEN) == (mission.taken_by >= 0)).all()
    assert over[reasons == DEADLINE_PASSED].all()
    assert (late & ~over)[reasons == TOO_LATE].all()
    if mission.mask_rule != "feasible":
        assert not (reasons == TOO_LATE).any()


def check_end(mission: Mission, events: list[Finished], batch: BatchMission, b: int, plan: Plan) -> None:
    """Mission, batch and verifier give the same scores."""
    scenario = mission.scenario
    assert [list(route) for route in plan.routes] == mission.routes
    taken = [task for route in mission.routes for task in route]
    assert len(taken) == len(set(taken)), "no task is taken twice"
    score = verify(scenario, plan)
    assert mission.completed() == score.completed == int(batch.completed()[b])
    assert mission.cost() == pytest.approx(score.cost, rel=1e-9, abs=0)
    assert float(batch.cost()[b]) == pytest.approx(score.cost, rel=1e-9, abs=0)
    assert mission.time == score.makespan == float(batch.time[b])
    visits = [(robot, visit) for robot, route in enumerate(score.schedule) for visit in route]
    for robot, visit in visits:
        assert mission.finish[visit.task] == visit.finish == float(batch.finish[b, visit.task])
        assert visit.completed == (visit.finish <= visit.deadline)
        assert mission.taken_by[visit.task] == robot
        assert mission.status[visit.task] == (COMPLETED if visit.completed else MISSED)
        if mission.mask_rule == "feasible":
            assert visit.completed, "a feasible choice is never late"
    if mission.mask_rule == "unvisited":
        assert len(visits) == scenario.num_tasks, "every task is visited"
    assert sorted((event.time, event.robot, event.task, event.completed) for event in events) == sorted(
        (visit.finish, robot, visit.task, visit.completed) for robot, visit in visits
    )
    assert [event.time for event in events] == sorted(event.time for event in events)


def run_together(
    cases: list[Scenario],
    rule: MaskRule,
    choosers: list[Chooser],
    max_tasks: int | None = None,
    max_robots: int | None = None,
) -> BatchMission:
    """Run each case as a mission of its own and all as one batch, comparing everything at every decision."""
    batch = BatchMission(ScenarioBatch.of(cases, max_tasks=max_tasks, max_robots=max_robots), rule)
    missions = [Mission(scenario, rule) for scenario in cases]
    events: list[list[Finished]] = [[] for _ in cases]
    clocks = [0.0] * len(cases)
    live = set(range(len(cases)))
    while live:
        actor, time, mask = batch.actor.tolist(), batch.time.tolist(), batch.mask().numpy()
        ready, retired, untaken = batch.ready.tolist(), batch.retired.tolist(), batch.untaken.numpy()
        done, finish_if, position = batch.done.tolist(), batch.finish_if.numpy(), batch.position.numpy()
        choice = torch.zeros(len(cases), dtype=torch.int64)
        for b in sorted(live):
            mission, n, m = missions[b], cases[b].num_tasks, cases[b].num_robots
            check_mission(mission, expected(cases[b], mission.routes, rule))
            assert mission.time >= clocks[b], "the clock never runs backwards"
            clocks[b] = mission.time
            assert (actor[b], time[b], done[b]) == (mission.actor, mission.time, mission.done)
            assert ready[b][:m] == mission.ready
            assert retired[b][:m] == mission.retired
            assert all(retired[b][m:]), "padding counts as retired"
            assert not untaken[b, n:].any(), "padding counts as taken"
            assert (untaken[b, :n] == (mission.taken_by < 0)).all()
            assert (position[b, :m] == mission.position).all()
            assert (finish_if[b, :m, :n] == mission.finish_if).all()
            assert not mask[b, n:].any(), "padding is never legal"
            if mission.done:
                assert not mask[b].any()
                live.remove(b)
                continue
            legal = mission.mask(mission.actor)
            assert (mask[b, :n] == legal).all()
            choice[b] = task = choosers[b](legal)
            events[b] += mission.assign(task)
        if live:
            batch.step(choice)
    assert batch.done.all()
    for b, plan in enumerate(batch.plans()):
        check_end(missions[b], events[b], batch, b, plan)
    return batch


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("seed", range(5))
def test_many_seeded_scenarios(rule: MaskRule, seed: int) -> None:
    cases = seeded_scenarios(seed, 400)
    run_together(cases, rule, [seeded_chooser(seed * 1000 + b) for b in range(len(cases))], 13 + seed, 4 + seed)


@pytest.mark.parametrize("rule", RULES)
def test_larger_seeded_scenarios(rule: MaskRule) -> None:
    cases = seeded_scenarios(10, 25, max_tasks=40, max_robots=8)
    run_together(cases, rule, [seeded_chooser(b) for b in range(len(cases))])


@pytest.mark.parametrize("rule", RULES)
@settings(max_examples=300, derandomize=True)
@given(pairs=st.lists(st.tuples(scenarios(8, 4), decisions(8)), min_size=1, max_size=3))
def test_hypothesis_finds_no_difference(rule: MaskRule, pairs: list[tuple[Scenario, Chooser]]) -> None:
    run_together([scenario for scenario, _ in pairs], rule, [chooser for _, chooser in pairs])


@pytest.mark.parametrize("rule", RULES)
def test_padding_and_batch_mates_change_nothing(rule: MaskRule) -> None:
    cases = seeded_scenarios(20, 60)
    together = run_together(cases, rule, [seeded_chooser(b) for b in range(60)], max_tasks=20, max_robots=9)
    for b, scenario in enumerate(cases):
        n, m = scenario.num_tasks, scenario.num_robots
        alone = BatchMission(ScenarioBatch.of([scenario]), rule)
        chooser = seeded_chooser(b)
        while not alone.done.all():
            alone.step(torch.tensor([chooser(alone.mask()[0].numpy())]))
        for attribute in ("finish", "taken_by", "order", "untaken"):
            assert torch.equal(getattr(alone, attribute)[0], getattr(together, attribute)[b, :n]), attribute
        for attribute in ("ready", "position", "retired"):
            assert torch.equal(getattr(alone, attribute)[0], getattr(together, attribute)[b, :m]), attribute
        assert torch.equal(alone.finish_if[0], together.finish_if[b, :m, :n])
        assert alone.time[0] == together.time[b]
        assert float(alone.cost()[0]) == pytest.approx(float(together.cost()[b]), rel=1e-12)


@pytest.mark.parametrize("rule", RULES)
def test_the_scenarios_reach_the_corners(rule: MaskRule) -> None:
    """The agreement above is worth something only if ties, late finishes and idle robots do occur."""
    ties = late = untaken = nothing = exact = zero = 0
    for seed, scenario in enumerate(seeded_scenarios(0, 250)):
        mission, chooser = Mission(scenario, rule), seeded_chooser(seed)
        nothing += mission.done
        while not mission.done:
            ties += mission.time > 0 and len(mission.free()) > 1
            task = chooser(mission.mask(mission.actor))
            exact += bool(mission.finish_if[mission.actor, task] == scenario.deadline[task])
            zero += bool(mission.finish_if[mission.actor, task] == mission.time)
            mission.assign(task)
        late += int((mission.finish > scenario.deadline)[mission.taken_by >= 0].sum())
        untaken += int((mission.taken_by < 0).sum())
    assert min(exact, zero) >= 20
    assert ties >= 10
    assert (late >= 100) == (rule != "feasible")
    assert (untaken >= 100) == (rule != "unvisited")
    assert (nothing >= 20) == (rule == "feasible")


@pytest.mark.parametrize("rule", RULES)
def test_robots_that_choose_at_once(rule: MaskRule) -> None:
    """`take` by every free robot, then `advance`: the parallel form keeps the same books."""
    for seed, scenario in enumerate(seeded_scenarios(30, 200)):
        mission, chooser = Mission(scenario, rule), seeded_chooser(seed)
        while not mission.done:
            check_mission(mission, expected(scenario, mission.routes, rule))
            for robot in mission.free():
                if mission.mask(robot).any():  # another may just have taken its last choice
                    mission.take(robot, chooser(mission.mask(robot)))
            mission.advance()
        check_mission(mission, expected(scenario, mission.routes, rule))
        score = verify(scenario, Plan.of(mission.routes))
        assert (mission.completed(), mission.time) == (score.completed, score.makespan)
        assert mission.cost() == pytest.approx(score.cost, rel=1e-9, abs=0)
