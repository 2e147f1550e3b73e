"""The precision of matrix products, and other choices that a GPU leaves."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import Literal

import torch
from torch.nn.attention import SDPBackend, sdpa_kernel

Precision = Literal["float32", "bfloat16"]


def autocast(device: torch.device, precision: Precision) -> torch.autocast:
    """A context in which matrix products on a GPU have that precision; scores and sums stay float32, as does a CPU.

    Args:
        device: where the products are.
        precision: theirs.
    """
    enabled = precision == "bfloat16" and device.type == "cuda"
    return torch.autocast(device.type, dtype=torch.bfloat16, enabled=enabled)


def quick_attention(device: torch.device) -> AbstractContextManager[None]:
    """A context in which attention among a few tokens, without gradients, is quick on a GPU.

    cuDNN's, which PyTorch would choose, took four times as long (H200).
    """
    if device.type == "cuda":
        return sdpa_kernel([SDPBackend.EFFICIENT_ATTENTION, SDPBackend.MATH])
    return nullcontext()
