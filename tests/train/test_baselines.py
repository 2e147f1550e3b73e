"""Baselines, by hand."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import numpy as np
import pytest
import torch

from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.rollout import roll_out
from mrta_zoo.policies.neural.sharing import build_network
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train import checkpoint
from mrta_zoo.train.baselines import BASELINES, ExponentialBaseline, RolloutBaseline, SamplesBaseline
from mrta_zoo.train.config import BaselineName, TrainConfig
from mrta_zoo.train.objective import missed_share


def scenarios(count: int) -> ScenarioBatch:
    rng = np.random.default_rng(0)
    generator = UniformGenerator(tasks=8, robots=2, deadline=(30, 120))  # type: ignore[arg-type]
    return ScenarioBatch.of([generator(rng) for _ in range(count)])


def test_every_baseline_has_its_row() -> None:
    assert set(BASELINES) == set(get_args(BaselineName))


def test_samples_baseline_compares_with_the_other_samples() -> None:
    # Others of the first: (2 + 6)/2 = 4, so 1 − 4 = −3; second: 2 − (1 + 6)/2 = −1.5; third: 6 − (1 + 2)/2 = 4.5.
    loss = torch.tensor([[1.0, 2.0, 6.0]])
    torch.testing.assert_close(SamplesBaseline().advantage(scenarios(1), loss), torch.tensor([[-3.0, -1.5, 4.5]]))


def test_rollout_baseline_compares_with_its_own_greedy_missions() -> None:
    network, batch = build_network(NetworkConfig(embedding=32), "shared", 2, seed=0), scenarios(3)
    baseline = RolloutBaseline(network, missed_share, "feasible", 0.05)
    greedy = missed_share(roll_out(network, batch), batch)
    loss = torch.rand(3, 2, dtype=torch.float64)
    torch.testing.assert_close(baseline.advantage(batch, loss), loss - greedy[:, None])


@pytest.mark.parametrize(
    ("gain", "replaced"),
    [
        (0.1, True),  # better everywhere by about as much: significant
        (0.0, False),  # equal
        (-0.1, False),  # worse
    ],
)
def test_rollout_baseline_is_replaced_only_by_a_significantly_better_policy(gain: float, replaced: bool) -> None:
    batch = scenarios(16)
    old, new = (build_network(NetworkConfig(embedding=32), "shared", 2, seed=seed) for seed in (0, 1))
    baseline = RolloutBaseline(old, missed_share, "feasible", 0.05)
    noise = torch.linspace(-0.01, 0.01, 16, dtype=torch.float64)
    loss = missed_share(roll_out(old, batch), batch) - gain + (noise if gain else 0)
    assert baseline.end_epoch(new, batch, loss) is replaced
    wanted = new if replaced else old
    for name, value in baseline.network.state_dict().items():
        assert torch.equal(value, wanted.state_dict()[name])


def test_rollout_baseline_is_not_replaced_by_luck() -> None:
    # One of 16 scenarios much better, the others a little worse: the mean is better, p is about 0.2.
    batch = scenarios(16)
    network = build_network(NetworkConfig(embedding=32), "shared", 2, seed=0)
    loss = missed_share(roll_out(network, batch), batch) + 0.001
    loss[0] -= 0.5
    assert not RolloutBaseline(network, missed_share, "feasible", 0.05).end_epoch(network, batch, loss)


def test_exponential_baseline_is_a_moving_average() -> None:
    baseline, batch = ExponentialBaseline(0.75), scenarios(2)
    assert baseline.state() == {}
    # The first batch's mean, (1 + 2 + 3 + 6) / 4 = 3, to begin with.
    first = baseline.advantage(batch, torch.tensor([[1.0, 2.0], [3.0, 6.0]], dtype=torch.float64))
    assert first.tolist() == [[-2, -1], [0, 3]]
    # Then 0.75 · 3 + 0.25 · 7 = 4.
    second = baseline.advantage(batch, torch.tensor([[7.0, 7.0], [6.0, 8.0]], dtype=torch.float64))
    assert second.tolist() == [[3, 3], [2, 4]]
    assert not baseline.end_epoch(build_network(NetworkConfig(embedding=32), "shared", 2, seed=0), batch, second[:, 0])
    resumed = ExponentialBaseline(0.75)
    resumed.restore(baseline.state(), Path("baseline.safetensors"))
    # 0.75 · 4 + 0.25 · 0 = 3, in both.
    zeros = torch.zeros(2, 2, dtype=torch.float64)
    assert resumed.advantage(batch, zeros).tolist() == baseline.advantage(batch, zeros).tolist() == [[-3, -3], [-3, -3]]


@pytest.mark.parametrize(
    "state", [{}, {"average": torch.tensor(float("nan"))}, {"average": torch.zeros(2)}, {"mean": torch.zeros(())}]
)
def test_a_damaged_exponential_baseline_is_refused(state: dict[str, torch.Tensor]) -> None:
    with pytest.raises(ConfigError, match=r"there\.safetensors: expected one finite number"):
        ExponentialBaseline(0.8).restore(state, Path("there.safetensors"))


def test_the_moving_average_is_in_the_checkpoint(tmp_path: Path) -> None:
    config = TrainConfig(
        network=NetworkConfig(embedding=32, heads=4), tasks=(10,), min_robots=1, max_robots=3, scenarios=4, samples=4,
        updates=6, epoch=2, validation_scenarios=8, baseline="exponential",
    )  # fmt: skip
    run = checkpoint.start(tmp_path, config)
    run.validate()
    checkpoint.save(tmp_path, run, 0.0)
    assert checkpoint.resume(tmp_path)[0].baseline.state() == {}
    run.step(), run.step()
    run.validate()
    checkpoint.save(tmp_path, run, 0.0)
    (average,) = run.baseline.state().values()
    assert 0 < float(average) < 1
    assert checkpoint.resume(tmp_path)[0].baseline.state() == {"average": average}
    (tmp_path / "checkpoints" / "00000002" / "baseline.safetensors").unlink()
    with pytest.raises(ConfigError, match=r"baseline\.safetensors: no such file"):
        checkpoint.resume(tmp_path)
