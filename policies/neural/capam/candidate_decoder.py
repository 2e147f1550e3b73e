"""The decoder of CapAM+: layers of attention among the candidate tasks and the robots, at every decision."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from mrta_zoo.policies.neural.capam.candidates import (
    MISSION_COLUMNS,
    PAIR_COLUMNS,
    TASK_COLUMNS,
    Candidates,
)
from mrta_zoo.policies.neural.capam.robots import ROBOT_COLUMNS


class CandidateDecoder(nn.Module):
    """Scores the candidates by letting them, the acting robot and its nearest peers attend to each other.

    Ours, not the paper's. Attention weights are biased, head by head, by how each task would follow another one, or
    what a robot is doing (`Candidates.pairs`), in the manner of the edge biases of Graphormer (Ying et al. 2021). Each
    score includes −β · (travel + work), β learned, so that training starts near the nearest-task heuristic and not from
    noise.

    Args:
        embedding: h, length of embeddings.
        heads: number of attention heads.
        layers: number of layers; with 0 each task is scored by itself.
        beta: β at the start, in units of score per crossing.
    """

    def __init__(self, embedding: int, heads: int, layers: int, beta: float = 30.0) -> None:
        super().__init__()
        self.task = nn.Linear(len(TASK_COLUMNS), embedding)
        self.encoded = nn.Linear(embedding, embedding, bias=False)
        self.robot = nn.Linear(len(ROBOT_COLUMNS), embedding)
        self.mission = nn.Linear(len(MISSION_COLUMNS), embedding)
        # For all layers and heads at once: with so few columns, reading costs more than computing.
        if layers:
            self.to_task = nn.Linear(PAIR_COLUMNS, layers * heads)
            self.to_robot = nn.Linear(PAIR_COLUMNS, layers * heads)
        self.layers = nn.ModuleList(_Layer(embedding, heads) for _ in range(layers))
        self.norm = _Norm(embedding)
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
            biases = self._biases(candidates.pairs().flatten(0, 1), valid).chunk(len(self.layers), 1)
            for layer, bias in zip(self.layers, biases, strict=True):
                hidden = layer(hidden, bias)
        out = self.score(self.norm(hidden[:, -k:])).view(s, g, k).float()
        duration = candidates.task[..., TASK_COLUMNS.index("travel")] + candidates.task[..., TASK_COLUMNS.index("work")]
        scores: Tensor = (out - self.log_beta.exp() * duration).masked_fill(~candidates.valid, -torch.inf)
        return scores

    def _biases(self, pairs: Tensor, valid: Tensor) -> Tensor:
        """(B, layers · heads, R + K, R + K) from pairs (B, PAIR_COLUMNS, R + K, K) and valid (B, R + K) bool."""
        robots = pairs.shape[-2] - pairs.shape[-1]
        to_task = _map_columns(self.to_task, pairs)
        back = _map_columns(self.to_robot, pairs[..., :robots, :]).transpose(-1, -2)
        to_robot = torch.cat((back.new_zeros(*back.shape[:2], robots, robots), back), 2)
        return torch.cat((to_robot, to_task), 3).masked_fill(~valid[:, None, None], -1e4)


def _map_columns(linear: nn.Linear, columns: Tensor) -> Tensor:
    """A linear map of the columns, (B, C, …) to (B, C', …), without moving any dimension."""
    out: Tensor = (linear.weight @ columns.flatten(2) + linear.bias[:, None]).unflatten(2, columns.shape[2:])
    return out


class _Norm(nn.LayerNorm):
    """Normalises in the precision of its input; autocast would use float32, which takes longer on a GPU."""

    def forward(self, input: Tensor) -> Tensor:
        if input.dtype == self.weight.dtype:
            return super().forward(input)
        weight, bias = self.weight.to(input.dtype), self.bias.to(input.dtype)
        with torch.autocast(input.device.type, enabled=False):
            return nn.functional.layer_norm(input, self.normalized_shape, weight, bias, self.eps)


class _Layer(nn.Module):
    """Attention with edge biases and a feed-forward block, both normalised first and with skip connections."""

    def __init__(self, embedding: int, heads: int) -> None:
        super().__init__()
        self.heads = heads
        self.norms = nn.ModuleList(_Norm(embedding) for _ in range(2))
        self.qkv = nn.Linear(embedding, 3 * embedding, bias=False)
        self.out = nn.Linear(embedding, embedding, bias=False)
        self.feed_forward = nn.Sequential(
            nn.Linear(embedding, 2 * embedding), nn.GELU(), nn.Linear(2 * embedding, embedding)
        )

    def forward(self, hidden: Tensor, bias: Tensor) -> Tensor:
        """(B, R + K, h) to the same; bias (B, heads, R + K, R + K), added to the attention logits."""
        normed = self.norms[0](hidden)
        query, key, value = self.qkv(normed).unflatten(-1, (3, self.heads, -1)).permute(2, 0, 3, 1, 4)
        mixed = nn.functional.scaled_dot_product_attention(query, key, value, attn_mask=bias.to(query.dtype))
        hidden = hidden + self.out(mixed.transpose(1, 2).flatten(2))
        out: Tensor = hidden + self.feed_forward(self.norms[1](hidden))
        return out
