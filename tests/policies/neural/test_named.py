"""Features and encoders of users' own: registered by name, found by configurations and by saved policies."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from torch import Tensor, nn

from mrta_zoo.batch import BatchMission
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.context import CONTEXT_FEATURES
from mrta_zoo.policies.neural.capam.encoders import ENCODERS
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.capam.linear_encoder import LinearEncoder
from mrta_zoo.policies.neural.capam.node_features import NODE_FEATURES
from mrta_zoo.policies.neural.policy import load_policy
from mrta_zoo.policies.neural.sharing import build_network
from mrta_zoo.policies.neural.weights import PolicyInfo, save_policy
from mrta_zoo.scenario_batch import ScenarioBatch

OWN = NetworkConfig(
    encoder="mine", embedding=16, heads=2, node_features=("x", "y", "zero"), context_features=("choices",)
)


@pytest.fixture
def registered() -> Iterator[None]:
    NODE_FEATURES.register("zero")(lambda tasks: tasks.deadline * 0)
    CONTEXT_FEATURES.register("choices")(lambda tasks, states: states.mask.sum(-1) / 10.0)

    @ENCODERS.register("mine")
    class Mine(LinearEncoder):
        def __init__(self, features: int, config: NetworkConfig) -> None:
            super().__init__(features, config.embedding)

    yield
    for registry, name in ((NODE_FEATURES, "zero"), (CONTEXT_FEATURES, "choices"), (ENCODERS, "mine")):
        registry.pop(name)  # type: ignore[attr-defined]


@pytest.mark.usefixtures("registered")
def test_what_is_registered_is_used_saved_and_found_again(tmp_path: Path) -> None:
    network = build_network(OWN, "shared", 1, seed=0)
    scenario = TaptcGenerator(tasks=(10, 10), robots=(2, 2))(np.random.default_rng(0))
    save_policy(tmp_path / "own.safetensors", network, PolicyInfo(network=OWN))
    routes = load_policy(tmp_path / "own.safetensors").solve(scenario).routes
    CONTEXT_FEATURES.pop("choices")
    with pytest.raises(ConfigError, match=r"context_features has 'choices'; expected none, or one of your own, regist"):
        load_policy(tmp_path / "own.safetensors")
    CONTEXT_FEATURES.register("choices")(lambda tasks, states: states.mask.sum(-1) / 10.0)
    assert load_policy(tmp_path / "own.safetensors").solve(scenario).routes == routes


@pytest.mark.usefixtures("registered")
def test_a_context_feature_changes_the_query() -> None:
    # One more column of weights: the query moves by the feature times its weight, before the ReLU.
    network: Any = build_network(OWN, "shared", 1, seed=0)
    assert network.context.own.weight.shape == (16, 8)
    batch = ScenarioBatch.of([TaptcGenerator(tasks=(10, 10), robots=(2, 2))(np.random.default_rng(0))])
    tasks, states = Tasks.of_batch(batch), DecisionStates.of_batch(BatchMission(batch))
    seen: list[Tensor] = []
    network.context.own.register_forward_hook(lambda module, given, found: seen.append(given[0]))
    network.context(tasks, states)
    assert float(seen[0][0, 0, -1]) == pytest.approx(int(states.mask.sum()) / 10)


def test_names_of_the_packages_own_are_not_for_others() -> None:
    with pytest.raises(ConfigError, match=r"registered for encoder cannot be called 'capsule'; expected a name that"):
        ENCODERS.register("capsule")
    with pytest.raises(ConfigError, match=r"registered for context_features cannot be called ''"):
        CONTEXT_FEATURES.register("")


def test_what_cannot_be_called_is_not_registered() -> None:
    entry: Any = 3.0
    with pytest.raises(ConfigError, match=r"'mine' of node_features is a float; expected a function or class to call"):
        NODE_FEATURES.register("mine")(entry)
    assert "mine" not in NODE_FEATURES


@pytest.mark.usefixtures("registered")
def test_registering_again_replaces() -> None:
    NODE_FEATURES.register("zero")(lambda tasks: tasks.deadline * 0 + 1)
    batch = ScenarioBatch.of([TaptcGenerator(tasks=(3, 3), robots=(2, 2))(np.random.default_rng(0))])
    assert NODE_FEATURES.find("zero")(Tasks.of_batch(batch)).tolist() == [[1, 1, 1]]


@pytest.mark.usefixtures("registered")
@pytest.mark.parametrize(
    ("registry", "name", "entry", "message"),
    [
        (NODE_FEATURES, "zero", lambda tasks: tasks.xy, r"node feature 'zero' gave shape \(1, 10, 2\); expected a t"),
        (NODE_FEATURES, "zero", lambda tasks: 3.0, r"node feature 'zero' gave a float; expected .* of shape \(1, 10\)"),
        (CONTEXT_FEATURES, "choices", lambda tasks, states: states.mask, r"context feature 'choices' gave shape"),
        (ENCODERS, "mine", lambda features, config: LinearEncoder(features, 8), r"encoder 'mine' gave shape"),
        (NODE_FEATURES, "zero", lambda tasks: tasks.deadline.to("meta"), "gave strided of float32 on meta; "),
        (NODE_FEATURES, "zero", lambda tasks: tasks.deadline.to_sparse(), "gave sparse_coo of float32 on cpu"),
        (NODE_FEATURES, "zero", lambda tasks: tasks.deadline + 1j, "gave strided of complex64 on cpu"),
        (ENCODERS, "mine", lambda features, config: None, "encoder 'mine' builds a NoneType; expected a to"),
    ],
)  # fmt: skip
def test_what_gives_another_shape_is_named(registry: Any, name: str, entry: Any, message: str) -> None:
    registry.register(name)(entry)
    with pytest.raises(ConfigError, match=message):
        asked()


@pytest.mark.usefixtures("registered")
def test_an_encoder_may_count_in_other_numbers() -> None:
    class Double(LinearEncoder):
        def forward(self, *given: Tensor) -> Tensor:
            return super().forward(*given).double()

    ENCODERS.register("mine")(lambda features, config: Double(features, config.embedding))
    assert asked().dtype == torch.float32


def asked() -> Tensor:
    """What a network of one's own makes of a mission's first moment."""
    batch = ScenarioBatch.of([TaptcGenerator(tasks=(10, 10), robots=(2, 2))(np.random.default_rng(0))])
    tasks, states = Tasks.of_batch(batch), DecisionStates.of_batch(BatchMission(batch))
    network = build_network(OWN, "shared", 1, seed=0)
    found: Tensor = network(network.encode(tasks), states)
    return found


def test_the_candidate_decoder_has_no_context() -> None:
    with pytest.raises(
        ConfigError, match=r"context_features is \('choices',\); expected none with decoder 'candidates"
    ):
        NetworkConfig(decoder="candidates", context_features=("choices",))


def test_without_features_of_their_own_networks_are_as_before() -> None:
    network: Any = build_network(NetworkConfig(embedding=16, heads=2), "shared", 1, seed=0)
    assert isinstance(network.context.own, nn.Linear)
    assert network.context.own.weight.shape == (16, 7)
    assert torch.isfinite(network.context.own.weight).all()
