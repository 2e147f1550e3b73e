"""What is within reach after a task, by hand."""

from __future__ import annotations

import math

import pytest
import torch

from mrta_zoo.policies.neural.capam.prospects import PROSPECT_COLUMNS, RANGES, prospects

# Two candidates, 0 and 1, of three tasks. Durations are sums of tenths of a crossing.
TRAVEL = torch.tensor([[0.0, 0.1, 0.3], [0.1, 0.0, 0.2]])
WORK = torch.tensor([0.1, 0.0, 0.3])
START = torch.tensor([0.2, 0.4])
LEFT = torch.tensor([0.5, 0.35, 0.95])
OTHERS = torch.tensor([[False, True, True], [True, False, True]])


def found(rival: list[float], others: torch.Tensor = OTHERS) -> dict[str, list[float]]:
    columns = prospects(TRAVEL, WORK, START, LEFT, others, torch.tensor(rival))
    assert columns.shape == (2, len(PROSPECT_COLUMNS))
    return dict(zip(PROSPECT_COLUMNS, columns.T.tolist(), strict=True))


def third(*weights: float) -> float:
    return math.log1p(sum(weights)) / 3


def test_by_hand() -> None:
    assert RANGES == (0.1, 0.3)
    # After task 0, at 0.2: task 1 in time at 0.3 <= 0.35, takes 0.1; task 2 at 0.5 + 0.3 <= 0.95, takes 0.6.
    # After task 1, at 0.4: task 0 would end at 0.6 > 0.5; task 2 ends at 0.6 + 0.3 <= 0.95, takes 0.5.
    # A peer is at task 1 at 0.25 < 0.3, and at task 2 at 0.55: after 0.5, before 0.6.
    columns = found([1.0, 0.25, 0.55])
    e = math.exp
    assert columns["near"] == pytest.approx([third(e(-1), e(-6)), third(e(-5))])
    assert columns["far"] == pytest.approx([third(e(-1 / 3), e(-2)), third(e(-5 / 3))])
    assert columns["near_first"] == pytest.approx([third(e(-6)), 0])
    assert columns["far_first"] == pytest.approx([third(e(-2)), 0])


def test_without_peers_the_robot_is_always_first() -> None:
    columns = found([math.inf] * 3)
    assert columns["near_first"] == columns["near"]
    assert columns["far_first"] == columns["far"]


def test_what_may_not_be_chosen_does_not_count() -> None:
    columns = found([math.inf] * 3, others=torch.zeros_like(OTHERS))
    assert all(values == [0, 0] for values in columns.values())
