"""Trees of tensors (nested dataclasses and tuples), and functions that map over their tensors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

from torch import Tensor

Tree = TypeVar("Tree")


def tree_map(function: Callable[..., Tensor], tree: Tree, *others: Tree) -> Tree:
    """Apply a function to each tensor of a tree, or to corresponding tensors of several.

    Args:
        function: takes a tensor of `tree` and the corresponding ones of `others`.
        tree: a tensor, a tuple, or a dataclass; whatever else it holds, such as None, stays as it is.
        others: trees of the same shape.

    Returns:
        a tree of the same shape.
    """
    found: Any = tree
    if isinstance(tree, Tensor):
        found = function(tree, *others)
    elif isinstance(tree, tuple):
        found = tuple(tree_map(function, *each) for each in zip(tree, *others, strict=True))
    elif is_dataclass(tree) and not isinstance(tree, type):
        columns = ([getattr(each, field.name) for each in (tree, *others)] for field in fields(tree))
        found = type(tree)(*(tree_map(function, *column) for column in columns))
    return found  # type: ignore[no-any-return]


def select(tree: Tree, index: Tensor) -> Tree:
    """The tree with some of the rows of each tensor, chosen by an index or a mask along the first dimension."""
    return tree_map(lambda tensor: tensor[index], tree)
