"""Repeating the same GPU work without the CPU launching each of its kernels: CUDA graphs of rollouts.

A decision is many small kernels. A graph, recorded once for missions of one size, launches a whole segment of decisions
at once. What that gains depends on how long the kernels are: with 2,048 missions of 200 tasks on an H200 a rollout took
1.33 s instead of 1.37.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from typing import Any, Generic, TypeVar

import torch
from torch import Tensor

State = TypeVar("State")
Out = TypeVar("Out")
WARM_UP = 2
"""Runs before recording, in which libraries set themselves up."""


class Graph(Generic[State, Out]):
    """A function of a state that it changes in place, recorded for tensors of the shapes of a first state.

    Args:
        function: is run on the state; must not wait for the GPU.
        state: dataclasses, objects and tuples of tensors, on the GPU.
        generator: what the function draws from.
    """

    def __init__(
        self, function: Callable[[State], Out], state: State, generator: torch.Generator | None = None
    ) -> None:
        self.state = copy.deepcopy(state)
        stream = torch.cuda.Stream()
        stream.wait_stream(torch.cuda.current_stream())
        with torch.cuda.stream(stream):
            for _ in range(WARM_UP):
                function(copy.deepcopy(state))
        torch.cuda.current_stream().wait_stream(stream)
        self._graph = torch.cuda.CUDAGraph()
        if generator is not None:
            self._graph.register_generator_state(generator)
        kept = list(tensors(self.state))
        with torch.cuda.graph(self._graph):
            self._out = function(self.state)
            # What the function put in place of a tensor goes where that tensor is, for the next run to find.
            for old, new in zip(kept, list(tensors(self.state)), strict=True):
                if new is not old:
                    old.copy_(new)
        self._kept = kept

    def load(self, state: State) -> None:
        """Begin with another state of the same shapes."""
        for kept, new in zip(self._kept, tensors(state), strict=True):
            kept.copy_(new)

    def run(self) -> Out:
        """What the function returns now; the next run overwrites it."""
        self._graph.replay()
        return self._out


def tensors(tree: Any) -> Iterator[Tensor]:
    """The tensors in a tree of dataclasses, objects, tuples and lists, always in the same order."""
    if isinstance(tree, Tensor):
        yield tree
    elif isinstance(tree, (tuple, list)):
        for each in tree:
            yield from tensors(each)
    elif is_dataclass(tree):
        for field in fields(tree):
            yield from tensors(getattr(tree, field.name))
    elif hasattr(tree, "__dict__") and not isinstance(tree, torch.nn.Module):
        for name in sorted(vars(tree)):
            yield from tensors(vars(tree)[name])
