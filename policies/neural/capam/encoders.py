"""The encoders that a configuration can name."""

from __future__ import annotations

from collections.abc import Callable

from torch import nn

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.capam.attention_encoder import AttentionEncoder
from mrta_zoo.policies.neural.capam.capsule_encoder import CapsuleEncoder
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.linear_encoder import LinearEncoder
from mrta_zoo.policies.neural.capam.named import Named

EncoderBuilder = Callable[[int, NetworkConfig], nn.Module]
"""Builds, for a number of node features, a module ``(nodes, exists, graph) -> embeddings``.

See `CapsuleEncoder.forward` for the shapes. Padding must not change the embeddings of the tasks, and must itself be
embedded as 0; `tests/policies/neural/test_network.py` checks that, and more, of every encoder in `ENCODERS`.
"""

ENCODERS: Named[EncoderBuilder] = Named(
    "encoder",
    {
        "capsule": lambda features, c: CapsuleEncoder(features, c.embedding, c.layers, c.hops, c.moments),
        "attention": lambda features, c: AttentionEncoder(features, c.embedding, c.layers, c.heads),
        "none": lambda features, c: LinearEncoder(features, c.embedding),
    },
)
"""Encoders by the name that `NetworkConfig.encoder` takes. ``@ENCODERS.register("name")`` adds one of your own."""


def build_encoder(features: int, config: NetworkConfig) -> nn.Module:
    """The encoder that `config` names, for nodes with this many features.

    Raises:
        ConfigError: if there is none of that name, or what it builds is no module.
    """
    encoder: object = ENCODERS.find(config.encoder)(features, config)
    if not isinstance(encoder, nn.Module):
        raise ConfigError(f"encoder {config.encoder!r} builds a {type(encoder).__name__}; expected a torch.nn.Module")
    return encoder
