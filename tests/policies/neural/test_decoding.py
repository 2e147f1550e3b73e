"""From probabilities to plans: beams and symmetries by hand, and what every way of decoding promises."""

from __future__ import annotations

from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any, get_args

import numpy as np
import pytest
import torch
from factories import hopeless_scenario

from mrta_zoo import Scenario
from mrta_zoo.batch import BatchMission
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import TaptcGenerator, UniformGenerator
from mrta_zoo.policies import stop
from mrta_zoo.policies.neural.beam_search import beam_search
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.decoding import Decoding, best_plan
from mrta_zoo.policies.neural.policy import NeuralPolicy
from mrta_zoo.policies.neural.rollout import roll_out
from mrta_zoo.policies.neural.sharing import build_network
from mrta_zoo.policies.neural.symmetry import SYMMETRIES, SymmetricNetwork, View
from mrta_zoo.policies.neural.weights import PolicyInfo
from mrta_zoo.policies.options import Decode
from mrta_zoo.policies.stop import OutOfTimeError, TimeLimit
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario_batch import ScenarioBatch
from mrta_zoo.verify import verify

SMALL = NetworkConfig(embedding=32, heads=4)
DECODES = get_args(Decode)
BOTH_WAYS = Scenario(
    task_xy=[[60, 0], [40, 0], [30, 0]], deadline=[11, 12, 21], workload=[0, 0, 0], robot_xy=[[50, 0]], capacity=[1]
)
"""A robot at 50 may go right, to task 0, and is late for the others then; or left, to tasks 1 and 2 (10, then 20)."""


def policy(seed: int = 0, rule: MaskRule = "feasible") -> NeuralPolicy:
    network = build_network(SMALL, "shared", 1, seed=seed)
    return NeuralPolicy(network, PolicyInfo(network=SMALL, mask_rule=rule))


def draw(count: int, seed: int = 0) -> list[Scenario]:
    rng = np.random.default_rng(seed)
    make = TaptcGenerator(tasks=(15, 25), robots=(2, 4)), UniformGenerator(tasks=(9, 20), robots=(1, 4))
    return [make[index % 2](rng) for index in range(count)]


@dataclass(frozen=True)
class Seen:
    """What the stubs encode: the tasks."""

    tasks: Tasks


class Fixed:
    """A network that gives every task the same score always."""

    def __init__(self, probabilities: list[float]) -> None:
        self.scores = torch.tensor(probabilities).log()
        self.calls = 0

    def encode(self, tasks: Tasks) -> Seen:
        return Seen(tasks)

    def features(self, encoding: Seen, states: DecisionStates) -> None:
        return None

    def score(self, encoding: Seen, states: DecisionStates) -> torch.Tensor:
        return self.scores.expand(states.mask.shape)

    def __call__(self, encoding: Seen, states: DecisionStates, features: Any = None) -> torch.Tensor:
        self.calls += 1
        over = ~states.mask.any(-1, keepdim=True)
        scores = self.score(encoding, states).masked_fill(~states.mask & ~over, -torch.inf)
        return scores.log_softmax(-1)


class Leftmost(Fixed):
    """A network that likes the task with the least x."""

    def score(self, encoding: Seen, states: DecisionStates) -> torch.Tensor:
        return (-9 * encoding.tasks.xy[:, None, :, 0]).expand(states.mask.shape)


def test_a_beam_finds_what_greedy_misses() -> None:
    # Right is likelier (0.6), but ends the mission; left (0.3), then task 2.
    network = Fixed([0.6, 0.3, 0.1])
    greedy, narrow, wide = (
        best_plan(network, BOTH_WAYS, Decoding(decode=decode, samples=width))
        for decode, width in (("greedy", None), ("beam", 1), ("beam", 2))  # type: ignore[arg-type]
    )
    assert greedy.routes == narrow.routes == ((0,),)
    assert wide.routes == ((1, 2),)
    assert verify(BOTH_WAYS, wide).completed == 2


def test_the_likeliest_missions_go_on() -> None:
    # Far deadlines: six orders of three tasks. With p = 0.5, 0.3, 0.2: 012 has 0.5·0.6 = 0.3, 021 0.5·0.4 = 0.2,
    # 102 0.3·5/7 = 0.21, 120 0.3·2/7 = 0.09, 201 0.2·5/8 = 0.125, 210 0.2·3/8 = 0.075.
    free = replace(BOTH_WAYS, deadline=np.full(3, 1000.0))
    batch = ScenarioBatch.of([free])
    for width, expected in (
        (1, ["012"]),
        (2, ["012", "102"]),
        (3, ["012", "102", "021"]),
        (6, ["012", "102", "021", "201", "120", "210"]),
    ):
        (missions,) = beam_search(Fixed([0.5, 0.3, 0.2]), batch, width)
        assert ["".join(map(str, plan.routes[0])) for plan in missions.plans()] == expected


@pytest.mark.parametrize("rule", ["feasible", "active", "unvisited"])
def test_a_beam_of_width_one_is_greedy(rule: MaskRule) -> None:
    network = policy().network
    for scenario in draw(6, seed=1):
        batch = ScenarioBatch.of([scenario])
        (mission,) = beam_search(network, batch, 1, mask_rule=rule)
        greedy = roll_out(network, batch, mask_rule=rule, keep_plans=True)
        assert mission.plans() == greedy.plans


def test_no_two_missions_of_a_beam_are_the_same() -> None:
    twins = Scenario(  # two robots alike in one place
        task_xy=[[10, 0], [20, 0], [0, 10], [0, 20]], deadline=[90] * 4, workload=[1] * 4,
        robot_xy=[[0, 0], [0, 0]], capacity=[1, 1],
    )  # fmt: skip
    found = beam_search(Fixed([0.25] * 4), ScenarioBatch.of([twins]), 50)
    plans = [plan for missions in found for plan in missions.plans()]
    assert len(plans) == len(set(plans)) > 10


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("decode", DECODES)
def test_every_way_of_decoding_is_legal_repeatable_and_no_worse_than_greedy(decode: Decode, seed: int) -> None:
    for rule in ("feasible", "active", "unvisited"):
        own = policy(seed, rule)  # type: ignore[arg-type]
        for scenario in [*draw(4, seed=seed), hopeless_scenario()]:
            greedy, plan = own.solve(scenario), own.solve(scenario, decode=decode, samples=6, seed=3)
            score = verify(scenario, plan)
            assert score.completed >= verify(scenario, greedy).completed
            if rule == "feasible":
                assert score.completed == sum(map(len, plan.routes))
            if rule == "unvisited":
                assert sum(map(len, plan.routes)) == scenario.num_tasks
            assert plan == own.solve(scenario, decode=decode, samples=6, seed=3)
            assert (plan.scenario, plan.method) == (scenario.name, "capam")


def test_some_scenarios_gain_by_every_search() -> None:
    own, scenarios = policy(1), draw(8, seed=5)
    greedy = [verify(scenario, own.solve(scenario)).completed for scenario in scenarios]
    for decode in ("sample", "augment", "beam"):
        found = [verify(each, own.solve(each, decode=decode)).completed for each in scenarios]  # type: ignore[arg-type]
        assert sum(found) > sum(greedy)


def test_the_eight_symmetries_of_a_place_by_hand() -> None:
    # On a map of 100 × 50, in lengths of 100: (0.3, 0.1) is 0.7 from the right and 0.4 from the top.
    wide = replace(BOTH_WAYS, task_xy=[[100, 0], [0, 50], [30, 0]], deadline=[99, 99, 99], map_size=(100.0, 50.0))
    view = View.of(ScenarioBatch.of([wide]).repeat(SYMMETRIES))
    seen = view.of_places(torch.tensor([0.3, 0.1]).expand(8, 1, 2))[:, 0]
    expected = [[0.3, 0.1], [0.7, 0.1], [0.3, 0.4], [0.7, 0.4], [0.1, 0.3], [0.1, 0.7], [0.4, 0.3], [0.4, 0.7]]
    torch.testing.assert_close(seen, torch.tensor(expected))


def mirrored(scenario: Scenario, number: int) -> Scenario:
    """The scenario itself seen through a symmetry: flip x, flip y, swap."""

    def of_places(xy: Any) -> Any:
        xy = xy.copy()
        for axis in (0, 1):
            if number & (axis + 1):
                xy[:, axis] = scenario.map_size[axis] - xy[:, axis]
        return xy[:, ::-1].copy() if number & 4 else xy

    size = scenario.map_size[::-1] if number & 4 else scenario.map_size
    return replace(scenario, task_xy=of_places(scenario.task_xy), robot_xy=of_places(scenario.robot_xy), map_size=size)


def test_a_network_sees_the_mirrored_mission() -> None:
    scenario = UniformGenerator(tasks=(12, 12), robots=(3, 3), map_size=(60, 100))(np.random.default_rng(2))
    network = policy().network
    eight = ScenarioBatch.of([scenario]).repeat(SYMMETRIES)
    symmetric = SymmetricNetwork(network, eight)
    mission = BatchMission(eight)
    really = BatchMission(ScenarioBatch.of([mirrored(scenario, number) for number in range(SYMMETRIES)]))
    with torch.no_grad():
        encoding = symmetric.encode(Tasks.of_batch(eight))
        expected_encoding = network.encode(Tasks.of_batch(really.scenarios))
        for _ in range(4):
            states, expected = DecisionStates.of_batch(mission), DecisionStates.of_batch(really)
            seen = symmetric(encoding, states, symmetric.features(encoding, states))
            torch.testing.assert_close(seen, network(expected_encoding, expected), rtol=1e-4, atol=1e-4)
            assert not torch.allclose(seen[0], seen[1], atol=1e-4)
            action = mission.mask().int().argmax(1)
            mission.step(action)
            really.step(action)


def test_augmentation_keeps_the_best_of_what_the_symmetries_give() -> None:
    # "Leftmost" goes left in the map as it is, and so completes task 2 alone; flipped, it goes right: task 0 alone.
    # With task 1 left of task 2 … the mirrored map is the better one.
    scenario = Scenario(
        task_xy=[[30, 0], [60, 0], [70, 0]], deadline=[20, 90, 20], workload=[0, 0, 0], robot_xy=[[50, 0]], capacity=[1]
    )
    greedy = best_plan(Leftmost([1.0]), scenario, Decoding())
    # Left to 30 at 20, then 60 at 50, and 70 is late. Flipped: 70 first, at 20, then 60 at 30, and 30 is late.
    assert greedy.routes == ((0, 1),)
    free = replace(scenario, deadline=[20, 90, 60.0])
    # Left first: 30 at 20, 60 at 50, 70 at 60: three. Flipped: 70 at 20, 60 at 30, 30 too late.
    assert best_plan(Leftmost([1.0]), free, Decoding(decode="augment")).routes == ((0, 1, 2),)
    turned = mirrored(free, 1)  # the same with left and right exchanged: only the flipped view finds all three
    assert verify(turned, best_plan(Leftmost([1.0]), turned, Decoding())).completed == 2
    assert best_plan(Leftmost([1.0]), turned, Decoding(decode="augment")).routes == ((0, 1, 2),)


class Clock:
    """Moves on by one second at each look."""

    def __init__(self) -> None:
        self.now = -1.0

    def __call__(self) -> float:
        self.now += 1.0
        return self.now


@pytest.mark.parametrize("decode", ["sample", "augment", "beam"])
def test_budgets_are_kept(decode: Decode, monkeypatch: pytest.MonkeyPatch) -> None:
    scenario, own = draw(1)[0], policy()
    for budget in (1.0, 20.0, 100.0):
        clock = Clock()
        monkeypatch.setattr(stop, "time", SimpleNamespace(perf_counter=clock))
        plan = own.solve(scenario, decode=decode, budget=budget)
        assert budget <= clock.now <= budget + 2  # it goes on until the end, and stops there
        assert verify(scenario, plan).completed >= verify(scenario, own.solve(scenario)).completed


def test_without_time_there_is_no_plan_unless_there_must_be() -> None:
    scenario, own = draw(1)[0], policy()
    assert own.solve_within(scenario, TimeLimit.of(1e-9)) is None
    assert own.solve_within(scenario, TimeLimit.of(600.0)) == own.solve(scenario)
    assert own.solve(scenario, budget=1e-9) == own.solve(scenario)
    with pytest.raises(OutOfTimeError):
        roll_out(own.network, ScenarioBatch.of([scenario]), limit=TimeLimit.of(0.0))


@pytest.mark.parametrize("decode", DECODES)
def test_spoilt_weights_are_told(decode: Decode) -> None:
    own = policy()
    with torch.no_grad():
        next(iter(own.network.parameters())).fill_(float("nan"))
    with pytest.raises(ConfigError, match="not finite"):
        own.solve(draw(1)[0], decode=decode)


def test_options_are_checked() -> None:
    scenario, own = draw(1)[0], policy()
    for options, sentence in (
        ({"decode": "beams"}, "decode is 'beams'; expected one of greedy, sample, augment, beam"),
        ({"decode": "beam", "samples": 0}, "samples is 0; expected a whole number from 1 to"),
        ({"decode": "augment", "budget": -1.0}, "budget is -1; expected a number of seconds > 0"),
    ):
        with pytest.raises(ConfigError, match=sentence):
            own.solve(scenario, **options)  # type: ignore[arg-type]
