"""The encoder "none": a linear map of each task by itself."""

from __future__ import annotations

from torch import Tensor, nn


class LinearEncoder(nn.Module):
    """A linear map of each task's features, to see what the other encoders add.

    Args:
        features: number of node features.
        embedding: h, the embedding length.
    """

    def __init__(self, features: int, embedding: int) -> None:
        super().__init__()
        self.embed = nn.Linear(features, embedding)

    def forward(self, nodes: Tensor, exists: Tensor, graph: Tensor) -> Tensor:
        """Embed every task.

        Args:
            nodes: (S, N, features) node features.
            exists: (S, N) bool, false for padding.
            graph: (S, N, D) not used.

        Returns:
            (S, N, h) embeddings; 0 for padding.
        """
        embedded: Tensor = self.embed(nodes) * exists[..., None].to(nodes.dtype)
        return embedded
