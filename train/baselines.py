"""Baselines of REINFORCE: the loss that a mission is compared with, so that an easy scenario earns no credit."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

import torch
from torch import Tensor

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.neural.rollout import roll_out
from mrta_zoo.policies.neural.sharing import Network
from mrta_zoo.policies.neural.weights import load_state
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.config import BaselineName, TrainConfig
from mrta_zoo.train.objective import Objective


class Baseline(Protocol):
    """Estimates the expected loss on a scenario."""

    def advantage(self, scenarios: ScenarioBatch, loss: Tensor) -> Tensor:
        """How much worse (> 0) than expected each sample turned out.

        Args:
            scenarios: the S scenarios.
            loss: (S, G) loss of each of G samples.

        Returns:
            (S, G).
        """
        ...

    def end_epoch(self, network: Network, validation: ScenarioBatch, loss: Tensor) -> bool:
        """Learn the network's greedy (V,) loss on the validation scenarios; returns whether the baseline changed."""
        ...

    def state(self) -> dict[str, Tensor]:
        """The tensors that a checkpoint must hold; empty if the baseline has no state."""
        ...

    def restore(self, state: dict[str, Tensor], path: Path) -> None:
        """Restore what `state` returned.

        Raises:
            ConfigError: if it does not fit; the message names the file, `path`.
        """
        ...


class Memoryless:
    """Base of the baselines without state."""

    def state(self) -> dict[str, Tensor]:
        return {}

    def restore(self, state: dict[str, Tensor], path: Path) -> None:
        pass


class SamplesBaseline(Memoryless):
    """The mean of the *other* samples of the same scenario (leave-one-out; Kool et al. 2019b)."""

    def advantage(self, scenarios: ScenarioBatch, loss: Tensor) -> Tensor:
        g = loss.shape[1]
        return (loss - loss.mean(1, keepdim=True)) * (g / (g - 1))

    def end_epoch(self, network: Network, validation: ScenarioBatch, loss: Tensor) -> bool:
        return False


class ExponentialBaseline:
    """A moving average of the losses, the same for all scenarios (the simplest one in Kool et al. 2019).

    It starts as the mean of the first batch. Each later batch makes it decay · average + (1 − decay) · mean of the
    batch, and is compared with this new average.

    Args:
        decay: in 0..1; 0 compares with the batch's own mean.
    """

    def __init__(self, decay: float) -> None:
        self.decay = decay
        self.average: float | None = None

    def advantage(self, scenarios: ScenarioBatch, loss: Tensor) -> Tensor:
        mean = float(loss.mean())
        self.average = mean if self.average is None else self.decay * self.average + (1 - self.decay) * mean
        return loss - self.average

    def end_epoch(self, network: Network, validation: ScenarioBatch, loss: Tensor) -> bool:
        return False

    def state(self) -> dict[str, Tensor]:
        return {} if self.average is None else {"average": torch.tensor(self.average, dtype=torch.float64)}

    def restore(self, state: dict[str, Tensor], path: Path) -> None:
        average = state.get("average")
        if set(state) != {"average"} or average is None or average.numel() != 1 or not torch.isfinite(average).all():
            raise ConfigError(f"{path}: expected one finite number, the moving average of an exponential baseline")
        self.average = float(average)


class RolloutBaseline:
    """The greedy rollout of the best policy so far (paper §III-C, Table I; Kool et al. 2019).

    Args:
        network: the policy at the start.
        objective: the loss.
        mask_rule: what robots may choose.
        significance: level of the paired one-sided t-test.
    """

    def __init__(self, network: Network, objective: Objective, mask_rule: MaskRule, significance: float) -> None:
        self.network = copy.deepcopy(network)
        self.objective = objective
        self.mask_rule = mask_rule
        self.significance = significance

    def advantage(self, scenarios: ScenarioBatch, loss: Tensor) -> Tensor:
        return loss - self._greedy(scenarios)[:, None]

    def end_epoch(self, network: Network, validation: ScenarioBatch, loss: Tensor) -> bool:
        """Replace the baseline if a paired t-test says that the network's validation losses are smaller."""
        from scipy import stats

        own = self._greedy(validation)
        if loss.mean() >= own.mean():
            return False
        test = stats.ttest_rel(loss.cpu().numpy(), own.cpu().numpy(), alternative="less")
        if float(test.pvalue) >= self.significance:
            return False
        self.network.load_state_dict(network.state_dict())
        return True

    def state(self) -> dict[str, Tensor]:
        return dict(self.network.state_dict())

    def restore(self, state: dict[str, Tensor], path: Path) -> None:
        load_state(self.network, state, path)

    def _greedy(self, scenarios: ScenarioBatch) -> Tensor:
        return self.objective(roll_out(self.network, scenarios, mask_rule=self.mask_rule), scenarios)


BASELINES: dict[BaselineName, Callable[[TrainConfig, Network, Objective], Baseline]] = {
    "samples": lambda config, network, objective: SamplesBaseline(),
    "rollout": lambda config, network, objective: RolloutBaseline(
        network, objective, config.mask_rule, config.significance
    ),
    "exponential": lambda config, network, objective: ExponentialBaseline(config.baseline_decay),
}
"""Every baseline, at the start of a run."""


def build_baseline(config: TrainConfig, network: Network, objective: Objective) -> Baseline:
    """The baseline that a configuration names, at the start of its run."""
    return BASELINES[config.baseline](config, network, objective)
