"""The precision of matrix products."""

from __future__ import annotations

from typing import Literal

import torch

Precision = Literal["float32", "bfloat16"]


def autocast(device: torch.device, precision: Precision, cache: bool = True) -> torch.autocast:
    """A context in which matrix products on `device` have that precision; scores and sums stay float32.

    Args:
        device: where the products are.
        precision: theirs.
        cache: whether weights that were converted once may be used again within the context.
    """
    return torch.autocast(device.type, dtype=torch.bfloat16, enabled=precision == "bfloat16", cache_enabled=cache)
