"""The decoder: multi-head attention from the query to the tasks, then one score a task (paper §III-B)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import torch
from torch import Tensor, nn


@dataclass(frozen=True, slots=True)
class Keys:
    """What the decoder needs of the embeddings; computed once a mission.

    Attributes:
        glimpse_key: (S, heads, h / heads, N).
        glimpse_value: (S, heads, N, h / heads).
        score_key: (S, h, N).
    """

    glimpse_key: Tensor
    glimpse_value: Tensor
    score_key: Tensor

    def select(self, index: Tensor) -> Keys:
        """The keys of some of the scenarios."""
        return Keys(self.glimpse_key[index], self.glimpse_value[index], self.score_key[index])


class AttentionDecoder(nn.Module):
    """Attention glimpse over the tasks, then clipped compatibility scores (Kool et al. 2019, as the paper's Eq. 6).

    Args:
        embedding: h.
        heads: number of heads of the glimpse, h_e = 8 in the paper.
        tanh_clip: scores lie in ± this.
    """

    def __init__(self, embedding: int, heads: int, tanh_clip: float) -> None:
        super().__init__()
        self.heads = heads
        self.tanh_clip = tanh_clip
        self.keys_values = nn.Linear(embedding, 3 * embedding, bias=False)
        self.out = nn.Linear(embedding, embedding, bias=False)

    def keys(self, embeddings: Tensor) -> Keys:
        """Keys and values of (S, N, h) embeddings."""
        key, value, score_key = self.keys_values(embeddings).chunk(3, -1)
        return Keys(
            glimpse_key=key.unflatten(-1, (self.heads, -1)).permute(0, 2, 3, 1).contiguous(),
            glimpse_value=value.unflatten(-1, (self.heads, -1)).transpose(1, 2).contiguous(),
            score_key=score_key.transpose(1, 2).contiguous(),
        )

    def forward(self, query: Tensor, keys: Keys, mask: Tensor, bias: Tensor | None = None) -> Tensor:
        """Score every task.

        Args:
            query: (S, G, h) one query a decision.
            keys: of the tasks.
            mask: (S, G, N) bool, what may be chosen; where nothing may, scores are meaningless but finite.
            bias: (S, G, N, heads) added to the glimpse's compatibilities, or None.

        Returns:
            (S, G, N) scores in ± `tanh_clip`, not masked.
        """
        heads_query = query.unflatten(-1, (self.heads, -1)).transpose(1, 2)
        compatibility = heads_query @ keys.glimpse_key / math.sqrt(heads_query.shape[-1])
        if bias is not None:
            compatibility = compatibility + bias.permute(0, 3, 1, 2)
        # The lowest finite number, not -inf, so that a decision without any choice gives no NaN.
        compatibility = compatibility.masked_fill(~mask[:, None], torch.finfo(query.dtype).min)
        glimpse = (compatibility.softmax(-1) @ keys.glimpse_value).transpose(1, 2).flatten(2)
        score = self.out(glimpse) @ keys.score_key / math.sqrt(query.shape[-1])
        clipped: Tensor = self.tanh_clip * score.tanh()
        return clipped
