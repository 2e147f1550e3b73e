"""TorchRL: PPO for all robots together, through its PettingZoo wrapper.

Run it with ``python -m mrta_zoo.train.integrations.torchrl_ppo --seed 0``, and ``--network capam``.
"""

from __future__ import annotations

import warnings
from typing import Any

import torch
from tensordict.nn import TensorDictModule
from torch import Tensor
from torch.distributions import Categorical
from torchrl.collectors import Collector
from torchrl.envs import MarlGroupMapType, PettingZooWrapper
from torchrl.modules import ProbabilisticActor
from torchrl.objectives import ClipPPOLoss
from torchrl.objectives.value import GAE

from mrta_zoo import mrta_v0
from mrta_zoo.env.observation import split
from mrta_zoo.policies.cpu_threads import few_threads
from mrta_zoo.policies.protocol import Policy
from mrta_zoo.train.integrations.networks import Kind, as_policy, build
from mrta_zoo.train.integrations.problem import ROBOTS, TASKS, options, show

SEEN, MASK, TURN = ("agents", "observation"), ("agents", "action_mask"), ("agents", "mask")
LOGITS, ACTION, LOG_PROB, VALUE = (("agents", name) for name in ("logits", "action", "log_prob", "state_value"))


def make_env(seed: int, **changes: Any) -> PettingZooWrapper:
    """The AEC environment with all robots in one group, so that one network serves them as a batch.

    In the flat form: given a Dict, TorchRL takes its mask as its own, and then stumbles over the one in infos.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # "tested using PettingZoo 1.24.3"
        env = mrta_v0.env(**{**options("flat"), **changes})
        return PettingZooWrapper(env, use_mask=True, group_map=MarlGroupMapType.ALL_IN_ONE_GROUP, seed=seed)


@few_threads()
def train(seed: int = 0, iterations: int = 5, network: Kind = "mlp") -> Policy:
    """Train on the small problem.

    Args:
        seed: seeds weights, scenarios and choices.
        iterations: of PPO, with 1000 decisions each.
        network: a plain network, or CapAM.
    """
    torch.manual_seed(seed)  # TorchRL draws from the global generator
    env = make_env(seed)
    net = build(network, features=env.observation_spec[SEEN].shape[-1], actions=TASKS, seed=seed)

    def observation(seen: Tensor, mask: Tensor | None = None) -> dict[str, Any]:
        return {"observation": seen if network == "mlp" else split(seen, TASKS, ROBOTS), "action_mask": mask}

    actor = ProbabilisticActor(
        TensorDictModule(lambda seen, mask: net.logits(observation(seen, mask)), [SEEN, MASK], [LOGITS]),
        in_keys={"logits": LOGITS},
        out_keys=[ACTION],
        distribution_class=Categorical,
        return_log_prob=True,
        log_prob_key=LOG_PROB,
    )
    critic = TensorDictModule(lambda seen: net.value(observation(seen))[..., None], [SEEN], [VALUE])
    loss = ClipPPOLoss(actor, critic, entropy_coeff=0.01, critic_coeff=0.5, reduction="none")
    gae = GAE(gamma=1.0, lmbda=0.95, value_network=critic)
    books = {name: ("agents", name) for name in ("reward", "done", "terminated")}
    loss.set_keys(action=ACTION, sample_log_prob=LOG_PROB, value=VALUE, **books)
    gae.set_keys(value=VALUE, **books)
    optimizer = torch.optim.Adam(net.parameters(), lr=2e-3)

    collector = Collector(env, actor, frames_per_batch=1000, total_frames=1000 * iterations)
    for batch in collector:
        with torch.no_grad():
            gae(batch)
        turn = batch[TURN]  # (1000, robots): only the decision of the robot whose turn it was counts
        advantage = batch["advantage"]
        batch["advantage"] = (advantage - advantage[turn].mean()) / advantage[turn].std()
        for _ in range(8):
            for rows in torch.randperm(len(batch)).split(250):
                losses = loss(batch[rows])
                terms = (losses[name] for name in ("loss_objective", "loss_critic", "loss_entropy"))
                optimizer.zero_grad()
                sum(term.reshape(len(rows), ROBOTS)[turn[rows]].mean() for term in terms).backward()
                torch.nn.utils.clip_grad_norm_(net.parameters(), 0.5)
                optimizer.step()
    collector.shutdown()
    return as_policy(net)


if __name__ == "__main__":
    show(train)
