"""Gradients of the log-probabilities of decisions already taken, weighted by how their missions turned out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, is_dataclass
from typing import Any

import torch
from torch import Tensor

from mrta_zoo.batch import ScenarioBatch
from mrta_zoo.policies.neural.capam.inputs import Tasks
from mrta_zoo.policies.neural.rollout import Scorer, Segment
from mrta_zoo.train.precision import Precision, autocast


def accumulate_gradients(
    network: Scorer,
    scenarios: ScenarioBatch,
    segments: Sequence[Segment],
    advantage: Tensor,
    entropy: float = 0.0,
    precision: Precision = "float32",
) -> float:
    """Add to the parameters' gradients that of the mean over missions of advantage · Σ log-probability.

    The encoder runs once; the decoder goes back through one segment after another, so that memory holds one of them.

    Args:
        network: the policy.
        scenarios: the S scenarios.
        segments: decisions on them.
        advantage: (S, G) how much worse than expected each mission turned out.
        entropy: weight of the entropy bonus.
        precision: of matrix products.

    Returns:
        The mean whose gradient it is.
    """
    with autocast(scenarios.device, precision):
        encoding = network.encode(Tasks.of_batch(scenarios))
    leaves: list[tuple[Tensor, Tensor]] = []
    cut = _cut(encoding, leaves)
    total = torch.zeros((), device=scenarios.device)
    for segment in segments:
        with autocast(scenarios.device, precision):
            log_probs = network(cut.select(segment.scenarios), segment.moments, segment.features)
        chosen = log_probs.gather(2, segment.actions[..., None]).squeeze(2)
        weight = advantage[segment.scenarios][:, segment.sample]
        # Where a plan takes a task that is no candidate there is nothing to learn.
        live = segment.live & torch.isfinite(chosen)
        loss = (weight * chosen.masked_fill(~live, 0.0)).sum()
        if entropy:
            negative = (log_probs.exp() * log_probs.masked_fill(torch.isinf(log_probs), 0.0)).sum(-1)
            loss = loss + entropy * negative.masked_fill(~live, 0.0).sum()
        loss = loss / advantage.numel()
        loss.backward()
        total += loss.detach()
    # None where nothing was decided by it: by the networks of robots that no scenario has, or by any.
    used = [(of, leaf.grad) for of, leaf in leaves if leaf.grad is not None]
    torch.autograd.backward([of for of, _ in used], [gradient for _, gradient in used])
    return float(total)


def _cut(encoding: Any, leaves: list[tuple[Tensor, Tensor]]) -> Any:
    """The same encoding with leaves in place of the tensors that gradients flow to, which are noted beside them."""
    if isinstance(encoding, Tensor):
        if not encoding.requires_grad:
            return encoding
        leaves.append((encoding, encoding.detach().requires_grad_()))
        return leaves[-1][1]
    if isinstance(encoding, tuple):
        return tuple(_cut(each, leaves) for each in encoding)
    if is_dataclass(encoding) and not isinstance(encoding, type):
        return type(encoding)(*(_cut(getattr(encoding, field.name), leaves) for field in fields(encoding)))
    return encoding
