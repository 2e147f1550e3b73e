"""Taking over what a run on a bare machine left (`mrta_zoo.train.bare`)."""

from __future__ import annotations

import json
import zipfile
from dataclasses import asdict
from pathlib import Path

import numpy as np
import torch

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.records import write_records
from mrta_zoo.policies.sharing import build_network
from mrta_zoo.policies.weights import load_state, save_policy
from mrta_zoo.train.bare import read_config
from mrta_zoo.train.checkpoint import info_of
from mrta_zoo.train.distribution import most_robots
from mrta_zoo.train.reinforce import Validation

BARE = "bare"
"""What `mrta_zoo.train.bare` is told to call its files in a run's folder."""


def collect(folder: Path) -> None:
    """Make the policy and the history of a run's folder from ``bare.npz`` and ``bare.json`` in it.

    Raises:
        ConfigError: if a file is missing or damaged.
    """
    weights, about_run = folder / f"{BARE}.npz", folder / f"{BARE}.json"
    try:
        with np.load(weights, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        about = json.loads(str(arrays.pop("about")))
        history = [Validation(**each) for each in about["history"]]
        config = read_config(about_run)
        to_the_end = [Validation(**each) for each in json.loads(about_run.read_text()).get("history", [])]
    except FileNotFoundError as error:
        raise ConfigError(f"{error.filename}: no such file; expected what mrta_zoo.train.bare leaves") from None
    except (OSError, ValueError, KeyError, TypeError, zipfile.BadZipFile) as error:
        raise ConfigError(f"{weights}: not what mrta_zoo.train.bare leaves ({error})") from None
    network = build_network(config.network, config.sharing, most_robots(config), seed=0, kinds=config.kinds)
    load_state(network, {name: torch.from_numpy(array) for name, array in arrays.items()}, weights)
    trained = {
        "config": asdict(config),
        "updates": about["update"],
        "episodes": history[-1].episodes,
        "seconds": round(about["seconds"]),
        "torch": about["torch"],
        "device": about["device"],
        "threads": about["threads"],
        "validation_completion": history[-1].completion,
        "validation_cost": history[-1].cost,
    }
    save_policy(folder / "policy.safetensors", network, info_of(config, trained))
    # The weights are the best ones, and know what was before them; the run may have gone on.
    write_records(max(history, to_the_end, key=len), folder / "history.csv")
