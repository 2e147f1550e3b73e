"""The networks that the integrations train: a plain one on vectors, CapAM on tables. Both give logits and a value."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import torch
from torch import Tensor, nn

from mrta_zoo.env.settings import ObservationForm
from mrta_zoo.policies.cpu_threads import few_threads
from mrta_zoo.policies.neural.actor_critic import ActorCritic
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.policy import NeuralPolicy
from mrta_zoo.policies.neural.sharing import IndependentNetworks, build_network, seeded
from mrta_zoo.policies.neural.weights import PolicyInfo
from mrta_zoo.policies.protocol import Policy

Kind = Literal["mlp", "capam"]
FORM: dict[Kind, ObservationForm] = {"mlp": "masked", "capam": "dict"}
"""The form of observations that each reads."""


class Mlp(nn.Module):
    """Two hidden layers for the logits, and two for the value, on ``{"observation": vector, "action_mask"}``.

    Args:
        features: length of the vector.
        actions: number of actions.
        width: of the hidden layers.
    """

    def __init__(self, features: int, actions: int, width: int = 64) -> None:
        super().__init__()
        self.actor = _layers(features, width, actions)
        self.critic = _layers(features, width, 1)

    def logits(self, observation: Mapping[str, Tensor]) -> Tensor:
        """(…, actions) scores; the lowest finite number where the mask forbids."""
        scores: Tensor = self.actor(observation["observation"])
        return scores.masked_fill(observation["action_mask"] <= 0, torch.finfo(scores.dtype).min)

    def value(self, observation: Mapping[str, Tensor]) -> Tensor:
        """(…) expected return of the rest of the mission."""
        value: Tensor = self.critic(observation["observation"]).squeeze(-1)
        return value


def _layers(features: int, width: int, outputs: int) -> nn.Sequential:
    return nn.Sequential(
        nn.Linear(features, width), nn.Tanh(), nn.Linear(width, width), nn.Tanh(), nn.Linear(width, outputs)
    )


def build(kind: Kind, features: int, actions: int, seed: int) -> Mlp | ActorCritic:
    """A new network. The same seed gives the same weights, and the global generator is left alone.

    Args:
        kind: which network; CapAM needs neither of the next two.
        features: length of a flat observation.
        actions: number of actions.
        seed: of the weights.
    """
    with seeded(seed):
        if kind == "mlp":
            return Mlp(features, actions)
        return ActorCritic(build_network(NetworkConfig(embedding=32, heads=4), "shared", robots=1, seed=seed))


class GreedyPolicy:
    """The likeliest task, in the AEC loop. Implements `Policy`.

    Args:
        networks: one for all, or one for each robot, by its number.
    """

    observation: ObservationForm = "masked"

    def __init__(self, *networks: Mlp) -> None:
        self.networks = networks

    @few_threads()
    @torch.no_grad()
    def act(self, observation: Mapping[str, Any], agent: str) -> int:
        """The task to take."""
        number = int(agent.removeprefix("robot_")) if len(self.networks) > 1 else 0
        seen = {name: torch.as_tensor(each) for name, each in observation.items()}
        return int(self.networks[number].logits(seen).argmax())


def as_policy(*networks: Any) -> Policy:
    """Trained networks, one for all robots or one for each, as a policy; CapAM's can be saved and loaded.

    >>> policy = as_policy(net)
    >>> save_policy(Path("mine.safetensors"), policy.network, policy.info)
    """
    if isinstance(networks[0], Mlp):
        return GreedyPolicy(*networks)
    config = networks[0].network.config
    if len(networks) == 1:
        return NeuralPolicy(networks[0].network, PolicyInfo(network=config))
    several = IndependentNetworks(config, len(networks))
    several.robots = nn.ModuleList(each.network for each in networks)
    return NeuralPolicy(several, PolicyInfo(network=config, sharing="independent", robots=len(networks)))
