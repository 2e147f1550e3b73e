"""An actor-critic on batches of observations, for the PPO of other libraries to train."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch
from torch import Tensor, nn

from mrta_zoo.actions import must_wait, split_mask
from mrta_zoo.env.observation import EGO_FEATURES, MISSION_FEATURES, ROBOT_FEATURES, TASK_FEATURES
from mrta_zoo.policies.cpu_threads import few_threads
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.sharing import Network


class ActorCritic(nn.Module):
    """Masked logits from a policy network, CapAM or any other that this package builds, and a separate value.

    Observations are the environment's Dict form as tensors, ``{"observation": {"tasks", "robots", "ego", "mission"},
    "action_mask"}``, all with the same leading dimensions (…): none, a batch, or time × robots, for example. In the
    parallel form the mask, and so the logits, have one more column, the no-op.

    On a CPU it uses one thread, as trained policies do. Your training loop computes the gradients: put
    ``with few_threads():`` (`policies.cpu_threads`) around it.

    The value is no part of `network`, which is what `weights.save_policy` writes and `policy.load_policy` loads.

    Args:
        network: scores the tasks, from `sharing.build_network` or `weights.load_weights`.
        width: width of the value's hidden layers.
    """

    def __init__(self, network: Network, width: int = 64) -> None:
        super().__init__()
        self.network = network
        self.critic = Critic(width)

    def forward(self, observation: Mapping[str, Any]) -> tuple[Tensor, Tensor]:
        """Logits and values, as from `logits` and `value`."""
        return self.logits(observation), self.value(observation)

    @few_threads()
    def logits(self, observation: Mapping[str, Any]) -> Tensor:
        """(…, max_tasks) log-probabilities; the lowest finite number where the mask forbids, so that no NaN arises.

        Where nothing may be chosen at all they are all equal.
        """
        tables = observation["observation"]
        rows = tables["tasks"].shape[-2]
        allowed = observation["action_mask"] > 0
        mask, noop = split_mask(allowed, rows)
        leading = mask.shape[:-1]
        flat = {name: table.reshape(-1, *table.shape[len(leading) :]) for name, table in tables.items()}
        states = DecisionStates.of_tables(flat, mask.reshape(-1, rows))
        scores: Tensor = self.network(self.network.encode(Tasks.of_tables(flat)), states).reshape(*leading, rows)
        if noop.shape[-1]:
            waits = must_wait(allowed, rows)[..., None]
            scores = torch.cat((scores.masked_fill(waits, -torch.inf), torch.where(waits, 0.0, -torch.inf)), -1)
        return scores.clamp(min=torch.finfo(scores.dtype).min)

    @few_threads()
    def value(self, observation: Mapping[str, Any]) -> Tensor:
        """(…) expected return of the rest of the mission."""
        value: Tensor = self.critic(observation["observation"])
        return value


class Critic(nn.Module):
    """The value of an observation, for any order and number of tasks and peers: means over sets.

    Zaheer et al. 2017, Deep Sets.
    """

    def __init__(self, width: int) -> None:
        super().__init__()
        self.task = nn.Sequential(nn.Linear(len(TASK_FEATURES), width), nn.ReLU())
        self.robot = nn.Sequential(nn.Linear(len(ROBOT_FEATURES), width), nn.ReLU())
        others = len(EGO_FEATURES) + len(MISSION_FEATURES)
        self.value = nn.Sequential(nn.Linear(2 * width + others, width), nn.ReLU(), nn.Linear(width, 1))

    def forward(self, tables: Mapping[str, Tensor]) -> Tensor:
        """(…) from tables with leading dimensions (…)."""
        sets = self.task(tables["tasks"]).mean(-2), self.robot(tables["robots"]).mean(-2)
        value: Tensor = self.value(torch.cat((*sets, tables["ego"], tables["mission"]), -1)).squeeze(-1)
        return value
