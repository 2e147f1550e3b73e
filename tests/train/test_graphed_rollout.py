"""Rollouts by graphs: on the CPU with a stand-in that runs the recorded function, on a GPU the real thing."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import pytest
import torch
from factories import hopeless_scenario, small_scenario

from mrta_zoo.batch import BatchMission, ScenarioBatch
from mrta_zoo.errors import ConfigError
from mrta_zoo.mission import Mission
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.inputs import Tasks
from mrta_zoo.policies.neural.rollout import Segment, roll_out
from mrta_zoo.policies.neural.sharing import Network, build_network
from mrta_zoo.policies.neural.temperature import tempered
from mrta_zoo.scenario import Scenario
from mrta_zoo.train import graphed_rollout
from mrta_zoo.train.cuda_graph import tensors
from mrta_zoo.train.gradients import accumulate_gradients
from mrta_zoo.train.graphed_rollout import GraphedRollout
from mrta_zoo.train.imitation.decisions import PlanBatch, follow
from mrta_zoo.train.imitation.experts import ExpertPlan

ATTENTION = NetworkConfig(embedding=16, heads=2)
CANDIDATES = replace(ATTENTION, decoder="candidates", decision_layers=1, candidates=8, peers=2)
CPU = torch.device("cpu")
SAMPLES = 3


class Eager:
    """What `Graph` does, without recording: the function's tensors are overwritten by its next run."""

    made = 0

    def __init__(self, function: Callable[[Any], Any], state: Any, generator: torch.Generator | None = None) -> None:
        type(self).made += 1
        self._function, self.state = function, copy.deepcopy(state)
        self._out: tuple[torch.Tensor, ...] = ()

    def load(self, state: Any) -> None:
        shapes = [each.shape for each in tensors(self.state)]
        assert shapes == [each.shape for each in tensors(state)], "a graph serves one size"
        self.state = copy.deepcopy(state)

    def run(self) -> Any:
        for each in self._out:  # what the last run returned is lost
            each.zero_()
        out = self._function(self.state)
        own = {id(each) for each in tensors(self.state)}
        self._out = tuple(each for each in tensors(out) if id(each) not in own)
        return out


@pytest.fixture(autouse=True)
def _no_graphs(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if "gpu" not in request.node.name:
        monkeypatch.setattr(graphed_rollout, "Graph", Eager)


def easy(tasks: int, seed: int) -> Scenario:
    """One robot that has time for every task, so that all missions have as many decisions."""
    rng = np.random.default_rng(seed)
    return Scenario(rng.uniform(0, 100, (tasks, 2)), np.full(tasks, 1e5), rng.uniform(1, 9, tasks), [[50, 50]], [1])  # type: ignore[arg-type]


def graphed(
    network: Network, device: torch.device = CPU, samples: int = SAMPLES, temperature: float = 1.0
) -> GraphedRollout:
    return GraphedRollout(network, samples, "feasible", "float32", device, temperature)


def decisions(segments: list[Segment]) -> dict[tuple[int, int], list[tuple[float, int, int]]]:
    """Of each scenario and sample: when, by whom, and what, in order."""
    found: dict[tuple[int, int], list[tuple[float, int, int]]] = {}
    for segment in segments:
        for row, q in segment.live.nonzero().tolist():
            key = (int(segment.scenarios[row]), int(segment.sample[q]))
            moment = (
                float(segment.moments.elapsed[row, q]),
                int(segment.moments.ego[row, q]),
                int(segment.actions[row, q]),
            )
            found.setdefault(key, []).append(moment)
    return found


@pytest.mark.parametrize("temperature", [1.0, 0.3])
@pytest.mark.parametrize("config", [ATTENTION, CANDIDATES], ids=["attention", "candidates"])
def test_sampled_missions_are_those_of_roll_out(config: NetworkConfig, temperature: float) -> None:
    network = build_network(config, "shared", 1, seed=0)
    policy, rollouts = tempered(network, temperature), graphed(network, temperature=temperature)
    # Missions of one scenario, or of as many decisions in each: none is dropped on the way, so the draws are the same.
    for scenarios in (
        [small_scenario(3, tasks=20, latest=300.0)],
        [easy(20, seed) for seed in range(4)],
        [easy(20, 9)],
    ):
        batch = ScenarioBatch.of(scenarios, max_robots=3)
        sampling = torch.Generator().manual_seed(5)
        wanted = roll_out(policy, batch, samples=SAMPLES, generator=sampling, keep_segments=True)
        got = rollouts.sample(batch, seed=5)
        assert torch.equal(got.cost, wanted.cost)
        assert torch.equal(got.completed, wanted.completed)
        torch.testing.assert_close(got.log_prob, wanted.log_prob)
        assert decisions(got.segments) == decisions(wanted.segments)
        assert len(got.segments) > 1

        advantage = torch.randn(len(scenarios), SAMPLES, generator=sampling)
        gradients = []
        for rollout in (wanted, got):
            network.zero_grad(set_to_none=True)
            accumulate_gradients(network, batch, rollout.segments, advantage, entropy=0.1)
            gradients.append([p.grad for p in network.parameters() if p.grad is not None])
        torch.testing.assert_close(*gradients, rtol=1e-3, atol=1e-5)


def test_there_is_one_graph_for_each_size() -> None:
    network, before = build_network(CANDIDATES, "shared", 1, seed=0), Eager.made
    rollouts = graphed(network)
    for tasks, seed in ((10, 0), (10, 1), (14, 0), (10, 2)):
        rollouts.sample(ScenarioBatch.of([easy(tasks, seed)]), seed)
    assert Eager.made - before == 2


def test_where_nothing_can_be_done_nothing_is_learnt() -> None:
    network = build_network(CANDIDATES, "shared", 1, seed=0)
    batch = ScenarioBatch.of([hopeless_scenario()])
    rollout = graphed(network).sample(batch, seed=0)
    assert decisions(rollout.segments) == {}
    assert rollout.completed.tolist() == [0] * SAMPLES
    assert rollout.log_prob.tolist() == [0] * SAMPLES
    assert accumulate_gradients(network, batch, rollout.segments, torch.ones(1, SAMPLES)) == 0


def test_spoilt_weights_are_told() -> None:
    network = build_network(ATTENTION, "shared", 1, seed=0)
    with torch.no_grad():
        next(network.parameters()).fill_(torch.nan)
    with pytest.raises(ConfigError, match="probabilities that are not finite"):
        graphed(network).sample(ScenarioBatch.of([easy(10, 0)]), seed=0)


def plan_of(scenario: Scenario) -> ExpertPlan:
    mission = Mission(scenario)
    while not mission.done:
        mission.assign(int(mission.mask(mission.actor).argmax()))
    return ExpertPlan(scenario, tuple(map(tuple, mission.routes)))


def check_same(got: list[Segment], wanted: list[Segment]) -> None:
    """The live decisions are the same, and so is what is known of them."""
    assert decisions(got) == decisions(wanted) != {}
    for one, other in zip(got, wanted, strict=True):
        other = other.lively()
        assert one.scenarios.tolist() == other.scenarios.tolist()
        assert torch.equal(one.live, other.live)
        for name in ("moments", "features"):
            if getattr(other, name) is not None:
                for each in fields(getattr(other, name)):
                    own = getattr(getattr(one, name), each.name)[one.live]
                    torch.testing.assert_close(own, getattr(getattr(other, name), each.name)[other.live])


@pytest.mark.parametrize("config", [ATTENTION, CANDIDATES], ids=["attention", "candidates"])
def test_followed_plans_are_those_of_follow(config: NetworkConfig) -> None:
    network = build_network(config, "shared", 1, seed=0)
    rollouts = graphed(network)
    for seed in range(2):
        # Of 20 tasks some missions have time for few, others for most.
        cases = [small_scenario(10 * seed + k, tasks=20, latest=40.0 + 100 * k) for k in range(4)]
        plans = PlanBatch([plan_of(case) for case in cases], CPU)
        wanted = follow(network, plans.scenarios, plans.routes)
        check_same(rollouts.follow(plans.scenarios, plans.routes), wanted)
        assert len(wanted) > 1


@dataclass(frozen=True)
class _Pair:
    later: torch.Tensor
    earlier: Any
    nothing: None = None


class _Thing:
    def __init__(self) -> None:
        self.zebra, self.ape = torch.tensor(1), [torch.tensor(2), (torch.tensor(3),)]
        self.number, self.name, self.network = 4, "five", torch.nn.Linear(1, 1)


def test_tensors_are_found_in_one_order() -> None:
    tree = (_Pair(torch.tensor(9), _Thing()), [torch.tensor(7)], None, "text")
    # Fields of dataclasses as written, attributes of objects by name (ape before zebra); modules are left out.
    assert [int(each) for each in tensors(tree)] == [9, 2, 3, 1, 7]


def test_every_tensor_of_a_mission_is_found() -> None:
    mission = BatchMission(ScenarioBatch.of([small_scenario(), easy(5, 0)]))
    found = {id(each) for each in tensors(mission)}
    own = [value for value in vars(mission).values() if isinstance(value, torch.Tensor)]
    of_scenarios = [
        getattr(mission.scenarios, each.name) for each in fields(mission.scenarios) if each.name != "scales"
    ]
    of_scenarios += [getattr(mission.scenarios.scales, each.name) for each in fields(mission.scenarios.scales)]
    assert {id(each) for each in [*own, *of_scenarios]} == found
    assert len(found) == len(own) + len(of_scenarios)
    others = {name for name, value in vars(mission).items() if not isinstance(value, torch.Tensor)}
    assert others == {"scenarios", "mask_rule", "_decisions"}, "what is new here must be found by `tensors`, too"

    mission.step(torch.tensor([0, 0]))  # puts new tensors in place of old ones
    copied = copy.deepcopy(mission)
    assert all(torch.equal(*pair) for pair in zip(tensors(mission), tensors(copied), strict=True))
    assert not {id(each) for each in tensors(mission)} & {id(each) for each in tensors(copied)}


@pytest.mark.parametrize("config", [ATTENTION, CANDIDATES], ids=["attention", "candidates"])
def test_every_tensor_of_an_encoding_is_found(config: NetworkConfig) -> None:
    with torch.no_grad():
        encoding = build_network(config, "shared", 1, 0).encode(Tasks.of_batch(ScenarioBatch.of([easy(5, 0)])))
    # Tasks have 6; the attention decoder 3 keys; the candidate decoder embeddings and 2 of the neighbourhood.
    assert len(list(tensors(encoding))) == 9


@pytest.mark.skipif(not torch.cuda.is_available(), reason="needs a GPU")
@pytest.mark.parametrize("config", [ATTENTION, CANDIDATES], ids=["attention", "candidates"])
def test_graphs_on_a_gpu(config: NetworkConfig) -> None:
    device = torch.device("cuda")
    network = build_network(config, "shared", 1, seed=0).to(device)
    rollouts = graphed(network, device)
    for seed in range(2):
        cases = [small_scenario(10 * seed + k, tasks=20, latest=40.0 + 100 * k) for k in range(4)]
        plans = PlanBatch([plan_of(case) for case in cases], device)
        check_same(rollouts.follow(plans.scenarios, plans.routes), follow(network, plans.scenarios, plans.routes))
        batch = ScenarioBatch.of(cases, device)
        got = rollouts.sample(batch, seed)
        again = rollouts.sample(batch, seed)
        assert decisions(got.segments) == decisions(again.segments)
        # The same decisions have the same log-probabilities without graphs.
        encoding = network.encode(Tasks.of_batch(batch))
        total = torch.zeros(len(cases), SAMPLES, device=device)
        for segment in got.segments:
            log_probs = network(encoding.select(segment.scenarios), segment.moments)  # type: ignore[arg-type]
            chosen = log_probs.gather(2, segment.actions[..., None]).squeeze(2).masked_fill(~segment.live, 0.0)
            total[segment.scenarios] += chosen.unflatten(1, (-1, SAMPLES)).sum(1).detach()
        torch.testing.assert_close(got.log_prob, total.flatten(), rtol=1e-3, atol=1e-3)
