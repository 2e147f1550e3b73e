"""The precision of matrix products."""

from __future__ import annotations

from typing import Literal

import torch

Precision = Literal["float32", "bfloat16"]


def autocast(device: torch.device, precision: Precision, cache: bool = True) -> torch.autocast:
    """A context in which matrix products on a GPU have that precision; scores and sums stay float32, as does a CPU.

    Args:
        device: where the products are.
        precision: theirs.
        cache: whether weights that were converted once may be used again within the context.
    """
    enabled = precision == "bfloat16" and device.type == "cuda"
    return torch.autocast(device.type, dtype=torch.bfloat16, enabled=enabled, cache_enabled=cache)
