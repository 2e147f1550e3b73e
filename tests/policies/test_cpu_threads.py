"""Small networks run on one thread unless the user says otherwise, and the user's setting is put back."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
import torch
from factories import small_scenario
from torch.utils.data import default_collate

from mrta_zoo import mrta_v0
from mrta_zoo.cli.train import train_command
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.policies.cpu_threads import VARIABLES, cpu_threads, few_threads
from mrta_zoo.policies.neural import actor_critic, decoding
from mrta_zoo.policies.neural import policy as neural
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.network import AllocationNetwork
from mrta_zoo.policies.neural.policy import NeuralPolicy
from mrta_zoo.policies.neural.weights import PolicyInfo
from mrta_zoo.train import aec_reinforce, reinforce
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.integrations.networks import GreedyPolicy, build
from mrta_zoo.train.reinforce import Reinforce

SMALL = NetworkConfig(embedding=8, heads=2)


@pytest.fixture(autouse=True)
def three(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Torch uses three threads, as the user has left it."""
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    before = torch.get_num_threads()
    torch.set_num_threads(3)
    yield
    assert torch.get_num_threads() == 3
    torch.set_num_threads(before)


def watched(monkeypatch: pytest.MonkeyPatch, module: Any, name: str) -> list[int]:
    """The number of threads at each call of a function from now on."""
    counts: list[int] = []
    function: Callable[..., Any] = getattr(module, name)

    def call(*arguments: Any, **options: Any) -> Any:
        counts.append(torch.get_num_threads())
        return function(*arguments, **options)

    monkeypatch.setattr(module, name, call)
    return counts


def small_policy() -> NeuralPolicy:
    return NeuralPolicy(AllocationNetwork(SMALL), PolicyInfo(network=SMALL))


def test_they_are_put_back_whatever_happens() -> None:
    with cpu_threads(1):
        assert torch.get_num_threads() == 1
    with pytest.raises(ConfigError, match="threads is 0"), cpu_threads(0):
        pass
    with pytest.raises(KeyboardInterrupt), few_threads():
        raise KeyboardInterrupt


@pytest.mark.parametrize("count", [1, 2])
def test_they_are_put_back_after_several_threads(count: int) -> None:
    """The first to begin ends while the second, which began meanwhile, goes on."""
    begun, over = threading.Event(), threading.Event()
    seen: list[int] = []

    def second() -> None:
        with cpu_threads(1):
            seen.append(torch.get_num_threads())
            begun.set()
            assert over.wait(10)
        seen.append(torch.get_num_threads())

    with cpu_threads(count):
        thread = threading.Thread(target=second)
        thread.start()
        assert begun.wait(10)
        assert torch.get_num_threads() == count
    assert torch.get_num_threads() == 3
    over.set()
    thread.join()
    assert seen == [1, 3]
    later = threading.Thread(target=lambda: seen.append(torch.get_num_threads()))
    later.start()
    later.join()
    assert seen == [1, 3, 3]


def test_nested_blocks_of_a_thread_among_others() -> None:
    seen: list[int] = []

    def other() -> None:
        for count in (1, 2):
            with cpu_threads(count):
                with few_threads():
                    seen.append(torch.get_num_threads())
                seen.append(torch.get_num_threads())

    with cpu_threads(2):
        thread = threading.Thread(target=other)
        thread.start()
        thread.join()
    assert seen == [1, 1, 2, 2]


def test_the_user_may_choose(monkeypatch: pytest.MonkeyPatch) -> None:
    with cpu_threads(2):
        torch.set_num_threads(4)  # as its import may, inside
        with few_threads():
            assert torch.get_num_threads() == 2
    monkeypatch.setenv("OMP_NUM_THREADS", "3")
    with few_threads():
        assert torch.get_num_threads() == 3


def test_a_policy(monkeypatch: pytest.MonkeyPatch) -> None:
    policy, scenario = small_policy(), small_scenario()
    acting = watched(monkeypatch, neural.DecisionStates, "of_observations")
    env = mrta_v0.env(scenario=scenario)
    env.reset(seed=1)
    policy.act(env.last()[0])
    planning = watched(monkeypatch, decoding, "roll_out")
    policy.solve(scenario)
    batch = watched(monkeypatch, neural, "roll_out")
    policy.solve_batch([scenario])
    assert (acting, planning, batch) == ([1], [1], [1])


def test_a_network_that_other_libraries_train(monkeypatch: pytest.MonkeyPatch) -> None:
    module = build("capam", 0, 0, seed=0)
    counts = watched(monkeypatch, actor_critic.DecisionStates, "of_tables")
    values = watched(monkeypatch, module.critic, "forward")
    env = mrta_v0.env(scenario=small_scenario())
    env.reset(seed=1)
    module(default_collate([env.last()[0]]))
    assert (counts, values) == ([1], [1])


def test_a_plain_network_of_the_integrations(monkeypatch: pytest.MonkeyPatch) -> None:
    env = mrta_v0.env(scenario=small_scenario(), observation="masked")
    env.reset(seed=1)
    seen = env.last()[0]
    network = build("mlp", len(seen["observation"]), len(seen["action_mask"]), seed=0)
    counts = watched(monkeypatch, network, "logits")
    GreedyPolicy(network).act(seen, "robot_0")
    assert counts == [1]


def test_training(monkeypatch: pytest.MonkeyPatch) -> None:
    counts = watched(monkeypatch, reinforce, "roll_out")
    config = TrainConfig(
        network=SMALL, scenarios=2, samples=2, updates=2, epoch=1, validation_scenarios=2, imitation_updates=0,
        device="cpu",
    )  # fmt: skip
    run = Reinforce(config, UniformGenerator(tasks=(3, 3), robots=(1, 1)))
    for _ in run.run():
        assert torch.get_num_threads() == 3  # what the user's loop does is the user's
    assert set(counts) == {1}


def test_the_example_trainer(monkeypatch: pytest.MonkeyPatch) -> None:
    counts = watched(monkeypatch, aec_reinforce, "play")
    env = mrta_v0.env(generator=UniformGenerator(tasks=(3, 3), robots=(1, 1)), reward="completion")
    network = AllocationNetwork(SMALL)
    for _ in aec_reinforce.train(env, network, updates=1, scenarios=1, samples=2):
        assert torch.get_num_threads() == 3
    aec_reinforce.evaluate(env, network, 1)
    assert counts == [1, 1, 1]


@pytest.mark.parametrize(("flags", "expected"), [([], 1), (["--threads", "2"], 2), (["--threads", "0"], 3)])
def test_the_command_train(flags: list[str], expected: int, monkeypatch: pytest.MonkeyPatch) -> None:
    counts: list[int] = []

    def run(_: object) -> None:
        with few_threads():
            counts.append(torch.get_num_threads())

    monkeypatch.setattr("mrta_zoo.cli.train._run", run)
    train_command(["--out", "unused", *flags])
    assert counts == [expected]
