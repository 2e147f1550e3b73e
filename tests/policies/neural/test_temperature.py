"""Temperature by hand."""

from __future__ import annotations

import math
from typing import Any

import pytest
import torch

from mrta_zoo.policies.neural.temperature import tempered


class Fixed:
    """Always the same probabilities: 0.8, 0.2, and one that may not be chosen."""

    def __init__(self) -> None:
        self.log_probs = torch.tensor([[[math.log(0.8), math.log(0.2), -math.inf]]], requires_grad=True)

    def encode(self, tasks: Any) -> Any:
        return tasks

    def features(self, encoding: Any, moments: Any) -> Any:
        return None

    def __call__(self, encoding: Any, moments: Any, features: Any = None) -> Any:
        return self.log_probs


@pytest.mark.parametrize(
    ("temperature", "likeliest"),
    [
        (0.5, 0.64 / 0.68),  # squares: 0.64 and 0.04
        (1.0, 0.8),
        (2.0, 2 / 3),  # roots: 0.894 and 0.447, twice as much
    ],
)
def test_probabilities_by_hand(temperature: float, likeliest: float) -> None:
    network = Fixed()
    log_probs = tempered(network, temperature)(None, None)  # type: ignore[arg-type]
    assert log_probs.exp()[0, 0].tolist() == pytest.approx([likeliest, 1 - likeliest, 0.0])
    log_probs[0, 0, 0].backward()
    assert network.log_probs.grad is not None
    assert not network.log_probs.grad.isnan().any()


def test_at_one_it_is_the_network_itself() -> None:
    network = Fixed()
    assert tempered(network, 1.0) is network
