"""Tianshou: PPO, one agent that acts for each robot in its turn.

Run it with ``python -m mrta_zoo.train.integrations.tianshou_ppo --seed 0``, and ``--network capam``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from tianshou.algorithm import PPO
from tianshou.algorithm.modelfree.reinforce import DiscreteActorPolicy
from tianshou.algorithm.optim import AdamOptimizerFactory
from tianshou.data import Batch, Collector, VectorReplayBuffer
from tianshou.env import DummyVectorEnv
from tianshou.trainer import OnPolicyTrainerParams
from torch import Tensor, nn
from torch.distributions import Categorical

from mrta_zoo.env.gym_view import ActingRobotEnv
from mrta_zoo.policies.cpu_threads import few_threads
from mrta_zoo.policies.protocol import Policy
from mrta_zoo.train.integrations.networks import FORM, Kind, as_policy, build
from mrta_zoo.train.integrations.problem import TASKS, options, show


def tensors(observation: Batch) -> dict[str, Any]:
    """Tianshou's batch of observations as a dictionary of tensors."""
    seen: dict[str, Any] = observation.to_torch(dtype=torch.float32).to_dict()
    return seen


class Actor(nn.Module):
    """Masked logits, as Tianshou expects them."""

    def __init__(self, net: Any) -> None:
        super().__init__()
        self.net = net

    def forward(self, obs: Batch, state: Any = None, info: Any = None) -> tuple[Tensor, Any]:
        """(B, max_tasks) logits, and no state."""
        return self.net.logits(tensors(obs)), state


class Critic(nn.Module):
    """The value, as Tianshou expects it."""

    def __init__(self, net: Any) -> None:
        super().__init__()
        self.net = net

    def forward(self, obs: Batch) -> Tensor:
        """(B, 1) values."""
        value: Tensor = self.net.value(tensors(obs))[:, None]
        return value


@few_threads()
def train(seed: int = 0, epochs: int = 5, network: Kind = "mlp") -> Policy:
    """Train on the small problem.

    Args:
        seed: seeds weights, scenarios and choices.
        epochs: number of epochs, with 1000 decisions each.
        network: a plain network, or CapAM.
    """
    torch.manual_seed(seed)  # Tianshou draws actions from the global generators
    np.random.seed(seed)  # noqa: NPY002  (and minibatches)
    form = FORM[network]
    envs = DummyVectorEnv([lambda: ActingRobotEnv(**options(form)) for _ in range(8)])
    envs.seed([8 * seed + number for number in range(8)])
    view: Any = ActingRobotEnv(**options(form))
    net = build(network, spaces.flatdim(view.observation_space["observation"]), TASKS, seed)
    policy = DiscreteActorPolicy(
        actor=Actor(net),
        dist_fn=lambda logits: Categorical(logits=logits),
        action_space=view.action_space,
        observation_space=view.observation_space,
    )
    algorithm = PPO(
        policy=policy,
        critic=Critic(net),
        optim=AdamOptimizerFactory(lr=2e-3),
        gamma=1.0,
        ent_coef=0.01,
        max_grad_norm=0.5,
    )
    algorithm.run_training(
        OnPolicyTrainerParams(
            training_collector=Collector(algorithm, envs, VectorReplayBuffer(1000 + 8 * TASKS, 8)),
            max_epochs=epochs,
            epoch_num_steps=1000,
            collection_step_num_env_steps=1000,
            update_step_num_repetitions=8,
            batch_size=250,
            verbose=False,
            show_progress=False,
        )
    )
    return as_policy(net)


if __name__ == "__main__":
    show(train)
