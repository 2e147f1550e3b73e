"""Taking over what a run on a bare machine left (`mrta_zoo.train.bare`)."""

from __future__ import annotations

import io
import tokenize
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from pathlib import Path

import msgspec
import numpy as np
import torch

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.records import write_records
from mrta_zoo.io.stand_ins import why_unreadable
from mrta_zoo.policies.neural.weights import build_with, read_json, save_policy
from mrta_zoo.train.checkpoint import info_of
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.imitation.experts import UNREADABLE
from mrta_zoo.train.reinforce import Validation

BARE = "bare"
"""What `mrta_zoo.train.bare` is told to call its files in a run's folder."""


@dataclass(frozen=True, slots=True)
class BareHistory:
    """What ``bare.json`` holds."""

    config: TrainConfig
    history: list[Validation]


@dataclass(frozen=True, slots=True)
class BareState:
    """What ``bare.npz`` holds besides weights; its history ends with theirs."""

    update: int
    seconds: float
    torch: str
    device: str
    threads: int
    history: list[Validation]


def collect(folder: Path) -> None:
    """Make the policy and the history of a run's folder from ``bare.npz`` and ``bare.json`` in it.

    Raises:
        ConfigError: if a file is missing or damaged, the files belong to different runs, or the folder has a run of
            its own, with checkpoints.
    """
    weights, about_run = folder / f"{BARE}.npz", folder / f"{BARE}.json"
    if (folder / "checkpoints").exists():
        raise ConfigError(f"{folder} has checkpoints of a run of its own; expected a folder that was only prepared")
    arrays, state = _read_weights(weights)
    run = read_json(about_run, BareHistory)
    _check_same_run(folder, run.config)
    longer, shorter = sorted((run.history, state.history), key=len, reverse=True)
    if longer[: len(shorter)] != shorter or not _ascending(longer):
        raise ConfigError(f"{about_run}: its history is not that of {weights.name}; do they belong to one run?")
    last = state.history[-1]
    trained = {
        "config": asdict(run.config),
        "updates": state.update,
        "episodes": last.episodes,
        "seconds": round(state.seconds),
        "torch": state.torch,
        "device": state.device,
        "threads": state.threads,
        "validation_completion": last.completion,
        "validation_cost": last.cost,
    }
    info = info_of(run.config, trained)
    network = build_with({name: torch.from_numpy(array) for name, array in arrays.items()}, info, weights)
    save_policy(folder / "policy.safetensors", network, info)
    # The weights are the best ones, and know what was before them; the run may have gone on.
    write_records(longer, folder / "history.csv")


def _read_weights(path: Path) -> tuple[dict[str, np.ndarray], BareState]:
    """Raises `ConfigError` unless the file holds finite float32 arrays and a state that can be."""
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        state = msgspec.convert(msgspec.json.decode(str(arrays.pop("about"))), BareState)
    except FileNotFoundError:
        raise ConfigError(f"{path}: no such file; expected what mrta_zoo.train.bare leaves") from None
    except (*UNREADABLE, AttributeError, NotImplementedError, OverflowError, tokenize.TokenError) as error:
        why = why_unreadable(path, type(error).__name__)
        raise ConfigError(f"{path}: not what mrta_zoo.train.bare leaves{why}") from None
    for name, array in arrays.items():
        if not isinstance(array, np.ndarray) or array.dtype != np.float32:
            raise ConfigError(f"{path}: {name} is no array of float32")
    updates = [each.update for each in state.history]
    if not updates or updates[-1] != state.update or not _ascending(state.history):
        raise ConfigError(f"{path}: its history ends with updates {updates[-3:]}; expected {state.update} at the end")
    return arrays, state


def _ascending(history: list[Validation]) -> bool:
    return all(one.update < other.update for one, other in pairwise(history)) and history[0].update >= 0


def _check_same_run(folder: Path, config: TrainConfig) -> None:
    """Only what `mrta_zoo.train.bare` changes itself may differ from what was prepared."""
    if not (folder / "config.json").exists():
        return
    prepared = read_json(folder / "config.json", TrainConfig)
    same = replace(config, updates=prepared.updates, imitation_plans=prepared.imitation_plans)
    if same != prepared:
        mine, theirs = asdict(same), asdict(prepared)
        name = next(name for name in mine if mine[name] != theirs[name])
        raise ConfigError(
            f"{folder / f'{BARE}.json'}: {name} is {mine[name]!r}; config.json beside it has {theirs[name]!r}: they "
            "belong to different runs"
        )
