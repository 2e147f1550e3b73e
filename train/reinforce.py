"""REINFORCE with parameters shared among the robots (paper §III-C).

An update samples missions without gradients, compares their outcomes with a baseline, and then recomputes the
log-probabilities of all their decisions at once, with gradients: the encoder runs once per scenario, and the
decoder in a few large batches.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import torch

from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import ScenarioGenerator
from mrta_zoo.policies.cpu_threads import few_threads
from mrta_zoo.policies.neural.capam.candidate_decoder import CandidateDecoder
from mrta_zoo.policies.neural.rollout import roll_out
from mrta_zoo.policies.neural.sharing import Network, build_network
from mrta_zoo.policies.neural.temperature import tempered
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.baselines import Baseline, build_baseline
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.distribution import check_distribution, most_robots
from mrta_zoo.train.gradients import accumulate_gradients
from mrta_zoo.train.imitation.experts import ExpertPlan
from mrta_zoo.train.imitation.imitator import Imitator
from mrta_zoo.train.initial import load_initial
from mrta_zoo.train.objective import OBJECTIVES, Objective, checked
from mrta_zoo.train.precision import autocast, quick_attention
from mrta_zoo.train.scenarios import UpdateInput, draw_inputs, draw_validation
from mrta_zoo.train.schedule import cosine, learning_rate


@dataclass(frozen=True, slots=True)
class Update:
    """One gradient step."""

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
    """Eq. 1 of the paper, per task."""
    baseline_replaced: bool


@dataclass(frozen=True, slots=True)
class RunOptions:
    """Settings that change how long a run takes, but not its result, up to rounding.

    Attributes:
        workers: processes that draw scenarios ahead of time; used only with a GPU.
        compiled: whether to compile the layers of the candidate decoder.
    """

    workers: int = 0
    compiled: bool = False


class Reinforce:
    """A training run in memory. `step` and `validate` advance it; `train.checkpoint` saves and restores it.

    On a CPU they use one thread, or 4 within ``with cpu_threads(4):`` (`policies.cpu_threads`).

    All randomness derives from (seed, number of the update): a resumed run goes on exactly as if it had never
    stopped, and no generator state needs saving.
    """

    def __init__(
        self,
        config: TrainConfig,
        generator: ScenarioGenerator | None = None,
        options: RunOptions | None = None,
        objective: Objective | None = None,
    ) -> None:
        """Begin a run.

        Args:
            config: its configuration.
            generator: draws the scenarios; by default, as `config.generator` says.
            options: how fast it runs.
            objective: what to minimise, see `mrta_zoo.train.objective`; by default, as `config.objective` says.

        Raises:
            ConfigError: if `config.initial` names no policy, or one of another architecture; or if sharing is by
                capacity and the configuration's generator draws any capacity.
        """
        options = options or RunOptions()
        self.config = config
        self.device = _device(config.device)
        self.generator = generator
        self.objective = OBJECTIVES[config.objective] if objective is None else checked(objective)
        if generator is None:
            check_distribution(config)  # now rather than at the first update
        self.network: Network = build_network(
            config.network, config.sharing, most_robots(config), config.seed, config.kinds
        )
        if config.initial:
            load_initial(self.network, config)
        self.network.to(self.device)
        if options.compiled:
            for module in self.network.modules():
                if isinstance(module, CandidateDecoder):
                    for layer in module.layers:
                        layer.compile(dynamic=True)
        self.optimizer = torch.optim.Adam(self.network.parameters(), lr=config.learning_rate)
        self.baseline: Baseline = build_baseline(config, self.network, self.objective)
        self.update = 0
        self.history: list[Validation] = []
        self._validation: ScenarioBatch | None = None
        self._workers = options.workers if self.device.type == "cuda" else 0
        self._inputs: Iterator[UpdateInput] = iter(())
        self._imitator = Imitator(config, self.network, self.device)

    @property
    def validation_batch(self) -> ScenarioBatch:
        """The validation scenarios, the same all through the run."""
        if self._validation is None:
            self._validation = draw_validation(self.config, self.generator).to(self.device)
        return self._validation

    @property
    def imitates(self) -> bool:
        """Whether steps of imitation are still to come."""
        return self.update < self.config.imitation_updates

    @property
    def best(self) -> Validation:
        """The best validation so far: by completion, then cost, then the earliest. Needs at least one."""
        return max(self.history, key=lambda each: (each.completion, -each.cost))

    @few_threads()
    def step(self) -> Update:
        """One gradient step.

        Raises:
            ConfigError: if training has diverged (the weights are then unchanged), or if there are no plans to
                imitate.
        """
        if self.update == self.config.imitation_updates:
            self.optimizer.state.clear()  # gradients of REINFORCE are of another size
            self._imitator.release()
        rate = learning_rate(self.config, self.update)
        for group in self.optimizer.param_groups:
            group["lr"] = rate
        self.optimizer.zero_grad(set_to_none=True)
        loss, decisions = self._imitator.accumulate(self.update) if self.imitates else self._reinforce()
        norm = torch.nn.utils.clip_grad_norm_(self.network.parameters(), self.config.clip_norm)
        if not torch.isfinite(norm):
            raise ConfigError(
                f"training diverged in update {self.update + 1}: the gradient is not finite; go on from an earlier "
                "checkpoint with a smaller learning_rate or entropy"
            )
        self.optimizer.step()
        self.update += 1
        return Update(self.update, loss, float(norm), rate, decisions)

    def _reinforce(self) -> tuple[float, int]:
        """Accumulate the gradients of REINFORCE; returns the mean loss and the number of decisions."""
        config, policy = self.config, tempered(self.network, self.config.temperature)
        drawn = self._next_input()
        scenarios = drawn.scenarios.to(self.device)
        with autocast(self.device, config.precision), quick_attention(self.device):
            rollout = roll_out(
                policy,
                scenarios,
                samples=config.samples,
                generator=torch.Generator(self.device).manual_seed(drawn.seed),
                mask_rule=config.mask_rule,
                keep_segments=True,
            )
        loss = self.objective(rollout, scenarios).unflatten(0, (-1, config.samples))
        advantage = self.baseline.advantage(scenarios, loss).float()
        if config.normalise:
            advantage = advantage / (advantage.std() + 1e-6)
        entropy = config.entropy * cosine(config, self.update)
        accumulate_gradients(policy, scenarios, rollout.segments, advantage, entropy, config.precision)
        return float(loss.mean()), sum(int(segment.live.sum()) for segment in rollout.segments)

    @few_threads()
    def validate(self) -> Validation:
        """Evaluate greedily, let the baseline change, and append to the history."""
        scenarios = self.validation_batch
        with autocast(self.device, self.config.precision), quick_attention(self.device):
            rollout = roll_out(self.network, scenarios, mask_rule=self.config.mask_rule)
        replaced = self.update > 0 and self.baseline.end_epoch(
            self.network, scenarios, self.objective(rollout, scenarios)
        )
        tasks = scenarios.task_exists.sum(1)
        validation = Validation(
            update=self.update,
            episodes=max(0, self.update - self.config.imitation_updates) * self.config.scenarios * self.config.samples,
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
        while self.update < self.config.total_updates:
            yield self.step()
            if self.update % self.config.epoch == 0 or self.update == self.config.total_updates:
                yield self.validate()

    def set_plans(self, plans: Sequence[ExpertPlan]) -> None:
        """Set the plans to imitate; a run that imitates needs them before its first step.

        Raises:
            ConfigError: if there are no plans for one of the sizes.
        """
        self._imitator.set_plans(plans)

    def _next_input(self) -> UpdateInput:
        """The input of this update. After a resume or a failed update, drawing starts again from here."""
        drawn = next(self._inputs, None)
        if drawn is None or drawn.update != self.update:
            self._inputs = draw_inputs(self.config, self.generator, self.update, self._workers)
            drawn = next(self._inputs)
        return drawn


def _device(name: str) -> torch.device:
    if name == "auto":
        return torch.device("cuda" if torch.cuda.is_available() else "cpu")
    if name == "cuda" and not torch.cuda.is_available():
        raise ConfigError("device is 'cuda', but torch finds no GPU; expected cpu or auto")
    return torch.device(name)
