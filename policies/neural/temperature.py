"""Temperature: the same preferences, with more or less certainty."""

from __future__ import annotations

from typing import Any

from torch import Tensor

from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.rollout import Scorer


def tempered(network: Scorer, temperature: float) -> Scorer:
    """A network whose probabilities p become p^(1/T), normalised; below T = 1 it is surer of the same favourites.

    Args:
        network: gives the log-probabilities.
        temperature: T > 0; at 1 the network itself is returned.
    """
    return network if temperature == 1 else _Tempered(network, temperature)


class _Tempered:
    def __init__(self, network: Scorer, temperature: float) -> None:
        self._network, self._temperature = network, temperature

    def encode(self, tasks: Tasks) -> Any:
        return self._network.encode(tasks)

    def features(self, encoding: Any, states: DecisionStates) -> Any:
        return self._network.features(encoding, states)

    def __call__(self, encoding: Any, states: DecisionStates, features: Any = None) -> Tensor:
        log_probs: Tensor = self._network(encoding, states, features)
        return (log_probs / self._temperature).log_softmax(-1)
