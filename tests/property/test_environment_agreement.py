"""The AEC environment and the batched simulator take the same turns, legal choices, times and returns."""

from __future__ import annotations

from collections import Counter
from typing import Any, get_args

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import Chooser, decisions, scenarios, seeded_chooser, seeded_scenarios

from mrta_zoo import mrta_v0
from mrta_zoo.batch import BatchMission
from mrta_zoo.plan import Plan
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import Scenario
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.verify import verify

RULES = get_args(MaskRule)
MAX_TASKS, MAX_ROBOTS = 12, 4


def make(rule: MaskRule, **options: Any) -> Any:
    return mrta_v0.raw_env(mask_rule=rule, max_tasks=MAX_TASKS, max_robots=MAX_ROBOTS, **options)


def run_together(
    envs: list[Any], cases: list[Scenario], rule: MaskRule, choosers: list[Chooser]
) -> list[tuple[Plan, Counter[str]]]:
    """Play every case in an environment of its own and all as one batch; gives the plans and last rewards."""
    batch = BatchMission(ScenarioBatch.of(cases, max_tasks=MAX_TASKS, max_robots=MAX_ROBOTS), rule)
    for env, case in zip(envs, cases, strict=True):
        env.reset(options={"scenario": case})
        assert env.agents == [f"robot_{robot}" for robot in range(case.num_robots)]
    live = set(range(len(cases)))
    routes: list[list[list[int]]] = [[[] for _ in range(case.num_robots)] for case in cases]
    while live:
        choice = torch.zeros(len(cases), dtype=torch.int64)
        actor, time, mask = batch.actor.tolist(), batch.time.tolist(), batch.mask().numpy()
        for b in sorted(live):
            observation, _, termination, truncation, info = envs[b].last()
            assert not truncation
            assert termination == (actor[b] < 0)
            assert info["time"] == time[b]
            if termination:
                live.remove(b)
                continue
            assert envs[b].agent_selection == f"robot_{actor[b]}"
            assert (observation["action_mask"] == mask[b]).all()
            assert mask[b].any()
            choice[b] = task = choosers[b](mask[b])
            routes[b][actor[b]].append(task)
            envs[b].step(task)
        if live:
            batch.step(choice)
    results = []
    for b, plan in enumerate(batch.plans()):
        assert plan == Plan.of(routes[b])
        results.append((plan, farewell(envs[b])))
        assert envs[b].agents == []
    for (plan, _), cost, case in zip(results, batch.cost().tolist(), cases, strict=True):
        assert cost == pytest.approx(verify(case, plan).cost, rel=1e-9, abs=0)
    return results


def farewell(env: Any) -> Counter[str]:
    """Step every terminated agent out; gives the rewards it had still to get."""
    rewards: Counter[str] = Counter()
    for agent in env.agent_iter():
        _, reward, termination, _, _ = env.last()
        assert termination
        assert agent not in rewards, "every agent says farewell once"
        rewards[agent] = reward
        env.step(None)
    return rewards


@pytest.mark.parametrize("rule", RULES)
def test_many_seeded_scenarios(rule: MaskRule) -> None:
    envs = [make(rule) for _ in range(100)]
    for seed in range(4):  # the same environments again and again: nothing is left over from the last episode
        cases = seeded_scenarios(100 + seed, 100, MAX_TASKS, MAX_ROBOTS)
        results = run_together(envs, cases, rule, [seeded_chooser(seed * 100 + b) for b in range(100)])
        for case, (plan, rewards) in zip(cases, results, strict=True):
            # The terminal reward, the only one of the episode, is -cost / N for every robot.
            want = -verify(case, plan).cost / case.num_tasks
            assert len(rewards) == case.num_robots
            assert list(rewards.values()) == pytest.approx([want] * case.num_robots, rel=1e-9, abs=0)


@pytest.mark.parametrize("rule", RULES)
@settings(max_examples=150, derandomize=True)
@given(case=scenarios(MAX_TASKS, MAX_ROBOTS), chooser=decisions(MAX_TASKS))
def test_hypothesis_finds_no_difference(rule: MaskRule, case: Scenario, chooser: Chooser) -> None:
    env = mrta_v0.raw_env(scenario=case, mask_rule=rule, max_tasks=MAX_TASKS, max_robots=MAX_ROBOTS)
    run_together([env], [case], rule, [chooser])


@pytest.mark.parametrize("rule", RULES)
@settings(max_examples=50, derandomize=True)
@given(case=scenarios(), seed=st.integers(0, 1000))
def test_rewards_add_up_to_the_completion(rule: MaskRule, case: Scenario, seed: int) -> None:
    for reward in ("completion", "individual"):
        env = mrta_v0.raw_env(scenario=case, mask_rule=rule, reward=reward)
        chooser = seeded_chooser(seed)
        env.reset()
        routes: list[list[int]] = [[] for _ in range(case.num_robots)]
        returns = dict.fromkeys(env.agents, 0.0)
        for agent in env.agent_iter():
            observation, gained, termination, truncation, _ = env.last()
            returns[agent] += gained
            if termination or truncation:
                env.step(None)
                continue
            task = chooser(observation["action_mask"].astype(np.bool_))
            routes[int(agent.removeprefix("robot_"))].append(task)
            env.step(task)
        score = verify(case, Plan.of(routes))
        own = [sum(visit.completed for visit in visits) / case.num_tasks for visits in score.schedule]
        want = own if reward == "individual" else [score.completion] * case.num_robots
        assert list(returns.values()) == pytest.approx(want, abs=1e-12)
