"""A training run on disk: it survives `kill -9` at any moment, and resumes to the same result.

A run's folder holds::

    config.json                        the TrainConfig
    checkpoints/00000050/              one folder per checkpoint, named after the update; it appears all at once
        network.safetensors            the weights
        optimizer.safetensors          Adam's moments
        baseline.safetensors           the baseline's state: weights (rollout), the average (exponential)
        state.json                     update, time spent, validation history
    plans/*.npz                        the plans to imitate, if any
    policy.safetensors, policy.json    the policy with the best validation so far
    history.csv                        the validation history, for people and plots
"""

from __future__ import annotations

import os
import shutil
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import torch

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.dataclass_json import read_json, write_json
from mrta_zoo.io.lock import lock_folder
from mrta_zoo.io.paths import check_no_url, make_folder
from mrta_zoo.io.records import write_records
from mrta_zoo.io.text_files import check_name
from mrta_zoo.policies.neural.weights import PolicyInfo, load_state, read_tensors, save_policy, write_tensors
from mrta_zoo.train.adam_state import adam_tensors, restore_adam
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.distribution import most_robots
from mrta_zoo.train.reinforce import Reinforce, RunOptions, Validation


@dataclass(frozen=True, slots=True)
class RunState:
    """What a checkpoint holds besides tensors."""

    update: int
    seconds: float
    """Time spent training, over all sessions."""
    history: list[Validation]


def start(folder: Path, config: TrainConfig, options: RunOptions | None = None) -> Reinforce:
    """Begin a run in a new or empty folder.

    Raises:
        ConfigError: if the folder already holds a run, another process is using it, it can't be written, or its
            name cannot be a policy's.
    """
    check_no_url(folder, ConfigError)
    _check_new(folder)
    check_name(folder.name, str(folder), "the policy's name", ConfigError)  # stored in its plans as their method
    run = Reinforce(config, options=options)  # before anything is written: it may refuse the configuration
    try:
        make_folder(folder)
        lock = lock_folder(folder)
        try:
            _check_new(folder)  # another process may have begun one meanwhile
            write_json(folder / "config.json", config)
        finally:
            lock.release()
    except OSError as error:
        raise ConfigError(f"{folder}: can't write a run there ({error.strerror})") from None
    return run


def _check_new(folder: Path) -> None:
    if os.path.lexists(folder / "config.json") or _entries(folder / "checkpoints"):
        raise ConfigError(f"{folder} already holds a run; go on with it (--resume), or choose another folder")


def resume(folder: Path, options: RunOptions | None = None) -> tuple[Reinforce, float]:
    """The run in `folder` as of its last checkpoint, and the seconds spent so far.

    Raises:
        ConfigError: if there is no run, or its files are damaged.
    """
    config = saved_config(folder)
    numbers = _checkpoints(folder)
    if not numbers:
        return Reinforce(config, options=options), 0.0
    # The checkpoint holds the weights; the policy that the run began from may be gone by now.
    run = Reinforce(replace(config, initial=""), options=options)
    run.config = config
    at = folder / "checkpoints" / _name(numbers[-1])
    state = read_json(at / "state.json", RunState)
    load_state(run.network, read_tensors(at / "network.safetensors"), at / "network.safetensors")
    # Weights without a gradient so far have no state: all before the first update, those of robots that never decided.
    complete = state.update > 0 and config.sharing == "shared"
    restore_adam(run.optimizer, run.network, at / "optimizer.safetensors", state.update, complete)
    # Before its first update of REINFORCE a baseline may have nothing to remember yet.
    if config.baseline != "samples" and (run.baseline.state() or state.update > config.imitation_updates):
        run.baseline.restore(read_tensors(at / "baseline.safetensors"), at / "baseline.safetensors")
    if state.update != numbers[-1] or state.update > config.total_updates:
        raise ConfigError(f"{at / 'state.json'}: update is {state.update}; expected {numbers[-1]}, as the folder says")
    if not state.history:
        raise ConfigError(f"{at / 'state.json'}: history is empty; the checkpoint is damaged")
    run.update = state.update
    run.history = list(state.history)
    return run, state.seconds


def saved_config(folder: Path) -> TrainConfig:
    """The configuration of the run in `folder`.

    Raises:
        ConfigError: if there is no run.
    """
    check_no_url(folder, ConfigError)
    if not os.path.exists(folder / "config.json"):
        raise ConfigError(f"{folder} holds no run to resume: there is no config.json")
    return read_json(folder / "config.json", TrainConfig)


def seconds_spent(folder: Path) -> float:
    """Time spent training the run in `folder`, as of its last checkpoint.

    Raises:
        ConfigError: if there is no checkpoint, or it is damaged.
    """
    numbers = _checkpoints(folder)
    if not numbers:
        raise ConfigError(f"{folder} holds no checkpoint; expected the folder of a training run")
    return read_json(folder / "checkpoints" / _name(numbers[-1]) / "state.json", RunState).seconds


def save(folder: Path, run: Reinforce, seconds: float) -> None:
    """Write a checkpoint of a run just validated, drop old checkpoints, and keep the best policy.

    Raises:
        ConfigError: if it cannot be written; the last checkpoint is then untouched.
    """
    try:
        _save(folder, run, seconds)
    except OSError as error:
        raise ConfigError(f"{folder}: can't write a checkpoint there ({error.strerror})") from None


def _save(folder: Path, run: Reinforce, seconds: float) -> None:
    final = folder / "checkpoints" / _name(run.update)
    partial = final.with_name(final.name + ".partial")
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    write_tensors(partial / "network.safetensors", dict(run.network.state_dict()))
    write_tensors(partial / "optimizer.safetensors", adam_tensors(run.optimizer, run.network))
    if baseline := run.baseline.state():
        write_tensors(partial / "baseline.safetensors", baseline)
    write_json(partial / "state.json", RunState(run.update, round(seconds, 1), run.history))
    if not os.path.lexists(folder / "config.json"):  # the folder was deleted meanwhile, and is a new one
        write_json(folder / "config.json", run.config)
    # Before the checkpoint counts: a run killed in between validates again and writes the same policy.
    if run.history[-1] is run.best or not os.path.lexists(folder / "policy.safetensors"):
        save_policy(folder / "policy.safetensors", run.network, policy_info(run, seconds))
    write_records(run.history, folder / "history.csv")
    shutil.rmtree(final, ignore_errors=True)
    os.replace(partial, final)
    for number in _checkpoints(folder)[: -run.config.keep_checkpoints]:
        shutil.rmtree(folder / "checkpoints" / _name(number), ignore_errors=True)


def policy_info(run: Reinforce, seconds: float) -> PolicyInfo:
    """The description that is saved beside a run's policy.

    Raises:
        ConfigError: if the run has not validated yet.
    """
    if not run.history:
        raise ConfigError("the run has not validated yet; call run.validate() first")
    config, last = run.config, run.history[-1]
    trained = {
        "config": asdict(config),
        "updates": run.update,
        "episodes": last.episodes,
        "seconds": round(seconds),
        "torch": str(torch.__version__),
        "device": run.device.type,
        "threads": torch.get_num_threads(),
        "validation_completion": last.completion,
        "validation_cost": last.cost,
    }
    return PolicyInfo(
        network=config.network,
        sharing=config.sharing,
        robots=most_robots(config),
        kinds=config.kinds,
        mask_rule=config.mask_rule,
        trained=trained,
    )


def _checkpoints(folder: Path) -> list[int]:
    return sorted(int(name) for name in _entries(folder / "checkpoints") if name.isascii() and name.isdigit())


def _entries(folder: Path) -> list[str]:
    return [each.name for each in folder.iterdir()] if folder.is_dir() else []


def _name(update: int) -> str:
    return f"{update:08d}"
