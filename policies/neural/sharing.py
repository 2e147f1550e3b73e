"""Who shares a network: all robots, the robots of a kind, or nobody. The same interface for all three.

A kind of robots is a capacity as a share of the strongest robot's in the team. That is what a robot sees of capacities:
observations are free of units, and a team of capacities 1 and 2 with workloads of 20 is the same mission as one of 2
and 4 with workloads of 40.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from threading import RLock
from typing import Literal, NamedTuple, cast

import torch
from torch import Tensor, nn

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.capam.candidates import Candidates
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.capam.network import AllocationNetwork, Encoding
from mrta_zoo.wording import counted

Sharing = Literal["shared", "independent", "by-capacity"]

USUAL_KINDS = (0.5, 1.0)
"""Those of TAPTC, whose robots have capacity 1 or 2."""
SAME_KIND = 1e-4
"""Shares that differ by no more are the same kind: observations are float32."""


@dataclass(frozen=True, slots=True)
class SeveralEncodings:
    """Each network's own encoding of the same tasks."""

    tasks: Tasks
    of_network: tuple[Encoding, ...]


class SeveralNetworks(nn.Module):
    """Networks that divide the robots among themselves, otherwise like `AllocationNetwork`."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.config = config

    @property
    def networks(self) -> tuple[AllocationNetwork, ...]:
        """All of them, in order."""
        raise NotImplementedError

    def which(self, states: DecisionStates) -> Tensor:
        """(S, G) int64, the number of the network that decides for the acting robot.

        Raises:
            ConfigError: if a robot at work has none.
        """
        raise NotImplementedError

    def encode(self, tasks: Tasks) -> SeveralEncodings:
        """Embed the tasks, once per mission and network."""
        return SeveralEncodings(tasks, tuple(network.encode(tasks) for network in self.networks))

    def surroundings(self, tasks: Tasks) -> SeveralEncodings:
        """As `AllocationNetwork.surroundings`."""
        return SeveralEncodings(tasks, (self.networks[0].surroundings(tasks),))

    def features(self, encoding: SeveralEncodings, states: DecisionStates) -> Candidates | None:
        """As `AllocationNetwork.features`: they hold no weights, so one network's serve all."""
        return self.networks[0].features(encoding.of_network[0], states)

    def forward(self, encoding: SeveralEncodings, states: DecisionStates, features: Candidates | None = None) -> Tensor:
        """As `AllocationNetwork.forward`, each decision by the network of the acting robot.

        Raises:
            ConfigError: if a robot at work has no network.
        """
        which = self.which(states)
        log_probs: Tensor = self.networks[0](encoding.of_network[0], states, features)
        for number, network in enumerate(self.networks[1 : int(which.max()) + 1], start=1):
            own = network(encoding.of_network[number], states, features)
            log_probs = torch.where((which == number)[..., None], own, log_probs)
        return log_probs


class IndependentNetworks(SeveralNetworks):
    """One network for each robot by its number. Serves at most `robots` robots."""

    def __init__(self, config: NetworkConfig, robots: int) -> None:
        super().__init__(config)
        self.robots = nn.ModuleList(AllocationNetwork(config) for _ in range(robots))

    @property
    def networks(self) -> tuple[AllocationNetwork, ...]:
        """All of them, by robot."""
        return tuple(cast(AllocationNetwork, network) for network in self.robots)

    def of_robot(self, robot: int) -> AllocationNetwork:
        """The network of a robot.

        Raises:
            ConfigError: if it has none.
        """
        if robot >= len(self.robots):
            raise self._none_for(f"robot {robot} has")
        return self.networks[robot]

    def which(self, states: DecisionStates) -> Tensor:
        """(S, G) int64, the acting robot."""
        numbers = torch.arange(states.working.shape[-1], device=states.working.device)
        first, last = len(self.robots), int((states.working * numbers).max())
        if last == first:
            self.of_robot(first)
        if last > first:
            raise self._none_for(f"robots {first} {'and' if last == first + 1 else 'to'} {last} have")
        return states.ego

    def _none_for(self, who: str) -> ConfigError:
        return ConfigError(
            f"{who} no network: these independent policies were trained for {counted(len(self.robots), 'robot')}; "
            "use a policy with sharing 'shared' or 'by-capacity' for more"
        )


class ByCapacityNetworks(SeveralNetworks):
    """One network for each kind of robots. Serves any number of robots of these kinds.

    Args:
        config: architecture of each.
        kinds: capacities as shares of the strongest robot's, see `check_kinds`.
    """

    def __init__(self, config: NetworkConfig, kinds: Sequence[float]) -> None:
        check_kinds(kinds)
        super().__init__(config)
        self.shares = tuple(kinds)
        self.kinds = nn.ModuleList(AllocationNetwork(config) for _ in kinds)

    @property
    def networks(self) -> tuple[AllocationNetwork, ...]:
        """All of them, by kind."""
        return tuple(cast(AllocationNetwork, network) for network in self.kinds)

    def which(self, states: DecisionStates) -> Tensor:
        """(S, G) int64, the kind of the acting robot.

        Raises:
            ConfigError: if a robot at work is of another kind.
        """
        kinds = torch.tensor(self.shares, device=states.capacity.device)
        off, kind = (states.capacity[..., None] - kinds).abs().min(-1)
        strange = states.working & (off > SAME_KIND)
        if strange.any():
            robot = int(strange.nonzero()[0, -1])
            share = float(states.capacity[strange][0])
            raise ConfigError(
                f"robot {robot} has no network: it has {share:.4g} of the strongest robot's capacity, and these "
                f"policies are for robots with {' or '.join(f'{each:.4g}' for each in self.shares)} of it"
            )
        return states.of_ego(kind)


Network = AllocationNetwork | SeveralNetworks


class Way(NamedTuple):
    """A way of sharing.

    Attributes:
        build: ``build(config, robots, kinds)`` gives fresh networks.
        networks: ``networks(robots, kinds)`` says how many these are.
    """

    build: Callable[[NetworkConfig, int, Sequence[float]], Network]
    networks: Callable[[int, Sequence[float]], int]


WAYS: dict[Sharing, Way] = {
    "shared": Way(lambda config, robots, kinds: AllocationNetwork(config), lambda robots, kinds: 1),
    "independent": Way(lambda config, robots, kinds: IndependentNetworks(config, robots), lambda robots, kinds: robots),
    "by-capacity": Way(
        lambda config, robots, kinds: ByCapacityNetworks(config, kinds), lambda robots, kinds: len(kinds)
    ),
}
"""Every way of sharing. To add one, add its name to `Sharing` and its row here."""


def check_kinds(kinds: Sequence[float]) -> None:
    """Check that these are kinds of robots, the strongest last.

    Raises:
        ConfigError: if they are not.
    """
    apart = all(low + 2 * SAME_KIND < high for low, high in pairwise(kinds))
    if not kinds or not kinds[0] > 0 or not apart or kinds[-1] != 1:
        raise ConfigError(
            f"kinds is {tuple(kinds)}; expected capacities as shares of the strongest robot's, such as 0.5 and 1: "
            f"> 0, ascending, more than {2 * SAME_KIND:g} apart, the last one 1"
        )


_drawing = RLock()


@contextmanager
def seeded(seed: int) -> Iterator[None]:
    """A context in which torch's global generator, which draws initial weights, starts from a seed; restored after it.

    Only one Python thread at a time is inside: others' draws would mix with its own.
    """
    with _drawing, torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        yield


def build_network(
    config: NetworkConfig, sharing: Sharing, robots: int, seed: int, kinds: Sequence[float] = USUAL_KINDS
) -> Network:
    """A freshly initialised network; the same seed gives the same weights, and the global generator is left alone.

    Args:
        config: architecture.
        sharing: "shared" (one for all robots), "independent" (one per robot) or "by-capacity" (one per kind).
        robots: how many networks, if independent.
        seed: seeds the initial weights.
        kinds: the kinds of robots, if by capacity, see `check_kinds`.

    Raises:
        ConfigError: if there is no such sharing or no such kinds.
    """
    if sharing not in WAYS:
        *others, last = map(repr, WAYS)
        raise ConfigError(f"sharing is {sharing!r}; expected {', '.join(others)} or {last}")
    with seeded(seed):
        return WAYS[sharing].build(config, robots, kinds)
