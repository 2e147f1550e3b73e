"""The whole network: encoder once a mission, then context and decoder at each decision."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from mrta_zoo.policies.capam.config import NetworkConfig
from mrta_zoo.policies.capam.context import Context
from mrta_zoo.policies.capam.decision_features import FEATURES, Neighbourhood, decision_features
from mrta_zoo.policies.capam.decoder import AttentionDecoder, Keys
from mrta_zoo.policies.capam.encoders import build_encoder
from mrta_zoo.policies.capam.inputs import Moments, Tasks
from mrta_zoo.policies.capam.node_features import node_features


@dataclass(frozen=True, slots=True)
class Encoding:
    """What a network knows of a mission's tasks; stays the same while it lasts."""

    tasks: Tasks
    keys: Keys
    neighbourhood: Neighbourhood | None

    def select(self, index: Tensor) -> Encoding:
        """The encodings of some of the scenarios."""
        near = self.neighbourhood.select(index) if self.neighbourhood else None
        return Encoding(self.tasks.select(index), self.keys.select(index), near)


class AllocationNetwork(nn.Module):
    """Scores the tasks for the robot to act. One set of weights serves every robot, any number of tasks and robots.

    With the default configuration this is CapAM; with ``encoder="attention"`` the paper's AM-RL.
    """

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.config = config
        h = config.embedding
        self.encoder = build_encoder(len(config.node_features), config)
        self.context = Context(h)
        self.decoder = AttentionDecoder(h, config.heads, config.tanh_clip)
        self.pair = PairScore(h, config.heads) if config.decision_features else None

    def encode(self, tasks: Tasks) -> Encoding:
        """Embed the tasks; once a mission."""
        embeddings = self.encoder(
            node_features(tasks, self.config.node_features), tasks.exists, graph_properties(tasks)
        )
        near = Neighbourhood.of(tasks) if self.pair else None
        return Encoding(tasks, self.decoder.keys(embeddings), near)

    def features(self, encoding: Encoding, moments: Moments) -> Tensor | None:
        """The decision-time features that `forward` uses, (S, G, N, F), or None; no gradients flow through them."""
        if encoding.neighbourhood is None:
            return None
        with torch.no_grad():
            return decision_features(encoding.tasks, encoding.neighbourhood, moments)

    def forward(self, encoding: Encoding, moments: Moments, features: Tensor | None = None) -> Tensor:
        """Log-probabilities of choosing each task: (S, G, N); −inf where the mask forbids.

        Where a mission is over (nothing may be chosen) they are uniform, so that no NaN arises.

        Args:
            encoding: of the S scenarios, from `encode`.
            moments: G decisions of each.
            features: what `features` gave for these moments, if it was called before.
        """
        query = self.context(encoding.tasks, moments)
        if self.pair is None:
            scores = self.decoder(query, encoding.keys, moments.mask)
        else:
            if features is None:
                features = self.features(encoding, moments)
            assert features is not None
            bias, added = self.pair(features, query)
            scores = self.decoder(query, encoding.keys, moments.mask, bias) + added
        over = ~moments.mask.any(-1, keepdim=True)
        log_probs: Tensor = (
            scores.masked_fill(~(moments.mask | over), -torch.inf).masked_fill(over, 0.0).log_softmax(-1)
        )
        return log_probs


class PairScore(nn.Module):
    """Scores each task from its decision-time features, and biases the decoder's glimpse.

    A small network sees each pair's features beside the query; to its score comes −β · (travel + work), β learned,
    so that training starts near the nearest-task heuristic and not from noise.

    Args:
        embedding: h, length of the query.
        heads: number of heads of the glimpse.
        width: hidden width.
        beta: β at the start, a score a crossing.
    """

    def __init__(self, embedding: int, heads: int, width: int = 32, beta: float = 30.0) -> None:
        super().__init__()
        self.pair = nn.Linear(len(FEATURES), width)
        self.query = nn.Linear(embedding, width, bias=False)
        self.hidden = nn.Linear(width, width)
        self.out = nn.Linear(width, heads + 1)
        nn.init.zeros_(self.out.weight)
        nn.init.zeros_(self.out.bias)
        self.log_beta = nn.Parameter(torch.tensor(beta).log())

    def forward(self, features: Tensor, query: Tensor) -> tuple[Tensor, Tensor]:
        """Glimpse biases (S, G, N, heads) and scores (S, G, N)."""
        hidden = torch.relu(self.pair(features) + self.query(query)[..., None, :])
        hidden = torch.relu(self.hidden(hidden))
        out = self.out(hidden)
        duration = features[..., 0] + features[..., 1]
        return out[..., 1:], out[..., 0] - self.log_beta.exp() * duration


def graph_properties(tasks: Tasks) -> Tensor:
    """(S, N, 3) the node properties δ = (x, y, deadline) that weigh the task graph (paper §II-B), in [0, 1]."""
    return torch.cat((tasks.xy, tasks.deadline[..., None]), -1)
