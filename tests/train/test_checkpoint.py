"""Runs on disk: killed and resumed to the same bits; damage is told, not suffered."""

from __future__ import annotations

import json
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
import torch
from filelock import FileLock
from torch import Tensor

from mrta_zoo.cli.train import train_command
from mrta_zoo.errors import ConfigError
from mrta_zoo.io.lock import lock_folder
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.policy import load_policy
from mrta_zoo.policies.neural.weights import read_tensors, write_tensors
from mrta_zoo.train import checkpoint
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.reinforce import Reinforce, Validation

TINY = TrainConfig(
    network=NetworkConfig(embedding=32, heads=4), tasks=(10,), reference_tasks=10, min_robots=1, max_robots=3,
    scenarios=4, samples=4, updates=6, epoch=2, validation_scenarios=8,
)  # fmt: skip


def weights(run: Reinforce) -> dict[str, torch.Tensor]:
    return dict(run.network.state_dict())


@pytest.mark.parametrize("baseline", ["samples", "rollout", "exponential"])
@pytest.mark.parametrize("sharing", ["shared", "independent", "by-capacity"])
def test_resumed_run_ends_in_the_same_bits(tmp_path: Path, baseline: str, sharing: str) -> None:
    config = replace(TINY, baseline=baseline, sharing=sharing, significance=0.9)
    straight = Reinforce(config)
    list(straight.run())

    broken = checkpoint.start(tmp_path / "run", config)
    for event in broken.run():
        if isinstance(event, Validation):
            checkpoint.save(tmp_path / "run", broken, 1.0)
            if event.update == 2:
                break
    broken.step()  # lost work, after the last checkpoint
    resumed, seconds = checkpoint.resume(tmp_path / "run")
    assert (resumed.update, seconds) == (2, 1.0)
    for event in resumed.run():
        if isinstance(event, Validation):
            checkpoint.save(tmp_path / "run", resumed, 2.0)
    assert resumed.history == straight.history
    for name, value in weights(straight).items():
        assert torch.equal(value, weights(resumed)[name])
    names = sorted(each.name for each in (tmp_path / "run" / "checkpoints").iterdir())
    assert names == ["00000002", "00000004", "00000006"]


def test_killed_run_resumes_to_the_same_bits(tmp_path: Path) -> None:
    arguments = shlex.split(
        "--preset smoke --tasks 10 --reference-tasks 10 --updates 12 --epoch 1 --scenarios 4 --validation-scenarios 8 "
        "--embedding 32 --heads 4 --threads 1"
    )

    train_command([*arguments, "--out", str(tmp_path / "straight")])

    killed = tmp_path / "killed"
    command = [sys.executable, "-m", "mrta_zoo", "train", *arguments, "--out", str(killed)]
    process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
    try:
        until = time.monotonic() + 60
        while not (killed / "checkpoints" / "00000003").exists() and time.monotonic() < until:
            time.sleep(0.01)
    finally:
        process.kill()
    assert process.wait() == -signal.SIGKILL
    train_command(["--out", str(killed), "--resume", "--threads", "1"])
    for file in ("policy.safetensors", "history.csv", "checkpoints/00000012/network.safetensors"):
        assert (killed / file).read_bytes() == (tmp_path / "straight" / file).read_bytes()


def test_prepared_here_and_trained_elsewhere_ends_in_the_same_bits(tmp_path: Path) -> None:
    arguments = shlex.split(
        "--preset smoke --tasks 6 --updates 2 --epoch 1 --scenarios 2 --validation-scenarios 4 --embedding 8 --heads 2"
    )
    train_command([*arguments, "--out", str(tmp_path / "here"), "--prepare"])
    assert not (tmp_path / "here" / "policy.safetensors").exists()
    (tmp_path / "here").rename(tmp_path / "elsewhere")
    train_command(["--out", str(tmp_path / "elsewhere"), "--resume"])
    train_command([*arguments, "--out", str(tmp_path / "straight")])
    for file in ("policy.safetensors", "history.csv"):
        assert (tmp_path / "elsewhere" / file).read_bytes() == (tmp_path / "straight" / file).read_bytes()


@pytest.mark.parametrize("workers", ["0", "5000"])
def test_number_of_workers_is_checked(tmp_path: Path, workers: str) -> None:
    with pytest.raises(ConfigError, match="expected a whole number from 1 to"):
        train_command(["--preset", "smoke", "--out", str(tmp_path), "--workers", workers])


def test_one_process_at_a_time(tmp_path: Path) -> None:
    checkpoint.start(tmp_path, TINY)
    with FileLock(tmp_path / ".lock"), pytest.raises(ConfigError, match="is in use by another run; wait until"):
        train_command(["--out", str(tmp_path), "--resume"])
    assert not (tmp_path / "checkpoints").exists()
    train_command(["--out", str(tmp_path), "--resume"])
    with FileLock(tmp_path / ".lock", timeout=0):
        assert (tmp_path / "policy.json").exists()


@pytest.mark.parametrize("still_runs", [True, False])
def test_a_run_begun_at_the_same_time_is_let_be(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, still_runs: bool
) -> None:
    theirs, make = FileLock(tmp_path / ".lock"), checkpoint.Reinforce

    def make_while_another_begins(*arguments: object, **options: object) -> Reinforce:
        (tmp_path / "config.json").write_text("theirs")
        if still_runs:
            theirs.acquire()
        return make(*arguments, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(checkpoint, "Reinforce", make_while_another_begins)
    says = "is in use by another run; wait until" if still_runs else "already holds a run; go on with it"
    with pytest.raises(ConfigError, match=says):
        train_command(["--preset", "smoke", "--out", str(tmp_path)])
    theirs.release()
    assert (tmp_path / "config.json").read_text() == "theirs"


def test_a_folder_is_free_once_a_run_is_begun_there(tmp_path: Path) -> None:
    lock = lock_folder(tmp_path)  # the same object, which would still be locked
    lock.release()
    checkpoint.start(tmp_path, TINY)
    assert not lock.is_locked


def test_a_run_is_resumed_from_what_another_process_left_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    checkpoint.start(tmp_path, TINY)
    held = []

    def resume(folder: Path, _: object) -> None:
        held.append(FileLock(folder / ".lock", is_singleton=True).is_locked)
        raise ConfigError("seen")

    monkeypatch.setattr(checkpoint, "resume", resume)
    with pytest.raises(ConfigError, match="seen"):
        train_command(["--out", str(tmp_path), "--resume"])
    assert held == [True]


def test_half_written_checkpoint_is_ignored(tmp_path: Path) -> None:
    run = checkpoint.start(tmp_path, TINY)
    run.validate()
    checkpoint.save(tmp_path, run, 0.0)
    (tmp_path / "checkpoints" / "00000002.partial").mkdir()
    assert checkpoint.resume(tmp_path)[0].update == 0


def test_best_policy_is_kept_and_loads(tmp_path: Path) -> None:
    run = checkpoint.start(tmp_path / "mine", TINY)
    for event in run.run():
        if isinstance(event, Validation):
            checkpoint.save(tmp_path / "mine", run, 0.0)
    best = max(run.history, key=lambda each: each.completion)
    policy = load_policy(tmp_path / "mine")
    assert policy.name == "mine"
    assert policy.info.trained["validation_completion"] == best.completion
    assert policy.info.network == TINY.network


def test_a_run_may_start_from_another_and_resume_without_it(tmp_path: Path) -> None:
    first = checkpoint.start(tmp_path / "first", TINY)
    first.validate()
    checkpoint.save(tmp_path / "first", first, 0.0)
    config = replace(TINY, seed=1, initial=str(tmp_path / "first"), baseline="rollout")
    second = checkpoint.start(tmp_path / "second", config)
    for name, value in weights(load_policy(tmp_path / "first")).items():  # type: ignore[arg-type]
        assert torch.equal(value, weights(second)[name])
    second.validate()
    checkpoint.save(tmp_path / "second", second, 0.0)
    (tmp_path / "first").rename(tmp_path / "elsewhere")
    resumed, _ = checkpoint.resume(tmp_path / "second")
    list(second.run()), list(resumed.run())
    for name, value in weights(second).items():
        assert torch.equal(value, weights(resumed)[name])
    with pytest.raises(ConfigError, match=r"which has embedding 32 \(the run: 128\), heads 4 \(the run: 8\); expected"):
        Reinforce(replace(TINY, initial=str(tmp_path / "elsewhere"), network=NetworkConfig()))


def test_a_run_may_start_from_weights_that_looked_at_fewer_tasks_and_peers(tmp_path: Path) -> None:
    few = replace(TINY.network, decoder="candidates", decision_layers=1, candidates=3, peers=1)
    first = checkpoint.start(tmp_path / "first", replace(TINY, network=few))
    first.validate()
    checkpoint.save(tmp_path / "first", first, 0.0)
    more = replace(TINY, network=replace(few, candidates=5, peers=2), initial=str(tmp_path / "first"))
    second = Reinforce(more)
    assert second.network.config == more.network
    for name, value in weights(first).items():
        assert torch.equal(value, weights(second)[name])
    with pytest.raises(ConfigError, match=r"which has decision_layers 1 \(the run: 2\); expected"):
        Reinforce(replace(more, network=replace(more.network, decision_layers=2)))


def test_a_run_whose_scenarios_cannot_be_drawn_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"tasks is \(10000000, 10000000\)"):
        checkpoint.start(tmp_path / "run", replace(TINY, tasks=(10_000_000,), reference_tasks=10_000_000))
    assert not (tmp_path / "run").exists()


def test_a_folder_holds_one_run(tmp_path: Path) -> None:
    checkpoint.start(tmp_path, TINY)
    with pytest.raises(ConfigError, match=r"already holds a run; go on with it \(--resume\)"):
        checkpoint.start(tmp_path, TINY)
    with pytest.raises(ConfigError, match=r"holds no run to resume"):
        checkpoint.resume(tmp_path / "elsewhere")


def _saved(tmp_path: Path) -> Path:
    run = checkpoint.start(tmp_path, TINY)
    run.validate()
    checkpoint.save(tmp_path, run, 0.0)  # the best so far: there is a policy
    run.step()
    run.validate()
    checkpoint.save(tmp_path, run, 0.0)
    return tmp_path / "checkpoints" / "00000001"


@pytest.mark.parametrize(
    ("file", "content", "sentence"),
    [
        ("network.safetensors", b"garbage", "not a readable safetensors file"),
        ("network.safetensors", None, "no such file"),
        ("optimizer.safetensors", b"", "not a readable safetensors file"),
        ("state.json", b"{", "state.json"),
        ("state.json", b'{"update": "two", "seconds": 1, "history": []}', r"Expected `int`, got `str`"),
        ("state.json", b'{"update": 1, "seconds": 1, "history": [], "extra": 1}', "unknown field 'extra'"),
        ("../../config.json", b'{"updates": 5, "learning_rte": 1}', "unknown field 'learning_rte'"),
        ("../../config.json", b'{"updates": -5}', "updates is -5; expected a whole number >= 1"),
    ],
)
def test_damaged_run_is_told_in_a_sentence(tmp_path: Path, file: str, content: bytes | None, sentence: str) -> None:
    path = _saved(tmp_path) / file
    path.unlink() if content is None else path.write_bytes(content)
    with pytest.raises(ConfigError, match=sentence):
        checkpoint.resume(tmp_path)


FIRST = "encoder.embed.weight"


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda t: {}, "is missing"),
        (lambda t: {**t, f"{FIRST}/exp_avg": torch.zeros(3)}, "is not a finite float32 tensor of shape"),
        (lambda t: {**t, f"{FIRST}/exp_avg": t[f"{FIRST}/exp_avg"].double()}, "is not a finite float32 tensor"),
        (lambda t: {**t, f"{FIRST}/step": torch.zeros(3)}, r"is not a finite float32 tensor of shape \(\)"),
        (lambda t: {**t, f"{FIRST}/step": torch.tensor(-5.0)}, "has impossible moments"),
        (lambda t: {**t, f"{FIRST}/exp_avg_sq": t[f"{FIRST}/exp_avg_sq"] - 1}, "has impossible moments"),
        (lambda t: {**t, f"{FIRST}/exp_avg": t[f"{FIRST}/exp_avg"] * torch.nan}, "is not a finite float32 tensor"),
        (lambda t: {**t, "more": torch.zeros(1)}, "tensor 'more' belongs to no weight"),
    ],
)  # fmt: skip
def test_a_damaged_optimizer_is_told_in_a_sentence(
    tmp_path: Path, change: Callable[[dict[str, Tensor]], dict[str, Tensor]], sentence: str
) -> None:
    file = _saved(tmp_path) / "optimizer.safetensors"
    write_tensors(file, change(read_tensors(file)))
    with pytest.raises(ConfigError, match=sentence):
        checkpoint.resume(tmp_path)


def test_what_could_not_be_begun_can_be_begun_again(tmp_path: Path) -> None:
    (tmp_path / "checkpoints").mkdir()  # as an earlier version left it where the disk was full
    checkpoint.start(tmp_path, TINY)


def test_robots_that_never_decided_have_nothing_to_remember(tmp_path: Path) -> None:
    # The first update sees a single scenario, of a robot or two: the last of three networks has no gradient yet.
    run = checkpoint.start(tmp_path, replace(TINY, sharing="independent", scenarios=1, seed=1))
    run.validate()
    checkpoint.save(tmp_path, run, 0.0)
    run.step()
    run.validate()
    checkpoint.save(tmp_path, run, 0.0)
    resumed, _ = checkpoint.resume(tmp_path)
    assert len(resumed.optimizer.state) == len(run.optimizer.state) < len(list(run.network.parameters()))


def test_other_files_among_checkpoints_are_let_be(tmp_path: Path) -> None:
    (_saved(tmp_path).parent / "²").mkdir()
    assert checkpoint.resume(tmp_path)[0].update == 1


def test_a_checkpoint_without_history_is_damaged(tmp_path: Path) -> None:
    file = _saved(tmp_path) / "state.json"
    file.write_text('{"update": 1, "seconds": 1, "history": []}')
    with pytest.raises(ConfigError, match="history is empty; the checkpoint is damaged"):
        checkpoint.resume(tmp_path)


def test_a_full_disk_is_told_with_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = checkpoint.start(tmp_path, TINY)
    run.validate()

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(checkpoint, "write_tensors", full)
    with pytest.raises(ConfigError, match=r"can't write a checkpoint there \(No space left on device\)"):
        checkpoint.save(tmp_path, run, 0.0)


@pytest.mark.parametrize(
    ("dtype", "message"),
    [(torch.int64, "holds torch.int64; expected float"), (torch.float8_e4m3fn, "holds torch.float8_e4m3fn")],
)
def test_weights_of_other_numbers_are_refused(tmp_path: Path, dtype: torch.dtype, message: str) -> None:
    _saved(tmp_path)
    tensors = read_tensors(tmp_path / "policy.safetensors")
    write_tensors(tmp_path / "policy.safetensors", {name: value.to(dtype) for name, value in tensors.items()})
    with pytest.raises(ConfigError, match=message):
        load_policy(tmp_path)


def test_no_more_networks_are_made_than_there_are(tmp_path: Path) -> None:
    run = checkpoint.start(tmp_path, replace(TINY, sharing="independent"))
    run.validate()
    checkpoint.save(tmp_path, run, 0.0)
    info = json.loads((tmp_path / "policy.json").read_text())
    for robots, message in ((10**9, r"holds networks of \d robots; its JSON says that robots is 1000000000"),
                            (0, "robots is 0; expected a whole number >= 1")):  # fmt: skip
        (tmp_path / "policy.json").write_text(json.dumps({**info, "robots": robots}))
        with pytest.raises(ConfigError, match=message):
            load_policy(tmp_path)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"embedding": 64}, r"has shape .*; the architecture needs"),
        ({"embedding": 4096, "heads": 1, "decoder": "candidates", "decision_layers": 64}, "the architecture needs"),
        ({"moments": 4}, "is missing; the weights belong to another architecture"),
        ({"decoder": "candidates"}, "is missing; the weights belong to another architecture"),
        ({"moments": 2}, "has (no place in the architecture|shape)"),
        ({"embeding": 32}, "unknown field 'embeding'"),
        ({"heads": "four"}, r"Expected `int`, got `str`"),
    ],
)
def test_policy_that_does_not_fit_is_refused(tmp_path: Path, change: dict[str, object], sentence: str) -> None:
    _saved(tmp_path)
    info = json.loads((tmp_path / "policy.json").read_text())
    info["network"].update(change)
    (tmp_path / "policy.json").write_text(json.dumps(info))
    with pytest.raises(ConfigError, match=sentence):
        load_policy(tmp_path)


def test_weights_that_are_not_finite_are_refused(tmp_path: Path) -> None:
    run = Reinforce(TINY)
    run.validate()
    with torch.no_grad():
        next(run.network.parameters())[0] = float("nan")
    from mrta_zoo.policies.neural.weights import save_policy

    save_policy(tmp_path / "policy.safetensors", run.network, checkpoint.policy_info(run, 0.0))
    with pytest.raises(ConfigError, match="not finite"):
        load_policy(tmp_path)


def test_unknown_policy_is_told(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"there is no policy 'capm'; expected one of"):
        load_policy("capm")


@pytest.mark.parametrize("change", [{"network": NetworkConfig(encoder="foo")}, {"initial": "nothing"}])
def test_a_refused_start_leaves_nothing_behind(tmp_path: Path, change: dict[str, object]) -> None:
    with pytest.raises(ConfigError):
        checkpoint.start(tmp_path / "run", replace(TINY, **change))  # type: ignore[arg-type]
    assert not (tmp_path / "run").exists()
    checkpoint.start(tmp_path / "run", TINY)
