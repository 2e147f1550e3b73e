"""The paper's decoder by hand."""

from __future__ import annotations

import math

import pytest
import torch

from mrta_zoo.policies.neural.capam.decoder import AttentionDecoder, Keys

ROOT2 = math.sqrt(2)


def decoder() -> AttentionDecoder:
    """h = 2, one head. The feed-forward layer adds (0, 3 · max(0, first number)); the glimpse goes on as it is."""
    made = AttentionDecoder(embedding=2, heads=1, tanh_clip=10.0)
    into, _, out = made.feed_forward
    with torch.no_grad():
        made.out.weight.copy_(torch.eye(2))
        for layer in (into, out):
            layer.weight.zero_()
            layer.bias.zero_()
        into.weight[0, 0] = 1.0
        out.weight[1, 0] = 3.0
    return made


KEYS = Keys(
    glimpse_key=torch.tensor([[ROOT2 * math.log(3) / 2, 0.0], [0.0, 0.0]]).T[None, None],
    glimpse_value=torch.tensor([[0.0, 4.0], [0.0, -8.0]])[None, None],
    score_key=torch.tensor([[ROOT2, 0.0], [0.0, ROOT2]]).T[None],
)


@pytest.mark.parametrize(
    ("allowed", "scores"),
    [
        # Compatibilities (2, 0) · key / √2 are ln 3 and 0, so weights 3/4 and 1/4, glimpse (0, 3/4 · 4 − 1/4 · 8) =
        # (0, 1). Query + glimpse is (2, 1), normed (1, −1), with the feed-forward layer (1, −1 + 3) = (1, 2).
        ((True, True), (1.0, 2.0)),
        # All the weight is on the first: glimpse (0, 4), (2, 4) normed is (−1, 1), to which nothing is added.
        ((True, False), (-1.0, 1.0)),
    ],
)
def test_scores_by_hand(allowed: tuple[bool, bool], scores: tuple[float, float]) -> None:
    given = decoder()(torch.tensor([[[2.0, 0.0]]]), KEYS, torch.tensor([[allowed]]))
    expected = torch.tensor([[[10 * math.tanh(score) for score in scores]]])
    torch.testing.assert_close(given, expected, rtol=1e-3, atol=1e-3)  # the norm's ε


def test_without_a_choice_scores_are_finite() -> None:
    given = decoder()(torch.tensor([[[2.0, 0.0]]]), KEYS, torch.zeros(1, 1, 2, dtype=torch.bool))
    assert torch.isfinite(given).all()
