"""RLlib: PPO with a masked module, one for all robots or one for each.

Run it with ``python -m mrta_zoo.train.integrations.rllib_ppo --seed 0``, and ``--sharing independent`` or ``--network
capam``.
"""

from __future__ import annotations

from typing import Any, Literal

import ray
from gymnasium import spaces
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core.columns import Columns
from ray.rllib.core.rl_module import MultiRLModuleSpec, RLModuleSpec
from ray.rllib.core.rl_module.apis import ValueFunctionAPI
from ray.rllib.core.rl_module.torch import TorchRLModule
from ray.rllib.env.wrappers.pettingzoo_env import PettingZooEnv
from ray.tune.registry import register_env
from torch import Tensor

from mrta_zoo import mrta_v0
from mrta_zoo.policies.cpu_threads import few_threads
from mrta_zoo.policies.protocol import Policy
from mrta_zoo.train.integrations.networks import FORM, Kind, as_policy, build
from mrta_zoo.train.integrations.problem import options, show


class RllibEnv(PettingZooEnv):
    """RLlib's wrapper, with all possible robots: by itself it knows only those of the first episode.

    Args:
        config: options of `mrta_v0.env`.
    """

    def __init__(self, config: dict[str, Any]) -> None:
        env = mrta_v0.env(**config)
        super().__init__(env)
        self.possible_agents = list(env.possible_agents)
        self.observation_spaces = {agent: env.observation_space(agent) for agent in env.possible_agents}
        self.action_spaces = {agent: env.action_space(agent) for agent in env.possible_agents}
        self.observation_space = spaces.Dict(self.observation_spaces)
        self.action_space = spaces.Dict(self.action_spaces)


class MaskedModule(TorchRLModule, ValueFunctionAPI):
    """A network with masked `logits` and a `value` as a module of RLlib."""

    def setup(self) -> None:
        """Make the network; RLlib calls it."""
        features, actions = spaces.flatdim(self.observation_space["observation"]), int(self.action_space.n)
        self.net = build(self.model_config["kind"], features, actions, self.model_config["seed"])

    def _forward(self, batch: dict[str, Any], **_: Any) -> dict[str, Tensor]:
        return {Columns.ACTION_DIST_INPUTS: self.net.logits(batch[Columns.OBS])}

    def compute_values(self, batch: dict[str, Any], embeddings: Any = None) -> Tensor:
        """(B,) values."""
        return self.net.value(batch[Columns.OBS])


def configure(
    env: dict[str, Any], seed: int, network: Kind = "mlp", sharing: Literal["shared", "independent"] = "shared"
) -> PPOConfig:
    """PPO on an environment with these options."""
    register_env("mrta", RllibEnv)
    agents = list(mrta_v0.env(**env).possible_agents)
    modules = ["shared"] if sharing == "shared" else agents
    specs = {
        name: RLModuleSpec(module_class=MaskedModule, model_config={"kind": network, "seed": seed + number})
        for number, name in enumerate(modules)
    }
    return (
        PPOConfig()
        .environment("mrta", env_config=env, disable_env_checking=True)  # which tries illegal actions
        .env_runners(num_env_runners=0, num_envs_per_env_runner=50)
        .multi_agent(
            policies=set(modules),
            policy_mapping_fn=lambda agent, *_, **__: "shared" if sharing == "shared" else agent,
        )
        .rl_module(rl_module_spec=MultiRLModuleSpec(rl_module_specs=specs))
        .training(lr=2e-3, gamma=1.0, lambda_=0.95, entropy_coeff=0.01, use_kl_loss=False, vf_loss_coeff=0.5)
        .training(train_batch_size_per_learner=1000, minibatch_size=250, num_epochs=8, grad_clip=0.5)
        .debugging(seed=seed, log_level="ERROR")
    )


@few_threads()
def train(
    seed: int = 0,
    iterations: int = 10,
    network: Kind = "mlp",
    sharing: Literal["shared", "independent"] = "shared",
) -> Policy:
    """Train on the small problem.

    Args:
        seed: seeds weights, scenarios and choices.
        iterations: of PPO, with 1000 decisions each.
        network: a plain network, or CapAM.
        sharing: one for all robots, or one for each.
    """
    ray.init(include_dashboard=False, log_to_driver=False, logging_level="ERROR", ignore_reinit_error=True)
    algorithm = configure(options(FORM[network]), seed, network, sharing).build_algo()
    for _ in range(iterations):
        algorithm.train()
    policy = as_policy(*(algorithm.get_module(name).net for name in sorted(algorithm.config.policies)))
    algorithm.stop()
    return policy


if __name__ == "__main__":
    show(train)
