"""What the candidate decoder looks at, by hand; and that it looks at nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import torch
from strategies import seeded_chooser, seeded_scenarios

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.batch import BatchMission
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.policies.neural.capam.candidates import MISSION_COLUMNS, TASK_COLUMNS, Candidates
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.capam.inputs import DecisionStates, Tasks
from mrta_zoo.policies.neural.capam.neighbourhood import Neighbourhood
from mrta_zoo.policies.neural.capam.prospects import PROSPECT_COLUMNS
from mrta_zoo.policies.neural.capam.robots import ROBOT_COLUMNS
from mrta_zoo.policies.neural.rollout import roll_out
from mrta_zoo.policies.neural.sharing import Network, build_network
from mrta_zoo.scales import Scales
from mrta_zoo.scenario_batch import ScenarioBatch

PLUS = NetworkConfig(embedding=32, heads=4, decoder="candidates", decision_layers=2)

# L = 100 and V = 2, so a crossing takes 50; T = 200 is 4 crossings. W = 40 and C = 2: W takes the strongest robot 20,
# 0.4 crossings. Robot 0 has speed 1, so pace 2 crossings for L, and capacity C, so rate 0.4 crossings for W.
# Robot 1 has speed V, so pace 1, and half of C, so rate 0.8.
SCENARIO = Scenario(
    task_xy=np.array([[30, 40], [0, 10], [30, 80], [100, 0]]),
    deadline=np.array([100, 50, 200, 90]),
    workload=np.array([20, 40, 0, 10]),
    robot_xy=np.array([[0, 0], [30, 40]]),
    capacity=np.array([2.0, 1.0]),
    speed=np.array([1.0, 2.0]),
    map_size=(100, 100),
)
TO_2 = 2 * np.hypot(0.3, 0.8)
"""Robot 0 from its start to task 2, in crossings: 1.709."""
FROM_1_TO_0 = np.hypot(0.3, 0.3)
"""Between tasks 1 and 0, in L: 0.424."""
FROM_1_TO_2 = np.hypot(0.3, 0.7)
"""Between tasks 1 and 2, in L: 0.762."""


def candidates(mission: BatchMission, most_tasks: int = 4, most_peers: int = 1) -> Candidates:
    tasks = Tasks.of_batch(mission.scenarios)
    return Candidates.of(tasks, Neighbourhood.of(tasks), DecisionStates.of_batch(mission), most_tasks, most_peers)


def column(found: Candidates, name: str) -> list[float]:
    return found.task[0, 0, :3, TASK_COLUMNS.index(name)].tolist()


def log_third(slope: float, *durations: float) -> float:
    """What `prospects` makes of tasks that take so long each."""
    return float(np.log1p(sum(np.exp(-slope * duration) for duration in durations)) / 3)


def network_of(config: NetworkConfig, seed: int = 3) -> Network:
    network = build_network(config, "shared", robots=1, seed=seed)
    with torch.no_grad():  # the last layer starts at 0
        for parameter in network.parameters():
            if parameter.abs().max() == 0:
                parameter.normal_(std=0.3, generator=torch.Generator().manual_seed(seed))
    return network.eval()


@torch.no_grad()
def log_probs(network: Network, mission: BatchMission) -> torch.Tensor:
    """(B, N) of the present decisions."""
    result: torch.Tensor = network(network.encode(Tasks.of_batch(mission.scenarios)), DecisionStates.of_batch(mission))  # type: ignore[arg-type]
    return result[:, 0]


def test_what_is_known_of_the_first_decision() -> None:
    found = candidates(BatchMission(ScenarioBatch.of([SCENARIO])))
    # Robot 0: task 1 at 0.2 + 0.4 = 0.6; task 0 at 1 + 0.2 = 1.2; task 2 at 1.709; task 3 at 2 > 90/50: too late.
    assert found.index.tolist() == [[[1, 0, 2, 3]]]
    assert found.valid.tolist() == [[[True, True, True, False]]]
    assert (found.task[0, 0, 3] == 0).all()
    slack_2 = 4 - TO_2
    expected = {
        "dx": [0, 0.3, 0.3],
        "dy": [0.1, 0.4, 0.8],
        "x": [0, 0.3, 0.3],
        "y": [0.1, 0.4, 0.8],
        "travel": [0.2, 1.0, 1.0],  # 1.709 saturates at 1
        "work": [0.4, 0.2, 0.0],  # 40/40 · 0.4, 20/40 · 0.4
        "slack": [0.4 / 2, 0.8 / 2, 1.0],  # 1 − 0.6, 2 − 1.2; (4 − 1.709)/2 saturates
        "tightness": [1 / 5, 1 / 9, 1 / (1 + 10 * slack_2)],
        "left": [1 / 4, 2 / 4, 4 / 4],
        # Robot 1 is at task 0, 0.424 from task 1, and 0.4 from task 2: −1.309 saturates.
        "head_start": [FROM_1_TO_0 - 0.2, 0 - 1.0, -1.0],
        "second_head_start": [1, 1, 1],  # there is no second peer
        # Robot 1 would finish task 1 at 0.424 + 0.8 > 1, task 0 at 0.4 <= 2, task 2 at 0.4 <= 4.
        "rivals": [0, 1, 1],
        # After task 1: task 0 at 0.6 + 2 · 0.424 + 0.2 = 1.65 <= 2, task 2 at 0.6 + 2 · 0.762 = 2.12 <= 4.
        # After task 0: task 2 at 1.2 + 0.8 = 2 <= 4; task 1 is too late. After task 2 (1.709) both are.
        "next_gap": [2 * FROM_1_TO_0, 0.8, 1.0],
        "second_gap": [1.0, 1.0, 1.0],  # 2 · 0.762 saturates
        "next_count": [2 / 3, 1 / 3, 0],
        "rank": [0, 1 / 4, 2 / 4],
        # What may follow takes 2 · 0.424 + 0.2 and 2 · 0.762 after task 1, 0.8 after task 0; each counts e^(−10 times
        # that), or e^(−10/3 times). Robot 1 is at task 0 and 0.4 from task 2, always the first.
        "near": [log_third(10, 2 * FROM_1_TO_0 + 0.2, 2 * FROM_1_TO_2), log_third(10, 0.8), 0],
        "far": [log_third(10 / 3, 2 * FROM_1_TO_0 + 0.2, 2 * FROM_1_TO_2), log_third(10 / 3, 0.8), 0],
        "near_first": [0, 0, 0],
        "far_first": [0, 0, 0],
    }
    assert expected.keys() == set(TASK_COLUMNS)
    for name, values in expected.items():
        assert column(found, name) == pytest.approx(values, abs=1e-6), name


def test_what_is_known_of_robots_and_mission() -> None:
    found = candidates(BatchMission(ScenarioBatch.of([SCENARIO])))
    assert found.robot_valid.tolist() == [[[True, True]]]
    own = dict(zip(ROBOT_COLUMNS, found.robot[0, 0, 0].tolist(), strict=True))
    assert own == {"dx": 0, "dy": 0, "x": 0, "y": 0, "wait": 0, "capacity": 1, "speed": 0.5, "is_ego": 1}
    peer = dict(zip(ROBOT_COLUMNS, found.robot[0, 0, 1].tolist(), strict=True))
    assert peer == pytest.approx(
        {"dx": 0.3, "dy": 0.4, "x": 0.3, "y": 0.4, "wait": 0, "capacity": 0.5, "speed": 1, "is_ego": 0}
    )
    mission = dict(zip(MISSION_COLUMNS, found.mission[0, 0].tolist(), strict=True))
    # 3 of 4 tasks may be chosen, by 2 robots: 3/2/50. Time left for them: (2 + 1 + 4)/3, a quarter of it.
    assert mission == pytest.approx(
        {"elapsed": 0, "horizon": 1, "work_unit": 0.4, "free_share": 0.75, "free_a_robot": 0.03, "time_left": 7 / 12}
    )


def test_pairs() -> None:
    pairs = candidates(BatchMission(ScenarioBatch.of([SCENARIO]))).pairs()[0, 0]
    assert pairs.shape == (5, 2 + 4, 4)

    def check(row: int, column: int, time: float, spare: float) -> None:
        wanted = [time, np.exp(-10 * time), np.exp(-3 * time), spare, float(spare >= 0)]
        assert pairs[:, row, column].tolist() == pytest.approx(wanted, abs=1e-6)

    # Robots 0 and 1, then the candidates 1, 0, 2; columns are the candidates 1, 0, 2.
    check(0, 0, 0.2 + 0.4, 1 - 0.6)
    check(1, 0, FROM_1_TO_0 + 0.8, 1 - FROM_1_TO_0 - 0.8)  # 0.224 too late
    check(1, 2, 0.4, 1.0)  # 4 − 0.4 saturates
    check(2, 1, 2 * FROM_1_TO_0 + 0.2, 2 - 0.6 - 2 * FROM_1_TO_0 - 0.2)  # after task 1, robot 0 can do task 0
    check(3, 0, 2 * FROM_1_TO_0 + 0.4, -1.0)  # after task 0, it is 1.2 + 1.249 − 1 = 1.449 too late for task 1
    check(3, 2, 0.8, 1.0)


def test_what_is_known_later() -> None:
    mission = BatchMission(ScenarioBatch.of([SCENARIO]))
    mission.step(torch.tensor([1]))  # robot 0, until 10 + 20 = 30
    found = candidates(mission)
    # Robot 1 acts at 0; robot 0 is free at (0, 10) after 30/50.
    assert found.robot[0, 0, 1].tolist() == pytest.approx([-0.3, -0.3, 0, 0.1, 0.6, 1, 0.5, 0])
    mission.step(torch.tensor([0]))  # robot 1, until 0 + 20 = 20
    found = candidates(mission)
    # Robot 1 again, at 20/50 = 0.4: task 2 takes 0.4; task 3, hypot(0.7, 0.4) = 0.806 and 10/40 · 0.8 = 0.2.
    assert found.index[0, 0, :2].tolist() == [2, 3]
    assert found.valid.tolist() == [[[True, True, False, False]]]
    assert found.mission[0, 0, 0] == pytest.approx(0.4 / 4)
    assert found.robot[0, 0, 1, ROBOT_COLUMNS.index("wait")] == pytest.approx((30 - 20) / 50)
    to_3 = np.hypot(0.7, 0.4)
    assert column(found, "travel")[:2] == pytest.approx([0.4, to_3])
    assert column(found, "work")[:2] == pytest.approx([0, 0.2])
    assert column(found, "left")[:2] == pytest.approx([(4 - 0.4) / 4, (1.8 - 0.4) / 4])
    # Robot 0 could be at task 2 after 0.2 + 2 · 0.762 <= 3.6, at task 3 only after 0.2 + 2 · 1.005 > 1.4.
    assert column(found, "rivals")[:2] == [1, 0]
    assert column(found, "head_start")[:2] == pytest.approx([1, 1])  # both saturate
    # After task 2, at 0.4, task 3 is hypot(0.7, 0.8) = 1.063 away: 1.463 + 0.2 > 1.4. The other way there is time:
    # 1.006 + 1.063 <= 3.6.
    assert column(found, "next_count")[:2] == pytest.approx([0, 1 / 3])


def test_untrained_network_takes_the_quickest_task() -> None:
    network = build_network(PLUS, "shared", robots=1, seed=0)
    # −30 · (travel + work), both saturated: 0.6, 1.2 and 1.0.
    wanted = torch.tensor([-30 * 1.2, -30 * 0.6, -30 * 1.0, -torch.inf]).log_softmax(0)
    torch.testing.assert_close(log_probs(network, BatchMission(ScenarioBatch.of([SCENARIO])))[0], wanted)


@pytest.mark.parametrize(("most", "possible"), [(1, [1]), (2, [0, 1]), (3, [0, 1, 2]), (40, [0, 1, 2])])
def test_only_the_quickest_tasks_are_likely(most: int, possible: list[int]) -> None:
    network = network_of(replace(PLUS, candidates=most))
    row = log_probs(network, BatchMission(ScenarioBatch.of([SCENARIO])))[0]
    assert torch.isfinite(row).nonzero().flatten().tolist() == possible
    assert float(row.exp().sum()) == pytest.approx(1)


def test_a_mission_with_more_tasks_than_candidates_is_planned_to_its_end() -> None:
    scenario = UniformGenerator(tasks=(40, 40), robots=(2, 2), deadline=(400, 800))(np.random.default_rng(0))
    rollout = roll_out(network_of(replace(PLUS, candidates=3)), ScenarioBatch.of([scenario]))
    # Each robot has time for some 400/(50 + 20) tasks at least: far more than 3 candidates.
    assert rollout.completed[0] >= 10
    assert torch.isfinite(rollout.log_prob).all()


def test_only_the_nearest_peers_matter() -> None:
    rng = np.random.default_rng(0)
    scenario = UniformGenerator(tasks=(8, 8), robots=(4, 4), deadline=(300, 500))(rng)
    network = network_of(replace(PLUS, peers=2))

    def with_peers(*places: tuple[float, float]) -> torch.Tensor:
        moved = replace(scenario, robot_xy=np.array([(50.0, 50.0), *places]), capacity=np.ones(4), speed=np.ones(4))
        return log_probs(network, BatchMission(ScenarioBatch.of([moved])))

    before = with_peers((50, 60), (70, 50), (50, 20))  # 10, 20, and 30 away
    torch.testing.assert_close(with_peers((50, 60), (70, 50), (90, 90)), before)
    torch.testing.assert_close(with_peers((10, 5), (70, 50), (50, 60)), before)  # another order
    assert not torch.allclose(with_peers((50, 60), (50, 30), (50, 20)), before, atol=1e-4)
    none = network_of(replace(PLUS, peers=0))
    rows = [
        log_probs(none, BatchMission(ScenarioBatch.of([replace(scenario, robot_xy=places)])))
        for places in (np.full((4, 2), 50.0), np.array([(50.0, 50.0), (1, 1), (2, 90), (90, 3)]))
    ]
    torch.testing.assert_close(*rows)


def test_equally_near_peers_are_chosen_by_what_they_are() -> None:
    network = network_of(replace(PLUS, peers=1))
    peers = np.array([(40.0, 50), (60, 50), (50, 40), (50, 60)])  # all 10 away
    base = UniformGenerator(tasks=(8, 8), robots=(5, 5), deadline=(300, 500))(np.random.default_rng(0))
    rows = []
    for order in ([0, 1, 2, 3], [3, 2, 1, 0], [2, 0, 3, 1]):
        places = np.concatenate((np.array([(50.0, 50.0)]), peers[order]))
        scenario = replace(base, robot_xy=places, capacity=np.ones(5), speed=np.ones(5))
        rows.append(log_probs(network, BatchMission(ScenarioBatch.of([scenario]))))
    torch.testing.assert_close(rows[1], rows[0])
    torch.testing.assert_close(rows[2], rows[0])


@pytest.mark.parametrize("encoder", ["capsule", "attention", "none"])
def test_padding_of_observations_changes_nothing(encoder: str) -> None:
    """In observations, robots that do not exist have speed and capacity 0; tasks here may need no work, or no way."""
    network = network_of(replace(PLUS, encoder=encoder, candidates=6, peers=3))
    decided = 0
    for seed, scenario in enumerate(seeded_scenarios(3, 25)):
        env = mrta_v0.raw_env(scenario=scenario, max_tasks=15, max_robots=6)
        env.reset()
        mission, choose = BatchMission(ScenarioBatch.of([scenario])), seeded_chooser(seed)
        while not mission.done.all() and decided < 8 * (seed + 1):
            observation = env.last()[0]
            with torch.no_grad():
                encoding = network.encode(Tasks.of_observations([observation]))
                seen = network(encoding, DecisionStates.of_observations([observation]))[0, 0]  # type: ignore[arg-type]
            assert torch.isneginf(seen[scenario.num_tasks :]).all()
            of_batch = log_probs(network, mission)[0]
            torch.testing.assert_close(seen[: scenario.num_tasks], of_batch, rtol=1e-4, atol=1e-4)
            action = choose(mission.mask()[0].numpy())
            env.step(action)
            mission.step(torch.tensor([action]))
            decided += 1
    assert decided > 50


def test_where_a_mission_is_over_nothing_is_likelier_and_gradients_are_finite() -> None:
    other = replace(SCENARIO, deadline=np.full(4, 1.0))  # nobody can do anything
    mission = BatchMission(ScenarioBatch.of([SCENARIO, other]))
    assert mission.done.tolist() == [False, True]
    network = network_of(PLUS)
    rows = network(network.encode(Tasks.of_batch(mission.scenarios)), DecisionStates.of_batch(mission))[:, 0]  # type: ignore[arg-type]
    torch.testing.assert_close(rows[1], torch.full((4,), 1 / 4).log())
    (rows[0, 1] + rows[1].sum()).backward()
    gradients = [p.grad for p in network.parameters() if p.grad is not None]
    assert gradients
    assert all(torch.isfinite(each).all() for each in gradients)


def test_prospects_in_the_middle_of_missions() -> None:
    """Against the same computed task by task, in the scenario's own units, with robots under way and time gone by."""
    checked = first = 0
    for scenario in seeded_scenarios(77, 400):
        if scenario.num_tasks < 4 or scenario.num_robots < 2:
            continue
        mission, choose = BatchMission(ScenarioBatch.of([scenario])), seeded_chooser(scenario.num_tasks)
        for _ in range(scenario.num_tasks // 2):
            if bool(mission.done.all()):
                break
            mission.step(torch.tensor([choose(mission.mask()[0].numpy())]))
        if bool(mission.done.all()):
            continue
        found, scales = candidates(mission, most_tasks=3, most_peers=99), Scales.of(scenario)
        ego, now = int(mission.actor[0]), float(mission.time[0])
        if now > scales.time:  # what is later shows as this
            continue
        crossing = scales.length / scales.speed
        position, ready = mission.position[0].numpy(), mission.ready[0].numpy()
        mask = mission.mask()[0].numpy()

        def way(a: np.ndarray, b: np.ndarray, robot: int, of: Scenario = scenario, scales: Scales = scales) -> float:
            return float(np.hypot(*(a - b)) / min(of.speed[robot], scales.speed))

        def work(task: int, robot: int = ego, of: Scenario = scenario, scales: Scales = scales) -> float:
            return float(min(of.workload[task], scales.work) / min(of.capacity[robot], scales.capacity))

        peers = [m for m in range(scenario.num_robots) if m != ego and not bool(mission.retired[0, m])]
        for place, task in enumerate(found.index[0, 0].tolist()):
            if not found.valid[0, 0, place]:
                continue
            free = now + way(position[ego], scenario.task_xy[task], ego) + work(task)
            counts, close = dict.fromkeys(PROSPECT_COLUMNS, 0.0), False
            for other in np.flatnonzero(mask).tolist():
                if other == task:
                    continue
                travel = way(scenario.task_xy[task], scenario.task_xy[other], ego)
                arrival, deadline = free + travel, min(scenario.deadline[other], scales.time)
                rival = min(
                    (max(ready[m], now) + way(position[m], scenario.task_xy[other], m) for m in peers), default=np.inf
                )
                close |= min(abs(arrival + work(other) - deadline), abs(arrival - rival)) < 1e-4 * crossing
                if arrival + work(other) > deadline:
                    continue
                for name, scale in (("near", 0.1), ("far", 0.3)):
                    weight = float(np.exp(-(travel + work(other)) / crossing / scale))
                    counts[name] += weight
                    counts[f"{name}_first"] += weight * (arrival <= rival)
            if close:  # to a bound, where rounding decides
                continue
            for name, count in counts.items():
                value = float(found.task[0, 0, place, TASK_COLUMNS.index(name)])
                assert value == pytest.approx(np.log1p(count) / 3, rel=1e-3, abs=1e-4), (scenario.name, task, name)
            checked += 1
            first += 0 < counts["far_first"] < counts["far"]
    assert checked > 100
    assert first > 10
