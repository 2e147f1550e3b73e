"""A run prepared here, trained on a bare machine, and collected; plans that are there already."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mrta_zoo.cli.train import train_command
from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.policy import load_policy
from mrta_zoo.train import bare
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.imitation import experts, plans

TINY = [
    "--preset",
    "smoke",
    "--embedding",
    "8",
    "--heads",
    "2",
    "--tasks",
    "6",
    "--max-robots",
    "2",
    "--scenarios",
    "2",
    "--samples",
    "2",
    "--updates",
    "2",
    "--epoch",
    "1",
    "--validation-scenarios",
    "4",
]


def test_a_run_trained_elsewhere_is_collected(tmp_path: Path) -> None:
    folder = tmp_path / "run"
    train_command([*TINY, "--out", str(folder), "--prepare"])
    assert not (folder / "policy.safetensors").exists()
    config = bare.read_config(folder / "config.json")
    bare.train(config, folder / "bare")
    train_command(["--out", str(folder), "--collect"])
    collected = load_policy(folder).info
    assert (collected.network, collected.trained["config"]["updates"]) == (config.network, 2)
    rows = (folder / "history.csv").read_text().splitlines()[1:]
    assert [row.split(",")[0] for row in rows] == ["0", "1", "2"]
    best = max(float(row.split(",")[2]) for row in rows)
    assert float(rows[collected.trained["updates"]].split(",")[2]) == best

    straight = tmp_path / "straight"
    train_command([*TINY, "--out", str(straight)])
    assert (straight / "policy.safetensors").read_bytes() == (folder / "policy.safetensors").read_bytes()


def test_nothing_to_collect_is_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"bare\.npz: no such file; expected what mrta_zoo\.train\.bare leaves"):
        train_command(["--out", str(tmp_path), "--collect"])
    (tmp_path / "bare.npz").write_bytes(b"no archive")
    with pytest.raises(ConfigError, match=r"bare\.npz: not what mrta_zoo\.train\.bare leaves"):
        train_command(["--out", str(tmp_path), "--collect"])


@pytest.fixture
def left(tmp_path: Path) -> Path:
    """A prepared folder and what a bare machine left in it."""
    folder = tmp_path / "run"
    train_command([*TINY, "--out", str(folder), "--prepare"])
    bare.train(bare.read_config(folder / "config.json"), folder / "bare")
    return folder


def edit(path: Path, arrays: dict[str, Any] | None = None, **about: Any) -> None:
    """Change what is in a file of weights."""
    with np.load(path) as file:
        kept = {name: file[name] for name in file.files}
    state = json.loads(str(kept.pop("about"))) | about
    np.savez(path, about=np.array(json.dumps(state)), **(kept | (arrays or {})))


@pytest.mark.parametrize(
    ("about", "arrays", "sentence"),
    [
        ({"history": []}, {}, "its history ends with updates"),
        ({"update": 77}, {}, "its history ends with updates"),
        ({"update": "x"}, {}, "not what"),
        ({"seconds": float("nan")}, {}, "not what"),
        ({"torch": None}, {}, "not what"),
        ({}, {"context": np.array(["text"])}, "context is no array of float32"),
        ({}, {"context": np.zeros(3, ">f4")}, "context is no array of float32"),
        ({}, {"context": np.full(3, 1e300)}, "context is no array of float32"),
        ({}, {"left_over": np.zeros(3, np.float32)}, "'left_over' has no place in the architecture"),
    ],
)
def test_damaged_weights_are_refused_before_anything_is_written(
    left: Path, about: dict[str, Any], arrays: dict[str, Any], sentence: str
) -> None:
    edit(left / "bare.npz", arrays, **about)
    with pytest.raises(ConfigError, match=sentence):
        train_command(["--out", str(left), "--collect"])
    assert not (left / "policy.safetensors").exists()


def test_files_of_different_runs_are_refused(left: Path) -> None:
    whole = (left / "bare.json").read_text()
    run = json.loads(whole)
    for change, sentence in (
        ({"config": run["config"] | {"mask_rule": "unvisited"}}, "mask_rule is 'unvisited'; config.json beside it has"),
        ({"config": run["config"] | {"max_robots": 2.5}}, r"bare\.json: Expected `int`, got `float`"),
        ({"history": [run["history"][0] | {"completion": 0.125}]}, "its history is not that of bare.npz"),
        ({"history": run["history"] * 2}, "its history is not that of bare.npz"),
        ({"history": [{"update": "junk"}] * 9}, r"bare\.json: "),
    ):
        (left / "bare.json").write_text(json.dumps(run | change))
        with pytest.raises(ConfigError, match=sentence):
            train_command(["--out", str(left), "--collect"])
    (left / "bare.json").write_text("")
    with pytest.raises(ConfigError, match=r"bare\.json is empty; expected the JSON of a policy or a training run"):
        train_command(["--out", str(left), "--collect"])
    (left / "bare.json").write_text(whole)
    (left / "bare.npz").write_bytes(b"")
    with pytest.raises(ConfigError, match=r"bare\.npz: not what mrta_zoo\.train\.bare leaves: it is empty; expected"):
        train_command(["--out", str(left), "--collect"])


def test_a_collected_policy_is_not_trained_over(left: Path) -> None:
    train_command(["--out", str(left), "--collect"])
    policy = (left / "policy.safetensors").read_bytes()
    with pytest.raises(ConfigError, match=r"holds a run of mrta_zoo\.train\.bare, which goes on there"):
        train_command(["--out", str(left), "--resume"])
    (left / "checkpoints").mkdir()
    with pytest.raises(ConfigError, match="has checkpoints of a run of its own"):
        train_command(["--out", str(left), "--collect"])
    assert (left / "policy.safetensors").read_bytes() == policy


def test_plans_that_are_there_are_not_made_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(experts, "SHARD", 4)
    config = TrainConfig(
        tasks=(5,), reference_tasks=5, max_robots=2, imitation_updates=1, imitation_plans=4, imitation_batch=2
    )
    made = experts.make_shard(config, 0, tmp_path)
    monkeypatch.setattr(plans, "pool_of", None)  # whoever wants to make plans fails
    got = plans.make_plans(config, tmp_path)
    assert made == tmp_path / "0000000.npz"
    assert [plan.scenario for plan in got] == [experts.expert_scenario(config, number) for number in range(4)]


@pytest.mark.parametrize("workers", ["0", "5000"])
def test_number_of_workers_is_checked(tmp_path: Path, workers: str) -> None:
    with pytest.raises(ConfigError, match="expected a whole number from 1 to"):
        train_command([*TINY, "--out", str(tmp_path), "--workers", workers])
