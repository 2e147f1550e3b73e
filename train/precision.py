"""Numerical choices on a GPU: the precision of matrix products, and the kernel of attention."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import Literal

import torch
from torch.nn.attention import SDPBackend, sdpa_kernel

Precision = Literal["float32", "bfloat16"]


def autocast(device: torch.device, precision: Precision) -> torch.autocast:
    """A context in which matrix products on a GPU have this precision; scores, sums and CPUs stay with float32.

    Args:
        device: where the products are computed.
        precision: of the products.
    """
    enabled = precision == "bfloat16" and device.type == "cuda"
    return torch.autocast(device.type, dtype=torch.bfloat16, enabled=enabled)


def quick_attention(device: torch.device) -> AbstractContextManager[None]:
    """A context in which attention among a few tokens, without gradients, is fast on a GPU.

    PyTorch would choose cuDNN's kernel, which took four times as long (H200).
    """
    if device.type == "cuda":
        return sdpa_kernel([SDPBackend.EFFICIENT_ATTENTION, SDPBackend.MATH])
    return nullcontext()
