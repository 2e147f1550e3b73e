"""The same done to each tensor of a tree."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import torch
from torch import Tensor, tensor

from mrta_zoo.policies.neural.tensor_tree import select, tree_map


@dataclass(frozen=True)
class Pair:
    left: Any
    right: Any


def leaves(tree: Any) -> list[Any]:
    found: list[Any] = []

    def note(each: Tensor) -> Tensor:
        found.append(each.tolist())
        return each

    tree_map(note, tree)
    return found


def test_dataclasses_and_tuples_are_gone_through_in_order() -> None:
    tree = Pair(tensor([1, 2]), (tensor([3, 4]), Pair(None, tensor([5, 6]))))
    assert leaves(tree) == [[1, 2], [3, 4], [5, 6]]
    chosen = select(tree, tensor([1]))
    assert leaves(chosen) == [[2], [4], [6]]
    assert chosen.right[1].left is None


def test_corresponding_tensors_meet() -> None:
    trees = [Pair(tensor([k]), (tensor([10 * k]), None)) for k in range(3)]
    joined = tree_map(lambda *each: torch.cat(each), *trees)
    assert leaves(joined) == [[0, 1, 2], [0, 10, 20]]
