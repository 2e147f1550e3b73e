"""CapAM's encoder: graph capsules over the task graph (paper §III-A)."""

from __future__ import annotations

from typing import cast

import torch
from torch import Tensor, nn


class CapsuleEncoder(nn.Module):
    """Graph capsule convolution (GCAPCN, paper Eqs. 3-4) over the complete, weighted graph of tasks.

    Each layer l computes, for the moments p = 1..P of its input, f_p = σ(Σ_{k=0..K} L^k F^{∘p} W_pk), and
    concatenates them; a last linear layer brings the result back to the embedding length.

    Deviations from the paper: the Laplacian D − A is divided by the scenario's own largest degree, so that its
    eigenvalues lie in [0, 2] whatever the number of tasks, and a layer norm takes the place of batch norms, so that
    no embedding depends on its batch-mates. L is applied K times; its powers are never formed.

    Args:
        features: number of node features.
        embedding: h, the embedding length.
        layers: L_e, number of capsule layers.
        hops: K, degree of the polynomial filter.
        moments: P, the highest power of the features.
    """

    def __init__(self, features: int, embedding: int, layers: int, hops: int, moments: int) -> None:
        super().__init__()
        self.moments = moments
        self.hops = hops
        self.embed = nn.Linear(features, embedding)
        widths = [embedding] + [embedding * moments] * layers
        # One linear map for the K + 1 blocks [F^p, L F^p, …, L^K F^p] side by side is the sum over k in Eq. 3.
        self.capsules = nn.ModuleList(
            nn.ModuleList(nn.Linear(width * (hops + 1), embedding) for _ in range(moments)) for width in widths[:-1]
        )
        self.project = nn.Linear(widths[-1], embedding)
        self.norm = nn.LayerNorm(embedding)

    def forward(self, nodes: Tensor, exists: Tensor, graph: Tensor) -> Tensor:
        """Embed every task.

        Args:
            nodes: (S, N, features) node features.
            exists: (S, N) bool, false for padding.
            graph: (S, N, D) the node properties δ whose distances weigh the edges, each in [0, 1].

        Returns:
            (S, N, h) embeddings; 0 for padding.
        """
        keep = exists[..., None].to(nodes.dtype)
        laplacian = scaled_laplacian(graph, exists)
        hidden = self.embed(nodes) * keep
        for layer in self.capsules:
            power = torch.ones_like(hidden)
            outputs = []
            for capsule in cast(nn.ModuleList, layer):
                power = power * hidden
                blocks = [power]
                for _ in range(self.hops):
                    blocks.append(laplacian @ blocks[-1])
                outputs.append(torch.relu(capsule(torch.cat(blocks, -1))) * keep)
            hidden = torch.cat(outputs, -1)
        embedded: Tensor = self.norm(self.project(hidden)) * keep
        return embedded


def scaled_laplacian(graph: Tensor, exists: Tensor) -> Tensor:
    """(S, N, N) graph Laplacian D − A over its largest degree; A_ij = 1/(1 + |δ_i − δ_j|), A_ii = 0 (paper §II-B)."""
    pair = exists[:, :, None] & exists[:, None, :]
    offset = graph[:, :, None] - graph[:, None, :]
    adjacency = 1 / (1 + offset.square().sum(-1).sqrt())
    eye = torch.eye(graph.shape[1], dtype=torch.bool, device=graph.device)
    adjacency = adjacency.masked_fill(~pair | eye, 0.0)
    degree = adjacency.sum(-1)
    laplacian = torch.diag_embed(degree) - adjacency
    return laplacian / degree.amax(-1).clamp(min=1e-6)[:, None, None]  # a single task has degree 0
