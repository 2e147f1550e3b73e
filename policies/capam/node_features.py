"""What the encoders know of each task. To add a feature, give it an entry in `NODE_FEATURES`."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor

from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.capam.inputs import USUAL_CROSSINGS, Tasks

NODE_FEATURES: dict[str, Callable[[Tasks], Tensor]] = {
    "x": lambda tasks: tasks.xy[..., 0],
    "y": lambda tasks: tasks.xy[..., 1],
    "deadline": lambda tasks: tasks.deadline,
    "deadline_in_crossings": lambda tasks: tasks.deadline * tasks.horizon[:, None] / USUAL_CROSSINGS,
    "workload": lambda tasks: tasks.workload,
    "workload_in_crossings": lambda tasks: tasks.workload * tasks.work_unit[:, None],
}
"""Features by the names that `NetworkConfig.node_features` lists; each gives (S, N), about in [0, 1]. Networks that
were trained with another list keep it, so that a new entry does not touch them."""


def node_features(tasks: Tasks, names: tuple[str, ...]) -> Tensor:
    """(S, N, F) the named features of every task.

    Raises:
        ConfigError: if there is no feature of some name.
    """
    for name in names:
        if name not in NODE_FEATURES:
            raise ConfigError(f"node_features has {name!r}; expected some of {', '.join(NODE_FEATURES)}")
    return torch.stack([NODE_FEATURES[name](tasks) for name in names], -1)
