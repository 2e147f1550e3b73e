"""Trained policies on disk: `NAME.safetensors` holds the weights, `NAME.json` beside it describes them.

Nothing is ever unpickled, so a policy from a stranger can be loaded safely.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import torch
from safetensors import SafetensorError
from safetensors.torch import load_file, save

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.atomic import replacing
from mrta_zoo.io.dataclass_json import read_json, write_json
from mrta_zoo.io.paths import check_no_url
from mrta_zoo.io.stand_ins import why_unreadable
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.policy_files import info_file
from mrta_zoo.policies.neural.sharing import USUAL_KINDS, Network, Sharing, build_network
from mrta_zoo.rules import MaskRule
from mrta_zoo.wording import counted

FLOATS = (torch.float16, torch.bfloat16, torch.float32, torch.float64)
"""Types that weights may be saved as."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PolicyInfo:
    """Description of a set of weights.

    Attributes:
        network: architecture.
        sharing: "shared", "independent" or "by-capacity".
        robots: number of networks, if independent; >= 1.
        kinds: of robots, if by capacity, as shares of the strongest robot's.
        mask_rule: the mask rule it was trained under.
        trained: how it was trained, for people to read.
        format: always "mrta_zoo.policy".
        version: of the format.
    """

    network: NetworkConfig
    sharing: Sharing = "shared"
    robots: int = 1
    kinds: tuple[float, ...] = USUAL_KINDS
    mask_rule: MaskRule = "feasible"
    trained: dict[str, Any] = field(default_factory=dict)
    format: Literal["mrta_zoo.policy"] = "mrta_zoo.policy"
    version: Literal[1] = 1

    def __post_init__(self) -> None:
        if self.robots < 1:
            raise ConfigError(f"robots is {self.robots}; expected a whole number >= 1")


def save_policy(path: Path, network: Network, info: PolicyInfo) -> None:
    """Write `path` (….safetensors) and the JSON beside it, each through `replacing`.

    Raises:
        ConfigError: if `path` is a URL.
        OSError: if a file cannot be written.
    """
    check_no_url(path, ConfigError)
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_tensors(path, dict(network.state_dict()))
    write_json(path.with_suffix(".json"), info)


def load_weights(path: Path) -> tuple[Network, PolicyInfo]:
    """Read a policy written by `save_policy`.

    Raises:
        ConfigError: if a file is missing or malformed, or the weights don't fit the architecture.
    """
    check_no_url(path, ConfigError)
    path = Path(path)
    info = read_json(info_file(path), PolicyInfo)
    return build_with(read_tensors(path), info, path).eval(), info


def build_with(tensors: dict[str, torch.Tensor], info: PolicyInfo, path: Path) -> Network:
    """The network that `info` describes, with these weights; nothing large is allocated before they are known to fit.

    Args:
        tensors: the weights.
        info: what they should belong to.
        path: where they come from, for messages.

    Raises:
        ConfigError: if the weights don't fit the architecture.
    """
    if info.sharing == "independent":  # checked before that many networks are made
        there = len({name.split(".")[1] for name in tensors if name.startswith("robots.")})
        if there != info.robots:
            raise ConfigError(
                f"{path}: holds networks of {counted(there, 'robot')}; its JSON says that robots is {info.robots}"
            )

    def build() -> Network:
        return build_network(info.network, info.sharing, info.robots, seed=0, kinds=info.kinds)

    with torch.device("meta"):
        _check_fit(build().state_dict(), tensors, path)
    network = build()
    network.load_state_dict(tensors)
    return network


def write_tensors(path: Path, tensors: dict[str, torch.Tensor]) -> None:
    """Write tensors to a safetensors file, through `replacing`."""
    with replacing(path) as partial:
        # Not `save_file`, which makes files that only their owner can read.
        partial.write_bytes(save({name: tensor.detach().cpu().contiguous() for name, tensor in tensors.items()}))


def read_tensors(path: Path) -> dict[str, torch.Tensor]:
    """Read a safetensors file.

    Raises:
        ConfigError: if it is missing or malformed.
    """
    try:
        return dict(load_file(path))
    except FileNotFoundError:
        raise ConfigError(f"{path}: no such file; expected weights in a .safetensors file") from None
    except (SafetensorError, OSError, ValueError) as error:
        raise ConfigError(f"{path}: not a readable safetensors file{why_unreadable(path, error)}") from None


def load_state(network: Network, tensors: dict[str, torch.Tensor], path: Path) -> None:
    """Load tensors into a network, all of them or none.

    Raises:
        ConfigError: if a tensor is missing, left over, of another shape, not of floating point, or not finite.
    """
    _check_fit(network.state_dict(), tensors, path)
    network.load_state_dict(tensors)


def _check_fit(expected: dict[str, torch.Tensor], tensors: dict[str, torch.Tensor], path: Path) -> None:
    for name, tensor in expected.items():
        if name not in tensors:
            raise ConfigError(
                f"{path}: tensor {name!r} is missing; the weights belong to another architecture, or a policy that an "
                "earlier version saved has to be trained anew"
            )
        if tensors[name].shape != tensor.shape:
            raise ConfigError(
                f"{path}: tensor {name!r} has shape {tuple(tensors[name].shape)}; "
                f"the architecture needs {tuple(tensor.shape)}; a policy that an earlier version saved may have to be "
                "trained anew"
            )
        if tensors[name].dtype not in FLOATS:
            raise ConfigError(f"{path}: tensor {name!r} holds {tensors[name].dtype}; expected floating-point numbers")
        if not torch.isfinite(tensors[name]).all():
            raise ConfigError(f"{path}: tensor {name!r} holds numbers that are not finite")
    for name in tensors:
        if name not in expected:
            raise ConfigError(f"{path}: tensor {name!r} has no place in the architecture")
