"""Tianshou: PPO, one agent that acts for each robot in its turn.

Run it with ``python -m mrta_zoo.train.integrations.tianshou_ppo --seed 0``, and ``--network capam``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from tianshou.algorithm import PPO
from tianshou.algorithm.modelfree.reinforce import DiscreteActorPolicy
from tianshou.algorithm.optim import AdamOptimizerFactory
from tianshou.data import Batch, Collector, VectorReplayBuffer
from tianshou.env import DummyVectorEnv
from tianshou.trainer import OnPolicyTrainerParams
from torch import Tensor, nn

from mrta_zoo.gym_view import ActingRobotEnv
from mrta_zoo.policies.protocol import Policy
from mrta_zoo.train.integrations.networks import FORM, Kind, as_policy, build
from mrta_zoo.train.integrations.problem import options, show


def tensors(observation: Batch) -> dict[str, Any]:
    """Tianshou's batch of observations as a dictionary of tensors."""
    return observation.to_torch(dtype=torch.float32).to_dict()


class Actor(nn.Module):
    """Masked logits, as Tianshou asks for them."""

    def __init__(self, net: Any) -> None:
        super().__init__()
        self.net = net

    def forward(self, obs: Batch, state: Any = None, info: Any = None) -> tuple[Tensor, Any]:
        """Logits (B, max_tasks)."""
        return self.net.logits(tensors(obs)), state


class Critic(Actor):
    """The value, likewise."""

    def forward(self, obs: Batch, **_: Any) -> Tensor:
        """Values (B, 1)."""
        return self.net.value(tensors(obs))[:, None]


def train(seed: int = 0, epochs: int = 5, network: Kind = "mlp") -> Policy:
    torch.manual_seed(seed); np.random.seed(seed)
    envs = DummyVectorEnv([lambda: ActingRobotEnv(**options(FORM[network])) for _ in range(8)])
    envs.seed([1000*seed+i for i in range(8)])
    view = ActingRobotEnv(**options(FORM[network]))
    net = build(network, view.observation_space, view.action_space, seed)
    policy = DiscreteActorPolicy(actor=Actor(net), dist_fn=lambda logits: torch.distributions.Categorical(logits=logits), action_space=view.action_space, observation_space=view.observation_space)
    algorithm = PPO(policy=policy, critic=Critic(net), optim=AdamOptimizerFactory(lr=1e-3), gamma=1.0, ent_coef=0.01, max_grad_norm=0.5)
    collector = Collector(algorithm, envs, VectorReplayBuffer(2048, 8))
    algorithm.run_training(OnPolicyTrainerParams(
        training_collector=collector, test_collector=None, max_epochs=epochs, epoch_num_steps=5000, collection_step_num_env_steps=1000,
        update_step_num_repetitions=6, batch_size=250, test_step_num_episodes=1, verbose=False, show_progress=False))
    return as_policy({"shared": net})


if __name__ == "__main__":
    show(train)
