"""What all runs of a study have in common."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mrta_zoo.errors import ConfigError
from mrta_zoo.train.config import TrainConfig


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainingBudget:
    """What a study gives to each of its runs.

    Attributes:
        updates: gradient steps.
        scenarios: scenarios in each update.
        samples: missions sampled of each scenario.
        tasks: tasks of a scenario, in training and in the comparison.
        validations: how often a run is validated, not counting the one at the beginning.
        validation_scenarios: on how many scenarios.

    Raises:
        ConfigError: if a value is out of range.
    """

    updates: int
    scenarios: int
    samples: int
    tasks: int
    validations: int
    validation_scenarios: int

    def __post_init__(self) -> None:
        for name in ("updates", "scenarios", "tasks", "validations"):
            if getattr(self, name) < 1:
                raise ConfigError(f"{name} is {getattr(self, name)}; expected a whole number >= 1")
        if self.samples < 2:
            raise ConfigError(f"samples is {self.samples}; expected at least 2, as samples are compared")

    def config(self, **settings: Any) -> TrainConfig:
        """A run on TAPTC-like scenarios by REINFORCE alone.

        Args:
            **settings: fields of `TrainConfig` that differ.
        """
        updates = settings.get("updates", self.updates)
        usual: dict[str, Any] = {
            "generator": "taptc",
            "tasks": (self.tasks,),
            "reference_tasks": self.tasks,
            "scenarios": self.scenarios,
            "samples": self.samples,
            "updates": updates,
            "learning_rate": 1e-3,
            "final_learning_rate": 1e-4,
            "epoch": max(1, updates // self.validations),
            "validation_scenarios": self.validation_scenarios,
            "keep_checkpoints": 1,
            "device": "cpu",
        }
        return TrainConfig(**(usual | settings))
