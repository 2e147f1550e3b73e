"""Who shares a network: the same in the simulator, in the AEC loop, on disk and on the command line."""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
import torch

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.batch import BatchMission
from mrta_zoo.cli.main import main
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import TaptcGenerator, UniformGenerator
from mrta_zoo.io import write_scenario
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.policy import NeuralPolicy, load_policy
from mrta_zoo.policies.neural.rollout import roll_out
from mrta_zoo.policies.neural.sharing import (
    WAYS,
    ByCapacityNetworks,
    IndependentNetworks,
    Sharing,
    build_network,
    seeded,
)
from mrta_zoo.policies.neural.weights import PolicyInfo, save_policy
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.reinforce import Reinforce

SMALL = NetworkConfig(embedding=16, heads=2)
TEAMS = TaptcGenerator(tasks=(8, 14), robots=(2, 4), capacity="random")


def test_every_way_of_sharing_has_its_row() -> None:
    assert set(WAYS) == set(get_args(Sharing))


def draw(count: int, seed: int = 0) -> list[Scenario]:
    rng = np.random.default_rng(seed)
    return [TEAMS(rng) for _ in range(count)]


def team(*capacities: float) -> Scenario:
    """A mission on which every robot finds something to do."""
    return replace(
        UniformGenerator(tasks=(10, 10), robots=(1, 1), deadline=(300, 400))(np.random.default_rng(3)),
        robot_xy=[[10.0 * robot, 20] for robot in range(len(capacities))],
        capacity=capacities,
        speed=np.ones(len(capacities)),
    )


def policy(sharing: Sharing, config: NetworkConfig = SMALL) -> NeuralPolicy:
    info = PolicyInfo(network=config, sharing=sharing, robots=4)
    return NeuralPolicy(build_network(config, sharing, 4, seed=3), info)


def in_the_aec_loop(decides: NeuralPolicy, scenario: Scenario, *, each_alone: bool) -> tuple[tuple[int, ...], ...]:
    env = mrta_v0.raw_env(scenario=scenario)
    env.reset()
    routes: dict[str, list[int]] = {agent: [] for agent in env.agents}
    for agent in env.agent_iter():
        observation, _, termination, truncation, _ = env.last()
        if termination or truncation:
            env.step(None)
            continue
        of_agent = decides.for_agent(agent) if each_alone else decides
        routes[agent].append(of_agent.act(observation, agent))
        env.step(routes[agent][-1])
    return tuple(map(tuple, routes.values()))


@pytest.mark.parametrize("decoder", ["attention", "candidates"])
@pytest.mark.parametrize("sharing", WAYS)
def test_one_robot_alone_all_robots_and_the_simulator_decide_the_same(sharing: Sharing, decoder: str) -> None:
    decides, scenarios = policy(sharing, replace(SMALL, decoder=decoder)), draw(5)
    plans = roll_out(decides.network, ScenarioBatch.of(scenarios), keep_plans=True).plans
    for plan, scenario in zip(plans, scenarios, strict=True):
        assert in_the_aec_loop(decides, scenario, each_alone=False) == plan.routes
        assert in_the_aec_loop(decides, scenario, each_alone=True) == plan.routes


def log_probs(network: torch.nn.Module, scenario: Scenario) -> torch.Tensor:
    """(N,) of the first decision, which is robot 0's."""
    batch = ScenarioBatch.of([scenario])
    with torch.no_grad():
        found: torch.Tensor = network(
            network.encode(Tasks.of_batch(batch)), DecisionStates.of_batch(BatchMission(batch))
        )  # type: ignore[operator]
    return found[0, 0]


def test_the_capacity_says_which_network_decides() -> None:
    network = build_network(SMALL, "by-capacity", robots=1, seed=0)
    assert isinstance(network, ByCapacityNetworks)
    weak, strong = network.networks
    # Robot 0 has half of the strongest robot's capacity, then all of it: alone, too, and whatever the unit.
    for scenario, of_kind, other in (
        (team(1, 2), weak, strong), (team(2, 1), strong, weak), (team(1), strong, weak), (team(3, 6, 6), weak, strong),
    ):  # fmt: skip
        assert torch.equal(log_probs(network, scenario), log_probs(of_kind, scenario))
        assert not torch.allclose(log_probs(network, scenario), log_probs(other, scenario))


def test_three_kinds() -> None:
    network = build_network(SMALL, "by-capacity", robots=1, seed=0, kinds=(1 / 3, 0.5, 1.0))
    assert isinstance(network, ByCapacityNetworks)
    assert torch.equal(log_probs(network, team(1, 3)), log_probs(network.networks[0], team(1, 3)))
    assert torch.equal(log_probs(network, team(1, 2)), log_probs(network.networks[1], team(1, 2)))


def test_an_unknown_capacity_is_told_wherever_it_turns_up() -> None:
    decides, stranger = policy("by-capacity"), team(2, 2, 1.5)
    sentence = r"robot 2 has no network: it has 0.75 of the strongest robot's capacity.*with 0.5 or 1 of it"
    with pytest.raises(ConfigError, match=sentence):
        decides.solve(stranger)
    with pytest.raises(ConfigError, match=sentence):
        in_the_aec_loop(decides, stranger, each_alone=True)
    with pytest.raises(ConfigError, match=r"generator 'uniform' draws any capacity; expected generator taptc"):
        Reinforce(TrainConfig(sharing="by-capacity", generator="uniform"))


@pytest.mark.parametrize("robots", [1, 6, 9])
def test_teams_of_other_sizes(robots: int) -> None:
    scenario = team(*[1 + robot % 2 for robot in range(robots)])
    for sharing in ("shared", "by-capacity"):
        decides = policy(sharing)  # type: ignore[arg-type]
        assert in_the_aec_loop(decides, scenario, each_alone=True) == decides.solve(scenario).routes
    if robots <= 4:
        assert policy("independent").solve(scenario).routes
        return
    who = {6: "robots 4 and 5 have", 9: "robots 4 to 8 have"}[robots]
    sentence = f"{who} no network: these independent policies were trained for 4 robots"
    with pytest.raises(ConfigError, match=sentence):
        policy("independent").solve(scenario)
    with pytest.raises(ConfigError, match=sentence):
        in_the_aec_loop(policy("independent"), scenario, each_alone=False)
    with pytest.raises(ConfigError, match=r"robot 4 has no network"):
        policy("independent").for_agent("robot_4")


def test_the_policy_of_one_robot() -> None:
    independent, shared, by_capacity = policy("independent"), policy("shared"), policy("by-capacity")
    assert isinstance(independent.network, IndependentNetworks)
    assert independent.for_agent("robot_3").network is independent.network.of_robot(3)
    assert independent.for_agent("robot_3") is independent.for_agent("robot_3")  # which encodes once a mission
    assert shared.for_agent("robot_3") is shared
    assert by_capacity.for_agent("robot_3") is by_capacity
    env = mrta_v0.env(scenario=team(1, 2, 1, 2))
    env.reset()
    observation = env.last()[0]
    asked = [independent.for_agent(f"robot_{robot}").decide(observation).probabilities for robot in range(4)]
    assert np.array_equal(asked[0], independent.decide(observation).probabilities)
    assert not np.allclose(asked[0], asked[3])  # another robot's network, asked what robot 0 sees
    twin = independent.fork()
    assert twin.for_agent("robot_3") is not independent.for_agent("robot_3")  # it has draws of its own
    assert twin.for_agent("robot_3").network is independent.network.of_robot(3)
    for name in ("robot", "robot_", "robot_x", "robot_-1", "3", "agent_0"):
        with pytest.raises(ConfigError, match=rf"there is no agent '{name}'; expected robot_0, robot_1"):
            shared.for_agent(name)


@pytest.mark.parametrize("sharing", WAYS)
def test_what_is_saved_is_what_was_trained(
    sharing: Sharing, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run, scenario = tmp_path / "run", tmp_path / "cases" / "mission.json"
    scenario.parent.mkdir()
    small = "--tasks 8 --reference-tasks 8 --min-robots 2 --max-robots 3 --updates 2 --epoch 2 --scenarios 2 "
    small += "--samples 2 --validation-scenarios 4 --embedding 16 --heads 2 --generator taptc"
    assert main(["train", "--out", str(run), "--sharing", sharing, *small.split()]) == 0
    write_scenario(team(2, 1), scenario)
    assert main(["solve", str(scenario), "--method", str(run)]) == 0
    rows = tmp_path / "rows.csv"
    assert main(["eval", "--cases", str(scenario.parent), "--methods", f"nearest,{run}", "--out", str(rows)]) == 0
    loaded = load_policy(run)
    assert (loaded.info.sharing, loaded.info.robots) == (sharing, 3)
    save_policy(tmp_path / "copy.safetensors", loaded.network, loaded.info)
    assert load_policy(tmp_path / "copy.safetensors").solve(team(2, 1)).routes == loaded.solve(team(2, 1)).routes
    capsys.readouterr()
    if sharing == "by-capacity":
        write_scenario(team(2, 1.5), scenario)
        assert main(["solve", str(scenario), "--method", str(run)]) == 2
        assert "robot 1 has no network: it has 0.75 of" in capsys.readouterr().err
    if sharing == "independent":
        write_scenario(team(2, 1, 1, 2), scenario)
        assert main(["solve", str(scenario), "--method", str(run)]) == 2
        assert "robot 3 has no network" in capsys.readouterr().err


@pytest.mark.parametrize("kinds", [(), (0.5,), (1.0, 0.5), (0.0, 1.0), (0.99995, 1.0), (0.5, 2.0)])
def test_kinds_that_are_none(kinds: tuple[float, ...]) -> None:
    with pytest.raises(ConfigError, match=r"kinds is .*; expected capacities as shares of the strongest robot's"):
        TrainConfig(kinds=kinds)


def test_each_kind_learns_from_its_own_robots_alone() -> None:
    # A team of equals has only robots of the strongest kind: the other network gets no gradient.
    equals = UniformGenerator(tasks=(8, 8), robots=(2, 2), capacity=(2.0, 2.0))
    config = TrainConfig(network=SMALL, sharing="by-capacity", scenarios=2, samples=4, updates=1, device="cpu")
    run = Reinforce(config, equals)
    assert isinstance(run.network, ByCapacityNetworks)
    weak, strong = (
        [parameter.detach().clone() for parameter in network.parameters()] for network in run.network.networks
    )
    run.step()
    weak_now, strong_now = (list(network.parameters()) for network in run.network.networks)
    assert all(torch.equal(one, other) for one, other in zip(weak, weak_now, strict=True))
    assert not all(torch.equal(one, other) for one, other in zip(strong, strong_now, strict=True))


def test_networks_built_in_several_threads_are_those_built_alone() -> None:
    """The second waits until the first, which found torch's generator as it was, has put it back."""
    alone = build_network(SMALL, "shared", 1, seed=1).state_dict()
    built: list[dict[str, torch.Tensor]] = []
    thread = threading.Thread(target=lambda: built.append(build_network(SMALL, "shared", 1, seed=1).state_dict()))
    before = torch.get_rng_state()
    with seeded(2):
        thread.start()
        thread.join(0.05)
        assert built == []
    thread.join()
    assert torch.equal(torch.get_rng_state(), before)
    assert all(torch.equal(each, alone[name]) for name, each in built[0].items())
