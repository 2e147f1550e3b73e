"""What training minimises, by hand."""

import math

import pytest
import torch

from mrta_zoo import Scenario
from mrta_zoo.policies.neural.rollout import Rollout
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.objective import OBJECTIVES

TWO_TASKS = Scenario(
    task_xy=[[10, 10], [90, 90]],
    deadline=[50, 80],
    workload=[10, 10],
    robot_xy=[[0, 0]],
    capacity=[1],
    map_size=(100, 100),
)


@pytest.mark.parametrize(
    ("name", "losses"),
    [
        ("cost", [1.5 / 2, 0.0, 3.0 / 2]),
        ("completion", [1 - 1 / 2, 1 - 2 / 2, 1 - 0 / 2]),
        ("relative", [-math.log(2), -math.log(3), 0.0]),
    ],
)
def test_objectives_by_hand(name: str, losses: list[float]) -> None:
    """Three missions of one scenario with two tasks, which complete 1, 2 and 0 of them at costs 1.5, 0 and 3."""
    rollout = Rollout(
        cost=torch.tensor([1.5, 0.0, 3.0], dtype=torch.float64),
        completed=torch.tensor([1, 2, 0]),
        log_prob=torch.zeros(3),
    )
    given = OBJECTIVES[name](rollout, ScenarioBatch.of([TWO_TASKS]))
    assert given.tolist() == pytest.approx(losses)
