"""What a mission's outcome is compared with, so that luck of the scenario is not taken for merit."""

from __future__ import annotations

import copy
from typing import Protocol

from torch import Tensor

from mrta_zoo.batch import ScenarioBatch
from mrta_zoo.policies.rollout import roll_out
from mrta_zoo.policies.sharing import Network
from mrta_zoo.rules import MaskRule
from mrta_zoo.train.objective import Objective


class Baseline(Protocol):
    """Estimates the loss to be expected of a scenario."""

    def advantage(self, scenarios: ScenarioBatch, loss: Tensor) -> Tensor:
        """How much worse (> 0) than expected each sample turned out.

        Args:
            scenarios: the S scenarios.
            loss: (S, G) what each of G samples lost.

        Returns:
            (S, G).
        """
        ...

    def end_epoch(self, network: Network, validation: ScenarioBatch, loss: Tensor) -> bool:
        """Take note of the network's greedy (V,) loss on the validation scenarios; whether the baseline changed."""
        ...


class SamplesBaseline:
    """The mean of the *other* samples of the same scenario (leave-one-out; Kool et al. 2019b)."""

    def advantage(self, scenarios: ScenarioBatch, loss: Tensor) -> Tensor:
        g = loss.shape[1]
        return (loss - loss.mean(1, keepdim=True)) * (g / (g - 1))

    def end_epoch(self, network: Network, validation: ScenarioBatch, loss: Tensor) -> bool:
        return False


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

    def _greedy(self, scenarios: ScenarioBatch) -> Tensor:
        return self.objective(roll_out(self.network, scenarios, mask_rule=self.mask_rule), scenarios)
