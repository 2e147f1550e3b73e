"""Edge biases of the candidate decoder entry by entry, and its layer norm's precision."""

from __future__ import annotations

import numpy as np
import torch
from torch import nn

from mrta_zoo.batch import BatchMission
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.policies.neural.capam.candidate_decoder import CandidateDecoder, _Norm
from mrta_zoo.policies.neural.capam.candidates import Candidates
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.capam.neighbourhood import Neighbourhood
from mrta_zoo.scenario_batch import ScenarioBatch

HEADS, LAYERS = 2, 3
BLOCKED = -1e4


def candidates() -> Candidates:
    """Of two first decisions, with 3 and 2 robots and 6 candidates, the third robot of the latter padding."""
    rng = np.random.default_rng(0)
    cases = [TaptcGenerator(tasks=(8, 8), robots=(m, m))(rng) for m in (3, 2)]
    mission = BatchMission(ScenarioBatch.of(cases))
    tasks = Tasks.of_batch(mission.scenarios)
    return Candidates.of(tasks, Neighbourhood.of(tasks), DecisionStates.of_batch(mission), 6, 2)


def row(linear: nn.Linear, columns: torch.Tensor, output: int) -> float:
    return float(linear.weight[output] @ columns + linear.bias[output])


@torch.no_grad()
def test_biases_entry_by_entry() -> None:
    torch.manual_seed(0)
    decoder = CandidateDecoder(embedding=8, heads=HEADS, layers=LAYERS)
    given = candidates()
    pairs = given.pairs().flatten(0, 1)
    valid = torch.cat((given.robot_valid, given.valid), -1).flatten(0, 1)
    assert not valid.all()
    robots, tasks = 3, 6
    biases = decoder._biases(pairs, valid)
    assert biases.shape == (2, LAYERS * HEADS, robots + tasks, robots + tasks)
    for b in range(2):
        for output in range(LAYERS * HEADS):
            for query in range(robots + tasks):
                for key in range(robots + tasks):
                    if not valid[b, key]:
                        wanted = BLOCKED
                    elif key >= robots:  # how the task `key` would follow what `query` is at
                        wanted = row(decoder.to_task, pairs[b, :, query, key - robots], output)
                    elif query >= robots:  # how the task `query` would follow what the robot `key` is at
                        wanted = row(decoder.to_robot, pairs[b, :, key, query - robots], output)
                    else:
                        wanted = 0.0
                    torch.testing.assert_close(float(biases[b, output, query, key]), wanted, rtol=1e-5, atol=1e-5)


@torch.no_grad()
def test_each_layer_takes_its_own_biases() -> None:
    torch.manual_seed(0)
    decoder = CandidateDecoder(embedding=8, heads=HEADS, layers=LAYERS)
    nn.init.normal_(decoder.score[-1].weight)
    given, embeddings = candidates(), torch.randn(2, 8, 8)
    seen: list[torch.Tensor] = []
    for layer in decoder.layers:
        layer.register_forward_pre_hook(lambda _, arguments: seen.append(arguments[1]))
    decoder(embeddings, given)
    pairs = given.pairs().flatten(0, 1)
    valid = torch.cat((given.robot_valid, given.valid), -1).flatten(0, 1)
    torch.testing.assert_close(torch.cat(seen, 1), decoder._biases(pairs, valid))


@torch.no_grad()
def test_norm_keeps_the_precision_it_is_given() -> None:
    norm, values = _Norm(16), torch.randn(5, 16, generator=torch.Generator().manual_seed(0))
    assert torch.equal(norm(values), nn.functional.layer_norm(values, (16,), norm.weight, norm.bias))
    half = norm(values.bfloat16())
    assert half.dtype == torch.bfloat16
    torch.testing.assert_close(half.float(), norm(values), rtol=0.02, atol=0.02)
    with torch.autocast("cpu", dtype=torch.bfloat16):
        assert torch.equal(norm(values.bfloat16()), half)
