"""Node features: what encoders know of each task. ``@NODE_FEATURES.register("name")`` adds a feature of your own."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor

from mrta_zoo.policies.neural.capam.inputs import USUAL_CROSSINGS, Tasks
from mrta_zoo.policies.neural.capam.named import Named, of_shape

NodeFeature = Callable[[Tasks], Tensor]
"""(S, N) numbers, one per task; best roughly in [0, 1]."""

NODE_FEATURES: Named[NodeFeature] = Named(
    "node_features",
    {
        "x": lambda tasks: tasks.xy[..., 0],
        "y": lambda tasks: tasks.xy[..., 1],
        "deadline": lambda tasks: tasks.deadline,
        "deadline_in_crossings": lambda tasks: tasks.deadline * tasks.horizon[:, None] / USUAL_CROSSINGS,
        "workload": lambda tasks: tasks.workload,
        "workload_in_crossings": lambda tasks: tasks.workload * tasks.work_unit[:, None],
    },
)
"""Features by the names that `NetworkConfig.node_features` lists. Networks that were trained with another list keep it,
so that a new entry does not touch them."""


def node_features(tasks: Tasks, names: tuple[str, ...]) -> Tensor:
    """(S, N, F) the named features of every task.

    Raises:
        ConfigError: if there is no feature of some name.
    """
    shape, device = tasks.exists.shape, tasks.exists.device
    columns = [of_shape("node feature", name, NODE_FEATURES.find(name)(tasks), shape, device).float() for name in names]
    return torch.stack(columns, -1)
