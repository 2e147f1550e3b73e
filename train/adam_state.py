"""Adam's state as named tensors, for checkpoints."""

from __future__ import annotations

from pathlib import Path

import torch
from torch import Tensor, nn

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.weights import read_tensors

KEYS = ("step", "exp_avg", "exp_avg_sq")
"""Adam's state of one weight: the number of steps, and the first and second moments."""


def adam_tensors(optimizer: torch.optim.Adam, network: nn.Module) -> dict[str, Tensor]:
    """Adam's state, named after the network's weights: ``NAME/step``, ``NAME/exp_avg``, ``NAME/exp_avg_sq``."""
    return {
        f"{name}/{key}": value
        for name, parameter in network.named_parameters()
        for key, value in optimizer.state.get(parameter, {}).items()
    }


def restore_adam(optimizer: torch.optim.Adam, network: nn.Module, path: Path, updates: int, complete: bool) -> None:
    """Restore Adam's state from a file.

    Args:
        optimizer: a fresh one, for the network's weights.
        network: the network.
        path: a safetensors file of `adam_tensors`.
        updates: number of updates before the file was written.
        complete: whether the file must hold the state of every weight.

    Raises:
        ConfigError: if the file is missing or damaged, or cannot belong to this network after that many updates.
    """
    tensors = read_tensors(path)
    for name, parameter in network.named_parameters():
        state = {key: tensors.pop(f"{name}/{key}") for key in KEYS if f"{name}/{key}" in tensors}
        if state or complete:
            _check(state, parameter, f"{path}: {name}", updates)
            # Adam keeps its step counter on the CPU, its moments beside the parameter.
            optimizer.state[parameter] = {
                key: value if key == "step" else value.to(parameter.device) for key, value in state.items()
            }
    if tensors:
        raise ConfigError(f"{path}: tensor {next(iter(tensors))!r} belongs to no weight; the checkpoint is damaged")
    if updates and not optimizer.state:
        raise ConfigError(f"{path}: there is nothing in it; the checkpoint is damaged")


def _check(state: dict[str, Tensor], parameter: Tensor, where: str, updates: int) -> None:
    """Raises `ConfigError` unless this can be Adam's state of a parameter."""
    for key, shape in zip(KEYS, ((), parameter.shape, parameter.shape), strict=True):
        if key not in state:
            raise ConfigError(f"{where}/{key} is missing; the checkpoint is damaged")
        value = state[key]
        if value.dtype != torch.float32 or value.shape != shape or not torch.isfinite(value).all():
            raise ConfigError(
                f"{where}/{key} is not a finite float32 tensor of shape {tuple(shape)}; the checkpoint is damaged"
            )
    if not 1 <= float(state["step"]) <= updates or (state["exp_avg_sq"] < 0).any():
        raise ConfigError(f"{where} has impossible moments; the checkpoint is damaged")
