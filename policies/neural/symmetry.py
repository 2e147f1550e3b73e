"""The eight symmetries of a map: the same mission, mirrored and turned, as a network sees it.

Only what the network reads is mirrored. The mission itself goes on in the simulator as it is, so that no rounding error
of a symmetry touches what is legal, what is in time, and who acts next.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import torch
from torch import Tensor

from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.rollout import Scorer
from mrta_zoo.scenario_batch import ScenarioBatch

SYMMETRIES = 8
"""Flip x or not, flip y or not, swap the axes or not; number 0 leaves everything as it is."""


@dataclass(frozen=True, slots=True)
class View:
    """How each of S scenarios is seen.

    Attributes:
        flip: (S, 2) bool, whether x and y run backwards.
        swap: (S,) bool, whether the axes are swapped, after flipping.
        extent: (S, 2) width and height of the frame, in the unit of places.
    """

    flip: Tensor
    swap: Tensor
    extent: Tensor

    @classmethod
    def of(cls, scenarios: ScenarioBatch) -> View:
        """The symmetries 0 … 7 over and over, for S scenarios of which every 8 in a row are the same."""
        scales = scenarios.scales
        number = torch.arange(len(scenarios), device=scenarios.device) % SYMMETRIES
        return cls.numbered(number, (scales.extent / scales.length[:, None]).float())

    @classmethod
    def numbered(cls, number: Tensor, extent: Tensor) -> View:
        """The symmetries by their numbers, (S,) int64 in 0 to 7, on maps of these extents."""
        return cls(torch.stack((number & 1, number & 2), -1) > 0, (number & 4) > 0, extent)

    def of_places(self, xy: Tensor) -> Tensor:
        """(S, …, 2) places as seen in each scenario's symmetry."""
        shape = (len(xy), *[1] * (xy.dim() - 2), 2)
        flipped = torch.where(self.flip.view(shape), self.extent.view(shape) - xy, xy)
        return torch.where(self.swap.view((*shape[:-1], 1)), flipped.flip(-1), flipped)


@dataclass(frozen=True, slots=True)
class ViewedEncoding:
    """A network's encoding of mirrored tasks, and how they were mirrored."""

    inner: Any
    view: View


class SymmetricNetwork:
    """A network that looks at scenario k through symmetry k mod 8.

    Args:
        network: scores what it sees.
        scenarios: what will be encoded, each 8 times in a row, see `ScenarioBatch.repeat`.
    """

    def __init__(self, network: Scorer, scenarios: ScenarioBatch) -> None:
        self._network, self._view = network, View.of(scenarios)

    def encode(self, tasks: Tasks) -> ViewedEncoding:
        """As `AllocationNetwork.encode`, of mirrored tasks."""
        # Padding lies at 0 and is mirrored along: networks do not look at it.
        return ViewedEncoding(self._network.encode(replace(tasks, xy=self._view.of_places(tasks.xy))), self._view)

    def features(self, encoding: ViewedEncoding, states: DecisionStates) -> Any:
        """As `AllocationNetwork.features`, of mirrored states."""
        return self._network.features(encoding.inner, _seen(encoding.view, states))

    def __call__(self, encoding: ViewedEncoding, states: DecisionStates, features: Any = None) -> Tensor:
        """As `AllocationNetwork.forward`, of mirrored states."""
        log_probs: Tensor = self._network(encoding.inner, _seen(encoding.view, states), features)
        return log_probs


def _seen(view: View, states: DecisionStates) -> DecisionStates:
    return replace(states, xy=view.of_places(states.xy))
