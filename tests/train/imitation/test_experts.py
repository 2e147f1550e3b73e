"""Plans on disk: what is written comes back, and nothing else does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sentences import check_sentence

from mrta_zoo.errors import ConfigError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.local_search.eils import EilsConfig, EilsSolver
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.imitation import experts
from mrta_zoo.train.imitation.experts import ExpertPlan, expert_scenario, make_shard, read_plans
from mrta_zoo.verify import verify

CONFIG = TrainConfig(tasks=(6, 9), reference_tasks=9, min_robots=2, max_robots=3, generator="mixture", seed=5)


@pytest.fixture(autouse=True)
def small_files(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(experts, "SHARD", 4)
    monkeypatch.setattr(experts, "ITERATIONS_PER_TASK", 2)


def test_plans_come_back_with_their_scenarios(tmp_path: Path) -> None:
    assert make_shard(CONFIG, 4, tmp_path) == tmp_path / "0000004.npz"
    make_shard(CONFIG, 0, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["0000000.npz", "0000004.npz"]
    plans = read_plans(CONFIG, tmp_path, 100)
    solver = EilsSolver(config=EilsConfig(iterations_per_task=2, by_deadline=0.0))
    scenarios = [expert_scenario(CONFIG, number) for number in range(8)]
    assert [plan.routes for plan in plans] == [solver.solve(scenario).routes for scenario in scenarios]
    for plan, scenario in zip(plans, scenarios, strict=True):
        for name in ("task_xy", "deadline", "workload", "robot_xy", "capacity", "speed"):
            assert np.array_equal(getattr(plan.scenario, name), getattr(scenario, name))
        # Every task of a plan is finished in time, and a search leaves few robots idle.
        assert verify(scenario, Plan(plan.routes)).completed == sum(map(len, plan.routes)) > 0
    assert {plan.scenario.num_tasks for plan in plans} == {6, 9}
    assert [each.routes for each in read_plans(CONFIG, tmp_path, 5)] == [each.routes for each in plans[:5]]
    assert read_plans(CONFIG, tmp_path / "nothing here", 5) == []


def test_other_processes_read_the_same_plans(tmp_path: Path) -> None:
    for first in (0, 4, 8):
        make_shard(CONFIG, first, tmp_path)
    (tmp_path / "0000008.npz").write_bytes(b"no plans")  # where it is not needed it does no harm
    here, there = (read_plans(CONFIG, tmp_path, 7, workers) for workers in (0, 1))
    assert len(here) == 7
    assert [plan.routes for plan in here] == [plan.routes for plan in there]
    assert [plan.scenario.task_xy.tolist() for plan in here] == [plan.scenario.task_xy.tolist() for plan in there]
    with pytest.raises(ConfigError, match=r"0000008\.npz: not a readable file of plans"):
        read_plans(CONFIG, tmp_path, 100, workers=1)


def test_scenarios_follow_from_seed_and_number() -> None:
    same, other, reseeded = (
        expert_scenario(config, number).task_xy.tolist()
        for config, number in ((CONFIG, 3), (CONFIG, 4), (replace(CONFIG, seed=6), 3))
    )
    assert same == expert_scenario(CONFIG, 3).task_xy.tolist()
    assert same != other
    assert same != reseeded


@pytest.mark.parametrize(
    "change",
    [{"seed": 6}, {"tasks": (9,)}, {"min_robots": 3}, {"generator": "uniform"}],
    ids=lambda each: next(iter(each)),
)
def test_plans_of_another_configuration_are_refused(tmp_path: Path, change: dict[str, object]) -> None:
    make_shard(CONFIG, 0, tmp_path)
    with pytest.raises(ConfigError, match=r"0000000.npz: plan \d does not fit its scenario") as caught:
        read_plans(replace(CONFIG, **change), tmp_path, 100)  # type: ignore[arg-type]
    check_sentence(caught.value, "was it made with another seed?")


@pytest.mark.parametrize("wrong", ["late", "twice", "unknown", "negative"])
def test_plans_that_nobody_could_follow_are_refused(tmp_path: Path, wrong: str) -> None:
    scenario = expert_scenario(CONFIG, 0)
    tasks = np.argsort(-scenario.deadline)  # the most urgent last
    if wrong != "late":
        tasks = np.array([0, {"twice": 0, "unknown": scenario.num_tasks, "negative": -1}[wrong]])
    # Robot 0 does these, and the others nothing.
    lengths = [len(tasks), *[0] * (scenario.num_robots - 1)]
    arrays = {"index": [0], "robots": [scenario.num_robots], "lengths": lengths, "tasks": tasks}
    np.savez(tmp_path / "0000000.npz", **arrays)
    with pytest.raises(ConfigError, match=r"0000000.npz: plan 0 does not fit its scenario"):
        read_plans(CONFIG, tmp_path, 100)


@pytest.mark.parametrize("name", ["index", "robots", "lengths", "tasks"])
def test_files_that_do_not_add_up_are_refused(tmp_path: Path, name: str) -> None:
    make_shard(CONFIG, 0, tmp_path)
    with np.load(tmp_path / "0000000.npz") as file:
        arrays = {key: file[key] for key in file.files}
    np.savez(tmp_path / "0000000.npz", **{**arrays, name: arrays[name][:-1]})
    with pytest.raises(ConfigError) as caught:
        read_plans(CONFIG, tmp_path, 100)
    check_sentence(caught.value, "0000000.npz", "not a readable file of plans")
    np.savez(tmp_path / "0000000.npz", **{key: array for key, array in arrays.items() if key != name})
    with pytest.raises(ConfigError, match="not a readable file of plans"):
        read_plans(CONFIG, tmp_path, 100)


def test_damage_is_told_or_does_no_harm(tmp_path: Path) -> None:
    path, rng = make_shard(CONFIG, 0, tmp_path), np.random.default_rng(0)
    whole, good = path.read_bytes(), [each.routes for each in read_plans(CONFIG, tmp_path, 100)]
    told = 0
    for number in range(300):
        damaged = bytearray(whole)
        if number % 3 == 0:
            del damaged[int(rng.integers(len(whole))) :]
        else:
            for at in rng.integers(len(whole), size=number % 3):
                damaged[at] ^= 1 << int(rng.integers(8))
        path.write_bytes(damaged)
        try:
            plans: list[ExpertPlan] = read_plans(CONFIG, tmp_path, 100)
        except ConfigError as error:
            check_sentence(error, "0000000.npz")
            told += 1
        else:
            assert [each.routes for each in plans] == good
    assert told > 200
