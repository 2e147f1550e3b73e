"""REINFORCE with parameters shared among the robots (paper §III-C).

An update samples missions without gradients, compares their outcomes with a baseline, and then recomputes the
log-probabilities of all their decisions at once, with gradients: the encoder runs once a scenario, and the decoder
in a few large batches.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from mrta_zoo.batch import ScenarioBatch
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import ScenarioGenerator
from mrta_zoo.policies.capam.inputs import Tasks
from mrta_zoo.policies.neural import load_policy
from mrta_zoo.policies.rollout import Rollout, roll_out
from mrta_zoo.policies.sharing import Network, build_network
from mrta_zoo.policies.weights import load_state
from mrta_zoo.train.baselines import Baseline, RolloutBaseline, SamplesBaseline
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.distribution import training_generator
from mrta_zoo.train.objective import OBJECTIVES

VALIDATION = 1
"""Tag of the stream of random numbers that draws the validation scenarios; training draws from stream 0."""


@dataclass(frozen=True, slots=True)
class Update:
    """What one gradient step saw."""

    update: int
    loss: float
    """Mean loss of the sampled missions (the objective, not the surrogate)."""
    gradient_norm: float
    learning_rate: float
    decisions: int


@dataclass(frozen=True, slots=True)
class Validation:
    """Greedy results on the validation scenarios."""

    update: int
    episodes: int
    """Missions sampled for training so far."""
    completion: float
    cost: float
    """Eq. 1 of the paper, a task."""
    baseline_replaced: bool


class Reinforce:
    """A training run in memory. `step` and `validate` move it on; `train.checkpoint` saves and restores it.

    All randomness derives from (seed, number of the update): a run that is resumed goes on exactly as if it had
    never stopped, with no generator state to be saved.
    """

    def __init__(self, config: TrainConfig, generator: ScenarioGenerator | None = None) -> None:
        """Start afresh.

        Args:
            config: the run.
            generator: draws the scenarios; by default, as `config.generator` says.

        Raises:
            ConfigError: if `config.initial` names no policy, or one of another architecture.
        """
        self.config = config
        self.device = _device(config.device)
        self.generator = generator or training_generator(config)
        self.objective = OBJECTIVES[config.objective]
        self.network: Network = build_network(config.network, config.sharing, config.max_robots, config.seed)
        if config.initial:
            self._start_from(config.initial)
        self.network.to(self.device)
        self.optimizer = torch.optim.Adam(self.network.parameters(), lr=config.learning_rate)
        self.baseline: Baseline = (
            RolloutBaseline(self.network, self.objective, config.mask_rule, config.significance)
            if config.baseline == "rollout"
            else SamplesBaseline()
        )
        self.update = 0
        self.history: list[Validation] = []
        self._validation: ScenarioBatch | None = None

    @property
    def validation_batch(self) -> ScenarioBatch:
        """The validation scenarios, the same all through the run."""
        if self._validation is None:
            rng = np.random.default_rng((self.config.seed, VALIDATION))
            drawn = [self.generator(rng) for _ in range(self.config.validation_scenarios)]
            self._validation = ScenarioBatch.of(drawn, self.device)
        return self._validation

    @property
    def best(self) -> Validation:
        """The best validation so far: by completion, then cost, then the earliest. There must have been one."""
        return max(self.history, key=lambda each: (each.completion, -each.cost))

    def step(self) -> Update:
        """One gradient step.

        Raises:
            ConfigError: if training has diverged; the weights are then as before.
        """
        config = self.config
        rng = np.random.default_rng((config.seed, 0, self.update))
        scenarios = ScenarioBatch.of([self.generator(rng) for _ in range(config.scenarios)], self.device)
        sampler = torch.Generator(self.device).manual_seed(int(rng.integers(2**63)))
        rate = self._learning_rate()
        for group in self.optimizer.param_groups:
            group["lr"] = rate

        rollout = roll_out(
            self.network,
            scenarios,
            samples=config.samples,
            generator=sampler,
            mask_rule=config.mask_rule,
            keep_segments=True,
        )
        loss = self.objective(rollout, scenarios).unflatten(0, (-1, config.samples))
        advantage = self.baseline.advantage(scenarios, loss).float()
        if config.normalise:
            advantage = advantage / (advantage.std() + 1e-6)

        self.optimizer.zero_grad(set_to_none=True)
        surrogate = surrogate_loss(self.network, scenarios, rollout, advantage, config.entropy)
        surrogate.backward()
        norm = torch.nn.utils.clip_grad_norm_(self.network.parameters(), config.clip_norm)
        if not torch.isfinite(norm):
            raise ConfigError(
                f"training diverged in update {self.update + 1}: the gradient is not finite; go on from an earlier "
                "checkpoint with a smaller learning_rate"
            )
        self.optimizer.step()
        self.update += 1
        return Update(
            update=self.update,
            loss=float(loss.mean()),
            gradient_norm=float(norm),
            learning_rate=rate,
            decisions=sum(int(segment.live.sum()) for segment in rollout.segments),
        )

    def validate(self) -> Validation:
        """Greedy results now; gives the baseline its chance to change, and adds to the history."""
        scenarios = self.validation_batch
        rollout = roll_out(self.network, scenarios, mask_rule=self.config.mask_rule)
        replaced = self.update > 0 and self.baseline.end_epoch(
            self.network, scenarios, self.objective(rollout, scenarios)
        )
        tasks = scenarios.task_exists.sum(1)
        validation = Validation(
            update=self.update,
            episodes=self.update * self.config.scenarios * self.config.samples,
            completion=float((rollout.completed / tasks).mean()),
            cost=float((rollout.cost / tasks).mean()),
            baseline_replaced=replaced,
        )
        self.history.append(validation)
        return validation

    def run(self) -> Iterator[Update | Validation]:
        """Train to the end, validating before the first update (unless resumed), each epoch, and at the end."""
        if not self.history:
            yield self.validate()
        while self.update < self.config.updates:
            yield self.step()
            if self.update % self.config.epoch == 0 or self.update == self.config.updates:
                yield self.validate()

    def _start_from(self, initial: str) -> None:
        policy, config = load_policy(initial), self.config
        if (policy.info.network, policy.info.sharing) != (config.network, config.sharing):
            raise ConfigError(
                f"initial is {initial!r}, which is {policy.info.sharing} {policy.info.network}; "
                f"the run is {config.sharing} {config.network}"
            )
        load_state(self.network, dict(policy.network.state_dict()), Path(initial))

    def _learning_rate(self) -> float:
        first, last = self.config.learning_rate, self.config.final_learning_rate
        progress = self.update / self.config.updates
        return last + (first - last) * (1 + math.cos(math.pi * progress)) / 2


def surrogate_loss(
    network: Network, scenarios: ScenarioBatch, rollout: Rollout, advantage: Tensor, entropy: float = 0.0
) -> Tensor:
    """The scalar whose gradient is REINFORCE's: mean over missions of advantage · Σ log-probability.

    Args:
        network: the policy, with gradients.
        scenarios: the S scenarios.
        rollout: of these scenarios, with its segments.
        advantage: (S, G) how much worse than expected each mission turned out.
        entropy: weight of the entropy bonus.
    """
    encoding = network.encode(Tasks.of_batch(scenarios))
    total = advantage.new_zeros(())
    for segment in rollout.segments:
        log_probs = network(encoding.select(segment.scenarios), segment.moments, segment.features)
        chosen = log_probs.gather(2, segment.actions[..., None]).squeeze(2)
        weight = advantage[segment.scenarios][:, segment.sample]
        total = total + (weight * chosen).masked_fill(~segment.live, 0.0).sum()
        if entropy:
            negative = (log_probs.exp() * log_probs.masked_fill(torch.isinf(log_probs), 0.0)).sum(-1)
            total = total + entropy * negative.masked_fill(~segment.live, 0.0).sum()
    return total / advantage.numel()


def _device(name: str) -> torch.device:
    if name == "auto":
        return torch.device("cuda" if torch.cuda.is_available() else "cpu")
    if name == "cuda" and not torch.cuda.is_available():
        raise ConfigError("device is 'cuda', but torch finds no GPU; expected cpu or auto")
    return torch.device(name)
