"""The context: the state of the mission and the robots as one query vector (paper §III-B)."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor, nn

from mrta_zoo.policies.neural.capam.inputs import USUAL_CROSSINGS, DecisionStates, Tasks
from mrta_zoo.policies.neural.capam.named import Named, of_shape

ContextFeature = Callable[[Tasks, DecisionStates], Tensor]
"""(S, G) numbers, one per decision; best roughly in [0, 1]."""

CONTEXT_FEATURES: Named[ContextFeature] = Named("context_features", {})
"""Features besides the paper's by the names that `NetworkConfig.context_features` lists, all of them users' own:
``@CONTEXT_FEATURES.register("name")``."""


class Context(nn.Module):
    """The paper's five features: elapsed time, own capacity, own place, the peers' destinations and capacities.

    The paper concatenates the peers, which fixes their number. Here each peer's destination and capacity pass
    through one shared layer, then mean and maximum over the peers: any number of peers, in any order. The two scales
    of the mission (`Tasks.horizon`, `Tasks.work_unit`) are added, since everything else is relative to them.

    Args:
        embedding: h, length of the query.
        more: names of features in `CONTEXT_FEATURES` to add.

    Raises:
        ConfigError: if there is no feature of some name.
    """

    OWN = 7
    PEER = 5

    def __init__(self, embedding: int, more: tuple[str, ...] = ()) -> None:
        super().__init__()
        self.more = {name: CONTEXT_FEATURES.find(name) for name in more}
        self.own = nn.Linear(self.OWN + len(more), embedding)
        self.peer = nn.Linear(self.PEER, embedding)
        self.query = nn.Linear(3 * embedding, embedding)

    def forward(self, tasks: Tasks, states: DecisionStates) -> Tensor:
        """The query of each decision: (S, G, h)."""
        own_xy = states.of_ego(states.xy)
        shape, device = states.elapsed.shape, states.elapsed.device
        horizon = tasks.horizon[:, None].expand_as(states.elapsed)
        work_unit = tasks.work_unit[:, None].expand_as(states.elapsed)
        own = torch.stack(
            (
                states.elapsed,
                states.elapsed * horizon / USUAL_CROSSINGS,
                horizon / USUAL_CROSSINGS,
                work_unit,
                states.of_ego(states.capacity),
                *own_xy.unbind(-1),
                *(
                    of_shape("context feature", name, feature(tasks, states), shape, device).float()
                    for name, feature in self.more.items()
                ),
            ),
            -1,
        )
        offset = states.xy - own_xy[..., None, :]
        peer = torch.cat((states.xy, offset, states.capacity[..., None]), -1)
        peers = torch.relu(self.peer(peer)) * states.peers[..., None]
        count = states.peers.sum(-1, keepdim=True).clamp(min=1)
        pooled = torch.cat((torch.relu(self.own(own)), peers.sum(-2) / count, peers.amax(-2)), -1)
        query: Tensor = self.query(pooled)
        return query
