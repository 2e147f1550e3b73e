"""The whole network: the encoder once per mission, then context and decoder at each decision."""

from __future__ import annotations

from dataclasses import dataclass, replace

import torch
from torch import Tensor, nn

from mrta_zoo.policies.neural.capam.candidate_decoder import CandidateDecoder
from mrta_zoo.policies.neural.capam.candidates import Candidates
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.context import Context
from mrta_zoo.policies.neural.capam.decoder import AttentionDecoder, Keys
from mrta_zoo.policies.neural.capam.encoders import build_encoder
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.capam.named import of_shape
from mrta_zoo.policies.neural.capam.neighbourhood import Neighbourhood
from mrta_zoo.policies.neural.capam.node_features import NODE_FEATURES, node_features


@dataclass(frozen=True, slots=True)
class Encoding:
    """A network's encoding of a mission's tasks, the same for the whole mission.

    Attributes:
        tasks: the tasks.
        keys: for the attention decoder.
        embeddings: (S, N, h) for the candidate decoder.
        neighbourhood: for the candidate decoder.
    """

    tasks: Tasks
    keys: Keys | None = None
    embeddings: Tensor | None = None
    neighbourhood: Neighbourhood | None = None


class AllocationNetwork(nn.Module):
    """Scores the tasks for the acting robot. One set of weights serves every robot, any number of tasks and robots.

    With the default configuration this is CapAM; with ``encoder="attention"`` the paper's AM-RL; with
    ``decoder="candidates"`` CapAM+.

    Raises:
        ConfigError: if there is no encoder or feature of a name that the configuration lists.
    """

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.config = config
        for name in config.node_features:
            NODE_FEATURES.find(name)  # now rather than at the first mission
        h = config.embedding
        self.encoder = build_encoder(len(config.node_features), config)
        self.context: Context | None = None
        self.decoder: AttentionDecoder | CandidateDecoder
        if config.decoder == "attention":
            self.context = Context(h, config.context_features)
            self.decoder = AttentionDecoder(h, config.heads, config.tanh_clip)
        else:
            self.decoder = CandidateDecoder(h, config.heads, config.decision_layers)

    def encode(self, tasks: Tasks) -> Encoding:
        """Embed the tasks; once per mission."""
        embeddings = self.encoder(
            node_features(tasks, self.config.node_features), tasks.exists, graph_properties(tasks)
        )
        shape = (*tasks.exists.shape, self.config.embedding)
        of_shape("encoder", self.config.encoder, embeddings, shape, tasks.exists.device)
        if embeddings.dtype not in (torch.float16, torch.bfloat16):  # those are left to autocast
            embeddings = embeddings.float()
        if isinstance(self.decoder, AttentionDecoder):
            return Encoding(tasks, keys=self.decoder.keys(embeddings))
        return replace(self.surroundings(tasks), embeddings=self.decoder.encoded(embeddings))

    def surroundings(self, tasks: Tasks) -> Encoding:
        """The part of an encoding that `features` needs; it does not run the encoder."""
        if isinstance(self.decoder, AttentionDecoder):
            return Encoding(tasks)
        return Encoding(tasks, neighbourhood=Neighbourhood.of(tasks))

    def features(self, encoding: Encoding, states: DecisionStates) -> Candidates | None:
        """What `forward` needs besides these states, or None; no gradients flow through it."""
        if encoding.neighbourhood is None:
            return None
        with torch.no_grad():
            return Candidates.of(
                encoding.tasks, encoding.neighbourhood, states, self.config.candidates, self.config.peers
            )

    def forward(self, encoding: Encoding, states: DecisionStates, features: Candidates | None = None) -> Tensor:
        """Log-probabilities of choosing each task: (S, G, N); −inf if masked, or not a candidate.

        Where a mission is over (nothing may be chosen) they are uniform, so that no NaN arises.

        Args:
            encoding: of the S scenarios, from `encode`.
            states: G decisions of each.
            features: what `features` gave for these states, if it was called before.
        """
        over = ~states.mask.any(-1, keepdim=True)
        if isinstance(self.decoder, AttentionDecoder):
            assert encoding.keys is not None
            assert self.context is not None
            scores = self.decoder(self.context(encoding.tasks, states), encoding.keys, states.mask)
            scores = scores.masked_fill(~states.mask, -torch.inf)
        else:
            assert encoding.embeddings is not None
            if features is None:
                features = self.features(encoding, states)
            assert features is not None
            of_candidates = self.decoder(encoding.embeddings, features)
            scores = torch.full(states.mask.shape, -torch.inf, device=of_candidates.device)
            scores = scores.scatter(2, features.index, of_candidates)
        log_probs: Tensor = scores.masked_fill(over, 0.0).log_softmax(-1)
        return log_probs


def graph_properties(tasks: Tasks) -> Tensor:
    """(S, N, 3) the node properties δ = (x, y, deadline) that weigh the task graph (paper §II-B), in [0, 1]."""
    return torch.cat((tasks.xy, tasks.deadline[..., None]), -1)
