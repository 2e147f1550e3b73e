"""Policy gradients: of the log-probabilities of decisions already taken, weighted by their missions' outcomes."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor

from mrta_zoo.policies.neural.capam.inputs import Tasks
from mrta_zoo.policies.neural.rollout import Scorer, Segment
from mrta_zoo.policies.neural.tensor_tree import select, tree_map
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.precision import Precision, autocast


def accumulate_gradients(
    network: Scorer,
    scenarios: ScenarioBatch,
    segments: Sequence[Segment],
    advantage: Tensor,
    entropy: float = 0.0,
    precision: Precision = "float32",
) -> float:
    """Accumulate the gradient of the mean over missions of advantage · Σ log-probability.

    The encoder runs once; the decoder's backward pass takes one segment at a time, so that memory holds only one.

    Args:
        network: the policy.
        scenarios: the S scenarios.
        segments: decisions on them.
        advantage: (S, G) how much worse than expected each mission turned out.
        entropy: weight of the entropy bonus.
        precision: of matrix products.

    Returns:
        That mean.
    """
    with autocast(scenarios.device, precision):
        encoding = network.encode(Tasks.of_batch(scenarios))
    leaves: list[tuple[Tensor, Tensor]] = []

    def leaf(tensor: Tensor) -> Tensor:  # where the graph is cut, to hold the gradient that flows back to the encoder
        if not tensor.requires_grad:
            return tensor
        leaves.append((tensor, tensor.detach().requires_grad_()))
        return leaves[-1][1]

    cut = tree_map(leaf, encoding)
    total = torch.zeros((), device=scenarios.device)
    for segment in segments:
        with autocast(scenarios.device, precision):
            log_probs = network(select(cut, segment.scenarios), segment.states, segment.features)
        loss = _surrogate(log_probs, segment, advantage, entropy)
        loss = loss / advantage.numel()
        loss.backward()
        total += loss.detach()
    # None where a network took no decision, as for robots that no scenario has; or if none took any.
    used = [(of, cut_off.grad) for of, cut_off in leaves if cut_off.grad is not None]
    torch.autograd.backward([of for of, _ in used], [gradient for _, gradient in used])
    return float(total)


def _surrogate(log_probs: Tensor, segment: Segment, advantage: Tensor, entropy: float) -> Tensor:
    """The sum over a segment's decisions of advantage · log-probability, less the entropy bonus."""
    chosen = log_probs.gather(2, segment.actions[..., None]).squeeze(2)
    weight = advantage[segment.scenarios][:, segment.sample]
    # A plan may take a task that is not a candidate: there is nothing to learn from that.
    live = segment.live & torch.isfinite(chosen)
    loss: Tensor = (weight * chosen.masked_fill(~live, 0.0)).sum()
    if entropy:
        negative = (log_probs.exp() * log_probs.masked_fill(torch.isinf(log_probs), 0.0)).sum(-1)
        loss = loss + entropy * negative.masked_fill(~live, 0.0).sum()
    return loss
