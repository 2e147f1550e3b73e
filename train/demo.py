"""The short training run of `mrta-zoo demo`."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from mrta_zoo.train import checkpoint
from mrta_zoo.train.presets import PRESETS
from mrta_zoo.train.progress import train
from mrta_zoo.train.reinforce import Validation


def short_training(folder: Path, console: Console | None = None) -> list[Validation]:
    """Train a small CapAM from scratch for a minute or so (preset "smoke"). `folder` must not hold a run yet.

    Returns:
        The validation history: it rises visibly.
    """
    run = checkpoint.start(folder, PRESETS["smoke"])
    train(run, folder, console=console)
    return run.history
