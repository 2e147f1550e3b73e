"""The attention model's encoder (Kool et al. 2019), which the paper compares CapAM with as AM-RL."""

from __future__ import annotations

import torch
from torch import Tensor, nn


class AttentionEncoder(nn.Module):
    """Layers of self-attention among the tasks, each followed by a feed-forward block, both with skip connections.

    Deviation from Kool et al.: layer norm in place of batch norm, so that no embedding depends on its batch-mates.

    Args:
        features: number of node features.
        embedding: h, the embedding length, a multiple of `heads`.
        layers: number of attention layers (3 in Kool et al.).
        heads: number of attention heads.
    """

    def __init__(self, features: int, embedding: int, layers: int, heads: int) -> None:
        super().__init__()
        self.embed = nn.Linear(features, embedding)
        self.layers = nn.ModuleList(_Layer(embedding, heads) for _ in range(layers))

    def forward(self, nodes: Tensor, exists: Tensor, graph: Tensor) -> Tensor:
        """Embed every task.

        Args:
            nodes: (S, N, features) node features.
            exists: (S, N) bool, false for padding.
            graph: (S, N, D) not used: attention finds its own weights.

        Returns:
            (S, N, h) embeddings; 0 for padding.
        """
        keep = exists[..., None].to(nodes.dtype)
        hidden: Tensor = self.embed(nodes) * keep
        for layer in self.layers:
            hidden = layer(hidden, exists) * keep
        return hidden


class _Layer(nn.Module):
    def __init__(self, embedding: int, heads: int) -> None:
        super().__init__()
        self.heads = heads
        self.qkv = nn.Linear(embedding, 3 * embedding, bias=False)
        self.out = nn.Linear(embedding, embedding, bias=False)
        self.feed_forward = nn.Sequential(
            nn.Linear(embedding, 4 * embedding), nn.ReLU(), nn.Linear(4 * embedding, embedding)
        )
        self.norms = nn.ModuleList(nn.LayerNorm(embedding) for _ in range(2))

    def forward(self, hidden: Tensor, exists: Tensor) -> Tensor:
        query, key, value = self.qkv(hidden).unflatten(-1, (3, self.heads, -1)).permute(2, 0, 3, 1, 4)
        mixed = torch.nn.functional.scaled_dot_product_attention(query, key, value, attn_mask=exists[:, None, None, :])
        hidden = self.norms[0](hidden + self.out(mixed.transpose(1, 2).flatten(2)))
        normed: Tensor = self.norms[1](hidden + self.feed_forward(hidden))
        return normed
