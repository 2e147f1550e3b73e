"""The shape of a network, as saved beside its weights."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

from mrta_zoo.errors import ConfigError


@dataclass(frozen=True, slots=True)
class NetworkConfig:
    """Architecture of one policy network. The defaults are the paper's (§III and §IV-C).

    Attributes:
        encoder: "capsule" for CapAM, "attention" for the attention model (AM-RL), "none" for a linear
            map of each task by itself, or one of your own (`ENCODERS`).
        embedding: h, length of embeddings and of the query; a multiple of `heads`.
        heads: number of attention heads, in the decoder and in the attention encoder.
        layers: L_e, number of encoder layers (1 in CapAM, 3 in AM).
        hops: K, degree of the capsule filters.
        moments: P, highest order of the capsules' moments.
        decoder: "attention" for the paper's; "candidates" for CapAM+, which looks at what matters at the time of the
            decision (`mrta_zoo.policies.neural.capam.candidates`).
        decision_layers: number of layers of the "candidates" decoder.
        candidates: how many of the tasks that a robot may choose that decoder looks at, the quickest ones. No weight
            depends in shape on this or on `peers`: a network may decide with more than it was trained with.
        peers: how many of the robot's peers that decoder looks at, the nearest ones.
        node_features: what the encoder knows of each task, names in `mrta_zoo.policies.neural.capam.node_features`. The
            paper has x, y and deadline, and allows more; the default adds workload and two features that relate
            deadlines and workloads to the size of the map.
        context_features: what the "attention" decoder knows of the state besides the paper's features, names in
            `mrta_zoo.policies.neural.capam.context`, all of them users' own.
        tanh_clip: scores are clipped to ± this, as in Kool et al. (2019).
    """

    encoder: str = "capsule"
    embedding: int = 128
    heads: int = 8
    layers: int = 1
    hops: int = 2
    moments: int = 3
    decoder: str = "attention"
    decision_layers: int = 4
    candidates: int = 40
    peers: int = 8
    node_features: tuple[str, ...] = (
        "x",
        "y",
        "deadline",
        "deadline_in_crossings",
        "workload",
        "workload_in_crossings",
    )
    context_features: tuple[str, ...] = ()
    tanh_clip: float = 10.0

    def __post_init__(self) -> None:
        for name, least, most in (
            ("embedding", 1, 4096), ("heads", 1, 256), ("layers", 1, 64), ("moments", 1, 16), ("hops", 0, 16),
            ("decision_layers", 0, 64), ("candidates", 1, 10_000), ("peers", 0, 10_000),
        ):  # fmt: skip
            if not least <= getattr(self, name) <= most:
                raise ConfigError(f"{name} is {getattr(self, name)}; expected a whole number from {least} to {most}")
        if self.embedding % self.heads:
            raise ConfigError(f"embedding is {self.embedding}; expected a multiple of heads, {self.heads}")
        if self.decoder not in ("attention", "candidates"):
            raise ConfigError(f"decoder is {self.decoder!r}; expected attention or candidates")
        if self.context_features and self.decoder != "attention":
            raise ConfigError(
                f"context_features is {self.context_features}; expected none with decoder {self.decoder!r}, which has "
                "no context"
            )
        if not self.node_features:
            raise ConfigError("node_features is empty; expected at least one feature")
        if not 0 < self.tanh_clip < math.inf:
            raise ConfigError(f"tanh_clip is {self.tanh_clip}; expected a number > 0")

    def differences(self, other: NetworkConfig) -> dict[str, tuple[Any, Any]]:
        """The settings in which two networks cannot share weights: all that differ, except `candidates` and `peers`."""
        values = {each.name: (getattr(self, each.name), getattr(other, each.name)) for each in fields(self)}
        return {
            name: pair for name, pair in values.items() if name not in ("candidates", "peers") and pair[0] != pair[1]
        }
