"""The decoder: attention from the query to the tasks, a feed-forward layer, a score for each task (paper §III-B)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import torch
from torch import Tensor, nn

WIDENED = 4
"""Width of the feed-forward layer as a multiple of the embedding's, as in Vaswani et al. (2017)."""


@dataclass(frozen=True, slots=True)
class Keys:
    """What the decoder needs of the embeddings; computed once per mission.

    Attributes:
        glimpse_key: (S, heads, h / heads, N).
        glimpse_value: (S, heads, N, h / heads).
        score_key: (S, h, N).
    """

    glimpse_key: Tensor
    glimpse_value: Tensor
    score_key: Tensor


class AttentionDecoder(nn.Module):
    """Attention from the query to the tasks (paper Eqs. 5-6), a feed-forward layer, then clipped scores.

    Scores are compatibilities with the tasks, as in Kool et al. (2019). Deviations from the paper, which says little of
    the feed-forward layer and puts batch norms around it: the query bypasses the attention (a residual connection, as
    in Vaswani et al. 2017), and a layer norm takes the place of batch norms, so that no decision depends on others.

    Args:
        embedding: h.
        heads: number of attention heads, h_e = 8 in the paper.
        tanh_clip: scores lie in ± this.
    """

    def __init__(self, embedding: int, heads: int, tanh_clip: float) -> None:
        super().__init__()
        self.heads = heads
        self.tanh_clip = tanh_clip
        self.keys_values = nn.Linear(embedding, 3 * embedding, bias=False)
        self.out = nn.Linear(embedding, embedding, bias=False)
        self.norm = nn.LayerNorm(embedding)
        self.feed_forward = nn.Sequential(
            nn.Linear(embedding, WIDENED * embedding), nn.ReLU(), nn.Linear(WIDENED * embedding, embedding)
        )

    def keys(self, embeddings: Tensor) -> Keys:
        """Keys and values of (S, N, h) embeddings."""
        key, value, score_key = self.keys_values(embeddings).chunk(3, -1)
        return Keys(
            glimpse_key=key.unflatten(-1, (self.heads, -1)).permute(0, 2, 3, 1).contiguous(),
            glimpse_value=value.unflatten(-1, (self.heads, -1)).transpose(1, 2).contiguous(),
            score_key=score_key.transpose(1, 2).contiguous(),
        )

    def forward(self, query: Tensor, keys: Keys, mask: Tensor) -> Tensor:
        """Score every task.

        Args:
            query: (S, G, h) one query per decision.
            keys: of the tasks.
            mask: (S, G, N) bool, what may be chosen; where nothing may, scores are meaningless but finite.

        Returns:
            (S, G, N) scores in ± `tanh_clip`, not masked.
        """
        heads_query = query.unflatten(-1, (self.heads, -1)).transpose(1, 2)
        compatibility = heads_query @ keys.glimpse_key / math.sqrt(heads_query.shape[-1])
        # The lowest finite number, not -inf, so that a decision without any choice gives no NaN.
        compatibility = compatibility.masked_fill(~mask[:, None], torch.finfo(query.dtype).min)
        glimpse = (compatibility.softmax(-1) @ keys.glimpse_value).transpose(1, 2).flatten(2)
        hidden = self.norm(query + self.out(glimpse))
        hidden = hidden + self.feed_forward(hidden)
        score = hidden @ keys.score_key / math.sqrt(query.shape[-1])
        clipped: Tensor = self.tanh_clip * score.tanh()
        return clipped
