"""One network for all robots, or one for each: the same interface for both."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, cast

import torch
from torch import Tensor, nn

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.capam.candidates import Candidates
from mrta_zoo.policies.capam.config import NetworkConfig
from mrta_zoo.policies.capam.inputs import Moments, Tasks
from mrta_zoo.policies.capam.network import AllocationNetwork, Encoding

Sharing = Literal["shared", "independent"]


@dataclass(frozen=True, slots=True)
class IndependentEncoding:
    """Each robot's own encoding of the same tasks."""

    tasks: Tasks
    of_robot: tuple[Encoding, ...]

    def select(self, index: Tensor) -> IndependentEncoding:
        """The encodings of some of the scenarios."""
        return IndependentEncoding(self.tasks.select(index), tuple(e.select(index) for e in self.of_robot))


class IndependentNetworks(nn.Module):
    """One network per robot index, otherwise like `AllocationNetwork`. Serves at most `robots` robots."""

    def __init__(self, config: NetworkConfig, robots: int) -> None:
        super().__init__()
        self.config = config
        self.robots = nn.ModuleList(AllocationNetwork(config) for _ in range(robots))

    def encode(self, tasks: Tasks) -> IndependentEncoding:
        """Embed the tasks, once a mission and network."""
        return IndependentEncoding(
            tasks, tuple(cast(AllocationNetwork, network).encode(tasks) for network in self.robots)
        )

    def features(self, encoding: IndependentEncoding, moments: Moments) -> Candidates | None:
        """As `AllocationNetwork.features`: they hold no weights, so one robot's serve all."""
        return cast(AllocationNetwork, self.robots[0]).features(encoding.of_robot[0], moments)

    def forward(self, encoding: IndependentEncoding, moments: Moments, features: Candidates | None = None) -> Tensor:
        """As `AllocationNetwork.forward`, each decision by the network of the robot to act.

        Raises:
            ConfigError: if a robot to act has no network.
        """
        highest = int(moments.ego.max())
        if highest >= len(self.robots):
            raise ConfigError(
                f"robot {highest} has no network: these independent policies were trained for "
                f"{len(self.robots)} robots; use a shared policy for more"
            )
        log_probs: Tensor = self.robots[0](encoding.of_robot[0], moments, features)
        for robot in range(1, highest + 1):
            own = self.robots[robot](encoding.of_robot[robot], moments, features)
            log_probs = torch.where((moments.ego == robot)[..., None], own, log_probs)
        return log_probs


Network = AllocationNetwork | IndependentNetworks


def build_network(config: NetworkConfig, sharing: Sharing, robots: int, seed: int) -> Network:
    """A freshly initialised network; the same seed gives the same weights, and the global generator is left alone.

    Args:
        config: architecture.
        sharing: "shared" (one for all robots) or "independent" (one per robot).
        robots: how many networks, if independent.
        seed: of the initial weights.
    """
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        if sharing == "shared":
            return AllocationNetwork(config)
        if sharing == "independent":
            return IndependentNetworks(config, robots)
    raise ConfigError(f"sharing is {sharing!r}; expected 'shared' or 'independent'")
