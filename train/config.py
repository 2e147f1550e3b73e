"""Everything a training run depends on: the same dataclass is the Python API, the flags and the saved JSON."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

from mrta_zoo.bounds import MOST, check_seed
from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.sharing import USUAL_KINDS, Sharing, check_kinds
from mrta_zoo.rules import MaskRule
from mrta_zoo.train.precision import Precision

BaselineName = Literal["samples", "rollout", "exponential"]
ObjectiveName = Literal["cost", "completion", "relative"]
GeneratorName = Literal["taptc", "uniform", "mixture"]
NAMES: dict[str, Any] = {
    "baseline": BaselineName, "objective": ObjectiveName, "generator": GeneratorName, "sharing": Sharing,
    "mask_rule": MaskRule, "precision": Precision,
}  # fmt: skip
"""Settings that take one of a few names."""
LEAST = {
    1: (
        "reference_tasks", "min_robots", "scenarios", "samples", "updates", "epoch", "keep_checkpoints",
        "imitation_batch",
    ),
    0: ("imitation_plans", "imitation_updates", "imitation_decisions"),
}  # fmt: skip
"""Settings that are whole numbers, by their smallest legal value."""
MOST_DECISIONS = 10_000
"""Far more than a plan has."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainConfig:
    """One training run. The same configuration on the same machine gives the same weights.

    Attributes:
        network: architecture of the policy network.
        sharing: one network for all robots ("shared"), one for each ("independent"), or one for each kind of robots
            ("by-capacity").
        kinds: the kinds of robots, if by capacity: capacities as shares of the strongest robot's in a team, ascending,
            the last one 1.
        generator: distribution of the training scenarios: "taptc" (fitted to the benchmark), "uniform" (paper
            §IV-A), or "mixture" (both, see `mrta_zoo.train.distribution`).
        tasks: numbers of tasks; each update draws one of them.
        task_weights: how often each of `tasks` is drawn, relative to the others; empty for equally often.
        reference_tasks: the number of tasks that `min_robots` and `max_robots` are meant for; with other numbers of
            tasks they scale in proportion.
        min_robots: fewest robots of a scenario.
        max_robots: most robots of a scenario.
        mask_rule: what a robot may choose.
        imitation_updates: gradient steps that imitate plans of a strong search (`mrta_zoo.train.imitation.experts`)
            before REINFORCE takes over; 0 for none.
        imitation_plans: number of plans to imitate; they are made and kept in files of 500.
        imitation_batch: plans per step.
        imitation_decisions: decisions per plan, at most 10,000, drawn at random from a pool of up to 8,192 plans that
            is replaced from time to time (`mrta_zoo.train.imitation.imitator`), which is faster on a GPU; 0 takes all
            decisions, without a pool.
        imitation_learning_rate: Adam's step size at the start of the imitation; falls to a tenth along a cosine.
        objective: what to minimise: "cost" (Eq. 1 of the paper, divided by the number of tasks), one minus the
            completion rate ("completion"), or −ln(1 + number of completed tasks) ("relative"), which gives
            missions with few robots, where no plan completes much, the same weight as others.
        baseline: what a mission's loss is compared with: the mean of the other samples of its scenario
            ("samples"), the greedy rollout of the best policy so far, replaced when a paired t-test says that
            the current one is better ("rollout", the paper's), or a moving average over updates ("exponential").
        baseline_decay: the share of the "exponential" baseline that an update keeps.
        scenarios: scenarios per update.
        samples: missions sampled per scenario; at least 2 for the "samples" baseline.
        updates: number of gradient steps of REINFORCE.
        learning_rate: Adam's step size at the start.
        final_learning_rate: Adam's step size at the end, reached along a cosine.
        clip_norm: gradients are scaled down to at most this norm.
        normalise: whether advantages are divided by their standard deviation over the batch.
        entropy: weight of an entropy bonus, per decision, at the start; falls to 0 along the same cosine. Without it
            the policy soon becomes almost deterministic and stops exploring.
        temperature: REINFORCE samples from the probabilities p^(1/temperature), normalised, and improves these; from
            1e-6 to 1e6. Below 1, REINFORCE starts close to the policy's favourites after imitation instead of sampling
            from everything that imitation left open.
        epoch: updates from one validation to the next; each comes with a checkpoint and the baseline's t-test.
        validation_scenarios: number of validation scenarios, drawn once from the training distribution.
        significance: level of the baseline's t-test.
        initial: start from the weights of this policy (a shipped name, a .safetensors file, or a run's folder) instead
            of random ones; its architecture must be the same, `candidates` and `peers` aside. Empty for random weights.
        seed: seeds everything random.
        keep_checkpoints: how many of the latest checkpoints to keep.
        device: "cpu", "cuda", or "auto" (a GPU if there is one).
        precision: the precision of matrix products, "float32" or "bfloat16" (faster on a GPU).
    """

    network: NetworkConfig = field(default_factory=NetworkConfig)
    sharing: Sharing = "shared"
    kinds: tuple[float, ...] = USUAL_KINDS
    generator: GeneratorName = "taptc"
    tasks: tuple[int, ...] = (100,)
    task_weights: tuple[float, ...] = ()
    reference_tasks: int = 100
    min_robots: int = 2
    max_robots: int = 7
    mask_rule: MaskRule = "feasible"
    imitation_updates: int = 0
    imitation_plans: int = 0
    imitation_batch: int = 64
    imitation_decisions: int = 0
    imitation_learning_rate: float = 1e-3
    objective: ObjectiveName = "completion"
    baseline: BaselineName = "samples"
    baseline_decay: float = 0.8
    scenarios: int = 16
    samples: int = 8
    updates: int = 1000
    learning_rate: float = 3e-4
    final_learning_rate: float = 3e-5
    clip_norm: float = 1.0
    normalise: bool = True
    entropy: float = 0.0
    temperature: float = 1.0
    epoch: int = 50
    validation_scenarios: int = 96
    significance: float = 0.05
    initial: str = ""
    seed: int = 0
    keep_checkpoints: int = 3
    device: str = "auto"
    precision: Precision = "float32"

    @property
    def total_updates(self) -> int:
        """Gradient steps altogether."""
        return self.imitation_updates + self.updates

    def __post_init__(self) -> None:
        self._check_counts()
        self._check_numbers()
        self._check_names()
        if self.imitation_updates and self.imitation_plans < self.imitation_batch:
            raise ConfigError(
                f"imitation_plans is {self.imitation_plans}; expected at least imitation_batch, {self.imitation_batch}"
            )
        if self.max_robots < self.min_robots:
            raise ConfigError(f"max_robots is {self.max_robots}; expected at least min_robots, {self.min_robots}")
        if self.normalise and self.scenarios * self.samples < 2:
            raise ConfigError("normalise compares the missions of an update; scenarios x samples is 1, expected >= 2")
        if self.baseline == "samples" and self.samples < 2:
            raise ConfigError("the 'samples' baseline compares samples of a scenario; samples is 1, expected >= 2")

    def _check_counts(self) -> None:
        for least, names in LEAST.items():
            for name in names:
                if getattr(self, name) < least:
                    raise ConfigError(f"{name} is {getattr(self, name)}; expected a whole number >= {least}")
        if not self.tasks or min(self.tasks) < 1:
            raise ConfigError(f"tasks is {self.tasks}; expected one or more whole numbers >= 1")
        if self.imitation_decisions > MOST_DECISIONS:
            raise ConfigError(f"imitation_decisions is {self.imitation_decisions}; expected at most {MOST_DECISIONS:,}")
        if self.validation_scenarios < 2:
            raise ConfigError(f"validation_scenarios is {self.validation_scenarios}; expected at least 2")
        for name in ("scenarios", "samples", "validation_scenarios", "imitation_batch"):
            if getattr(self, name) > MOST:  # whose memory would run out, sooner or later
                raise ConfigError(f"{name} is {getattr(self, name)}; expected at most {MOST}")
        check_seed(self.seed)

    def _check_numbers(self) -> None:
        weights = self.task_weights
        if weights and (len(weights) != len(self.tasks) or not all(0 < weight < math.inf for weight in weights)):
            raise ConfigError(f"task_weights is {weights}; expected a number > 0 for each of tasks")
        for name in ("learning_rate", "imitation_learning_rate", "final_learning_rate", "clip_norm"):
            if not 0 < getattr(self, name) < math.inf:
                raise ConfigError(f"{name} is {getattr(self, name)}; expected a number > 0")
        if not 1e-6 <= self.temperature <= 1e6:  # what float32 can bear
            raise ConfigError(f"temperature is {self.temperature}; expected a number from 1e-6 to 1e6, such as 0.5")
        if not 0 < self.significance < 1:
            raise ConfigError(f"significance is {self.significance}; expected a number between 0 and 1")
        if not 0 <= self.baseline_decay < 1:
            raise ConfigError(f"baseline_decay is {self.baseline_decay}; expected a number >= 0 and < 1")
        if not 0 <= self.entropy < math.inf:
            raise ConfigError(f"entropy is {self.entropy}; expected a number >= 0")
        check_kinds(self.kinds)

    def _check_names(self) -> None:
        for name, names in NAMES.items():
            if getattr(self, name) not in get_args(names):
                choices = ", ".join(get_args(names))
                raise ConfigError(f"{name} is {getattr(self, name)!r}; expected one of {choices}")
        if self.device not in ("cpu", "cuda", "auto"):
            raise ConfigError(f"device is {self.device!r}; expected cpu, cuda or auto")
