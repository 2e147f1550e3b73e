"""The decoder of CapAM+: layers of attention among the candidate tasks and the robots, at every decision."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from mrta_zoo.policies.capam.candidates import (
    MISSION_COLUMNS,
    PAIR_COLUMNS,
    ROBOT_COLUMNS,
    TASK_COLUMNS,
    Candidates,
)


class CandidateDecoder(nn.Module):
    """Scores the candidates by letting them, the acting robot and its nearest peers attend to each other.

    Ours, not the paper's. Attention weights are biased, head by head, by how each task would follow another one, or
    what a robot is at (`Candidates.pairs`), in the manner of the edge biases of Graphormer (Ying et al. 2021). To each
    score comes −β · (travel + work), β learned, so that training starts near the nearest-task heuristic and not from
    noise.

    Args:
        embedding: h, length of embeddings.
        heads: number of attention heads.
        layers: number of layers; with 0 each task is scored by itself.
        beta: β at the start, a score a crossing.
    """

    def __init__(self, embedding: int, heads: int, layers: int, beta: float = 30.0) -> None:
        super().__init__()
        self.task = nn.Linear(len(TASK_COLUMNS), embedding)
        self.encoded = nn.Linear(embedding, embedding, bias=False)
        self.robot = nn.Linear(len(ROBOT_COLUMNS), embedding)
        self.mission = nn.Linear(len(MISSION_COLUMNS), embedding)
        self.layers = nn.ModuleList(_Layer(embedding, heads) for _ in range(layers))
        self.norm = nn.LayerNorm(embedding)
        last = nn.Linear(embedding, 1)
        nn.init.zeros_(last.weight)
        nn.init.zeros_(last.bias)
        self.score = nn.Sequential(nn.Linear(embedding, embedding), nn.GELU(), last)
        self.log_beta = nn.Parameter(torch.tensor(beta).log())

    def forward(self, embeddings: Tensor, candidates: Candidates) -> Tensor:
        """Score every candidate.

        Args:
            embeddings: (S, N, h) of the tasks, from the encoder and then `encoded`.
            candidates: of G decisions in each scenario.

        Returns:
            (S, G, K) scores, −inf where there is no candidate.
        """
        s, g, k = candidates.index.shape
        at = candidates.index.reshape(s, g * k, 1).expand(-1, -1, embeddings.shape[-1])
        known = embeddings.gather(1, at).view(s, g, k, embeddings.shape[-1])
        mission = self.mission(candidates.mission)[:, :, None]
        task = self.task(candidates.task) + known + mission
        robot = self.robot(candidates.robot) + mission
        hidden = torch.cat((robot, task), 2).flatten(0, 1)
        valid = torch.cat((candidates.robot_valid, candidates.valid), -1).flatten(0, 1)
        if self.layers:
            pairs = candidates.pairs().flatten(0, 1)
            for layer in self.layers:
                hidden = layer(hidden, pairs, valid)
        out = self.score(self.norm(hidden[:, -k:])).view(s, g, k).float()
        duration = candidates.task[..., TASK_COLUMNS.index("travel")] + candidates.task[..., TASK_COLUMNS.index("work")]
        scores: Tensor = (out - self.log_beta.exp() * duration).masked_fill(~candidates.valid, -torch.inf)
        return scores


class _Layer(nn.Module):
    """Attention with edge biases and a feed-forward block, both normalised first and with skip connections."""

    def __init__(self, embedding: int, heads: int) -> None:
        super().__init__()
        self.heads = heads
        self.norms = nn.ModuleList(nn.LayerNorm(embedding) for _ in range(2))
        self.qkv = nn.Linear(embedding, 3 * embedding, bias=False)
        self.out = nn.Linear(embedding, embedding, bias=False)
        self.to_task = nn.Linear(PAIR_COLUMNS, heads)
        self.to_robot = nn.Linear(PAIR_COLUMNS, heads)
        self.feed_forward = nn.Sequential(
            nn.Linear(embedding, 2 * embedding), nn.GELU(), nn.Linear(2 * embedding, embedding)
        )

    def forward(self, hidden: Tensor, pairs: Tensor, valid: Tensor) -> Tensor:
        """(B, R + K, h) to the same; pairs (B, R + K, K, PAIR_COLUMNS), valid (B, R + K) bool."""
        normed = self.norms[0](hidden)
        query, key, value = self.qkv(normed).unflatten(-1, (3, self.heads, -1)).permute(2, 0, 3, 1, 4)
        robots = hidden.shape[1] - pairs.shape[2]
        to_task = self.to_task(pairs).permute(0, 3, 1, 2)
        back = self.to_robot(pairs[:, :robots]).permute(0, 3, 2, 1)
        to_robot = torch.cat((back.new_zeros(*back.shape[:2], robots, robots), back), 2)
        bias = torch.cat((to_robot, to_task), 3).masked_fill(~valid[:, None, None], -1e4).to(query.dtype)
        mixed = nn.functional.scaled_dot_product_attention(query, key, value, attn_mask=bias)
        hidden = hidden + self.out(mixed.transpose(1, 2).flatten(2))
        out: Tensor = hidden + self.feed_forward(self.norms[1](hidden))
        return out
