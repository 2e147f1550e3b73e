"""Training with torch and numpy alone: it needs nothing else, and an interrupted run ends in the same bits."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import asdict, replace
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from sentences import check_sentence

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.train import bare, checkpoint
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.imitation import experts, imitator
from mrta_zoo.train.imitation.experts import make_shard
from mrta_zoo.train.presets import PRESETS
from mrta_zoo.train.reinforce import Reinforce

TINY = TrainConfig(
    network=NetworkConfig(embedding=16, heads=2, decoder="candidates", decision_layers=1, candidates=6, peers=2),
    tasks=(6, 9), task_weights=(1.0, 2.0), reference_tasks=9, min_robots=2, max_robots=3, generator="mixture",
    imitation_updates=4, imitation_plans=12, imitation_batch=4, scenarios=2, samples=2, updates=4, epoch=2,
    validation_scenarios=4, device="cpu",
)  # fmt: skip

ALONE = '''
import sys

ALLOWED = {"torch", "torchgen", "functorch", "numpy", "mrta_zoo", "typing_extensions", "sitecustomize"} | {
    "sympy", "mpmath", "filelock", "networkx", "jinja2", "markupsafe", "fsspec",  # what torch itself requires
}

OURS = ("__editable__", "_sysconfigdata")  # how this package is installed, and a part of the standard library

class Only:
    """A finder that finds no third party's packages."""

    def __init__(self, finder):
        self.finder = finder

    def find_spec(self, name, path=None, target=None):
        top = name.partition(".")[0]
        if top in ALLOWED or top in sys.stdlib_module_names or top.startswith(OURS):
            return self.finder.find_spec(name, path, target)
        return None

sys.meta_path[:] = [Only(finder) for finder in sys.meta_path]
for name in ("gymnasium", "pettingzoo", "msgspec", "tyro", "rich", "tensorboard", "safetensors", "scipy", "numba"):
    assert name not in sys.modules
    try:
        __import__(name)
    except ModuleNotFoundError:
        pass
    else:
        raise AssertionError(f"{name} is not refused")
from mrta_zoo.train.bare import main
main()
'''


@pytest.fixture
def plans(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(experts, "SHARD", 12)
    monkeypatch.setattr(experts, "ITERATIONS_A_TASK", 1)
    (tmp_path / "plans").mkdir()
    make_shard(TINY, 0, tmp_path / "plans")
    return tmp_path / "plans"


def arrays(path: Path) -> dict[str, np.ndarray]:
    with np.load(path, allow_pickle=False) as file:
        return {name: file[name] for name in file.files}


def about(path: Path) -> Any:
    return json.loads(str(arrays(path)["about"]))


def test_trains_with_torch_and_numpy_alone(tmp_path: Path, plans: Path) -> None:
    (tmp_path / "config.json").write_text(json.dumps(asdict(TINY)))
    command = [sys.executable, "-c", ALONE, "config.json", "out", "--plans", "plans"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 0, done.stderr
    assert about(tmp_path / "out.last.npz")["update"] == 8
    history = json.loads((tmp_path / "out.json").read_text())["history"]
    assert [each["update"] for each in history] == [0, 2, 4, 6, 8]

    # Here, with everything installed, the same run gives the same bits.
    bare.train(TINY, tmp_path / "here", plans)
    there, here = arrays(tmp_path / "out.last.npz"), arrays(tmp_path / "here.last.npz")
    assert there.keys() == here.keys()
    assert all(np.array_equal(there[name], here[name]) for name in here if name != "about")


def test_writes_the_best_weights_by_validation(tmp_path: Path, plans: Path) -> None:
    bare.train(TINY, tmp_path / "out", plans)
    history = about(tmp_path / "out.last.npz")["history"]
    best = max(history, key=lambda each: (each["completion"], -each["cost"]))
    assert about(tmp_path / "out.npz")["update"] == best["update"]
    run = Reinforce(TINY)
    assert arrays(tmp_path / "out.npz").keys() == {"about", *run.network.state_dict()}


@pytest.mark.parametrize(
    "change",
    [{}, {"sharing": "independent"}, {"imitation_decisions": 3, "entropy": 0.1}],
    ids=["shared", "independent", "pool"],
)
def test_interrupted_and_resumed_is_uninterrupted(
    tmp_path: Path, plans: Path, monkeypatch: pytest.MonkeyPatch, change: dict[str, Any]
) -> None:
    config = replace(TINY, **change)
    monkeypatch.setattr(imitator, "POOL_PLANS", 20)
    monkeypatch.setattr(imitator, "POOL_STEPS", 3)
    bare.train(config, tmp_path / "straight", plans)
    stops = []
    for seconds in (4, 5, 4):  # by a clock that moves on by one each time somebody looks
        clock = count()
        monkeypatch.setattr(bare, "time", SimpleNamespace(perf_counter=lambda clock=clock: next(clock)))
        bare.train(config, tmp_path / "broken", plans, seconds=seconds, resume=bool(stops))
        stops.append(about(tmp_path / "broken.last.npz")["update"])
    assert stops == sorted(set(stops))
    assert 0 < stops[0] < 4 < stops[-1] < 8, "once in imitation, once in REINFORCE"
    bare.train(config, tmp_path / "broken", plans, resume=True)
    straight, broken = arrays(tmp_path / "straight.last.npz"), arrays(tmp_path / "broken.last.npz")
    assert straight.keys() == broken.keys()
    assert any(name.startswith("adam/") for name in straight)
    for name, value in straight.items():
        if name != "about":
            assert np.array_equal(value, broken[name]), name
    assert about(tmp_path / "broken.last.npz")["update"] == 8


def test_configurations_come_back(tmp_path: Path) -> None:
    for config in (TINY, *PRESETS.values()):
        (tmp_path / "config.json").write_text(json.dumps(asdict(config)))
        assert bare.read_config(tmp_path / "config.json") == config


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("{", "not a configuration"),
        ("[1]", "not a configuration"),
        ('{"updates": 4, "learning_rte": 1}', "learning_rte"),
        ('{"network": {"embeding": 32}}', "embeding"),
        ('{"updates": "four"}', 'updates is "four"; expected a whole number'),
        ('{"updates": 1.5}', "updates is 1.5; expected a whole number"),
        ('{"learning_rate": null}', "learning_rate is null; expected a number"),
        ('{"normalise": 1}', "normalise is 1; expected true or false"),
        ('{"initial": ["a"]}', 'initial is ["a"]; expected a text'),
        ('{"tasks": 100}', "tasks is 100; expected a list"),
        ('{"network": {"candidates": true}}', "candidates is true; expected a whole number"),
        ('{"updates": 0}', "updates is 0; expected a whole number >= 1"),
        ('{"network": {"heads": 7}}', "embedding is 128; expected a multiple of heads, 7"),
    ],
)
def test_bad_configurations_are_told(tmp_path: Path, text: str, part: str) -> None:
    (tmp_path / "config.json").write_text(text)
    with pytest.raises(ConfigError) as caught:
        bare.read_config(tmp_path / "config.json")
    check_sentence(caught.value, part)


def test_what_it_cannot_do_is_told(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="there is imitation to be done; name a folder of plans"):
        bare.train(TINY, tmp_path / "out")
    with pytest.raises(ConfigError, match="baseline is 'rollout', which needs SciPy; expected samples"):
        bare.train(replace(TINY, baseline="rollout"), tmp_path / "out")
    with pytest.raises(ConfigError, match="not a configuration"):
        bare.read_config(tmp_path / "nothing.json")


def test_no_file_that_is_there_is_written_over(tmp_path: Path) -> None:
    for name in ("out.npz", "out.last.npz", "out.json"):
        (tmp_path / name).write_text("precious")
        with pytest.raises(ConfigError, match=rf"{name} is there already; go on with that run \(--resume\), or give"):
            bare.train(TINY, tmp_path / "out")
        assert (tmp_path / name).read_text() == "precious"
        (tmp_path / name).unlink()


def test_a_policy_to_begin_from_takes_more_than_torch_and_numpy(tmp_path: Path) -> None:
    config = replace(TINY, initial="capam-plus", imitation_updates=0)
    (tmp_path / "config.json").write_text(json.dumps(asdict(config)))
    command = [sys.executable, "-c", ALONE, "config.json", "out"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=240, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("error: initial is 'capam-plus', which cannot be read without msgspec; expected none")


def test_resumed_it_does_not_need_what_it_began_from(tmp_path: Path) -> None:
    first = checkpoint.start(tmp_path / "first", replace(TINY, imitation_updates=0))
    first.validate()
    checkpoint.save(tmp_path / "first", first, 0.0)
    config = replace(TINY, imitation_updates=0, initial=str(tmp_path / "first"), updates=2)
    bare.train(config, tmp_path / "out")
    (tmp_path / "first").rename(tmp_path / "gone")
    bare.train(replace(config, updates=4), tmp_path / "out", resume=True)
    assert about(tmp_path / "out.last.npz")["update"] == 4


def test_says_how_many_plans_there_were(tmp_path: Path, plans: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bare.train(replace(TINY, imitation_plans=100, imitation_updates=1, updates=1), tmp_path / "out", plans)
    assert "holds 12 plans, not 100" in capsys.readouterr().out
    assert json.loads((tmp_path / "out.json").read_text())["config"]["imitation_plans"] == 12


def test_fits_a_resumed_run_into_the_time_left(
    tmp_path: Path, plans: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    bare.train(TINY, tmp_path / "out", plans)
    clock = count()
    monkeypatch.setattr(bare, "time", SimpleNamespace(perf_counter=lambda: next(clock)))
    monkeypatch.setattr(Reinforce, "_reinforce", lambda run: (0.0, 1))
    bare.train(replace(TINY, updates=1000, epoch=1000), tmp_path / "out", seconds=126, fit=True, resume=True)
    # The clock shows 2 when training starts, and goes on by 1 a step: 77 after 75 steps. Of the 126 there are then
    # 126 - 77 - 12 = 37 left, for int(37 / 1.08) = 34 more; and 4 of REINFORCE had been done before.
    assert "113 updates of REINFORCE" in capsys.readouterr().out
    assert about(tmp_path / "out.last.npz")["update"] == 4 + 113


def test_resumed_it_keeps_the_number_of_updates_that_fitted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    config = replace(TINY, imitation_updates=0, updates=1000, epoch=1000)
    clock = count()
    monkeypatch.setattr(bare, "time", SimpleNamespace(perf_counter=lambda: next(clock)))
    monkeypatch.setattr(Reinforce, "_reinforce", lambda run: (0.0, 1))
    # As above, but for the validation at first: 78 have passed after 75 steps; 126 - 78 - 12 = 36, int(36 / 1.08) = 33.
    bare.train(config, tmp_path / "out", seconds=126, fit=True)
    assert about(tmp_path / "out.last.npz")["update"] == 75 + 33
    bare.train(config, tmp_path / "out", resume=True)
    assert about(tmp_path / "out.last.npz")["update"] == 75 + 33, "it was at its end"


def test_stopped_at_once_it_has_left_everything(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(run: Reinforce) -> None:
        raise KeyboardInterrupt

    config = replace(TINY, imitation_updates=0)
    with monkeypatch.context() as patch:
        patch.setattr(Reinforce, "step", interrupted)
        with pytest.raises(KeyboardInterrupt):
            bare.train(config, tmp_path / "out")
    assert {path.name for path in tmp_path.iterdir()} == {"out.npz", "out.last.npz", "out.json"}
    bare.train(config, tmp_path / "out", resume=True)
    bare.train(config, tmp_path / "straight")
    straight, resumed = arrays(tmp_path / "straight.last.npz"), arrays(tmp_path / "out.last.npz")
    assert all(np.array_equal(straight[name], resumed[name]) for name in straight if name != "about")


def test_what_cannot_be_resumed_is_told(tmp_path: Path) -> None:
    config = replace(TINY, imitation_updates=0, updates=1, epoch=1)
    last = tmp_path / "out.last.npz"
    with pytest.raises(ConfigError, match=r"out\.last\.npz: no such file; there is nothing to go on with"):
        bare.train(config, tmp_path / "out", resume=True)
    for junk in (b"", b"junk", b"PK\x03\x04"):
        last.write_bytes(junk)
        with pytest.raises(ConfigError, match=r"out\.last\.npz: not what a run leaves to go on with"):
            bare.train(config, tmp_path / "out", resume=True)
    last.unlink()
    bare.train(config, tmp_path / "out")
    with pytest.raises(ConfigError, match="is of another run: seed was 0, now it is 1"):
        bare.train(replace(config, seed=1), tmp_path / "out", resume=True)
    kept = arrays(last)
    for change, sentence in (
        ({"update": 99}, "update is 99; expected at most 1"),
        ({"history": []}, "validated before"),
    ):
        state = {**about(last), **change}
        np.savez(last, **{**kept, "about": np.array(json.dumps(state))})
        with pytest.raises(ConfigError, match=sentence):
            bare.train(config, tmp_path / "out", resume=True)
        np.savez(last, **kept)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["nothing.json", "out"], "error: nothing.json: not a configuration"),
        (["config.json", "nowhere/out"], "error: nowhere is no folder"),
        (["config.json", "out", "--plans", "nowhere"], "error: nowhere holds no plans; expected 12 of them"),
        (["config.json", "out", "--seconds", "nan"], "--seconds a number > 0"),
        (["config.json", "out", "--workers", "-1"], "--workers and --threads are whole numbers >= 0"),
    ],
)
def test_its_command_ends_with_a_sentence(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    sentence: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("config.json").write_text(json.dumps(asdict(TINY)))
    monkeypatch.setattr(sys, "argv", ["bare", *arguments])
    with pytest.raises(SystemExit) as ended:
        bare.main()
    assert ended.value.code == 2
    assert sentence in capsys.readouterr().err
