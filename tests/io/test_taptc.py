"""TAPTC text files: what is read, where the agent file is found, and what is written."""

import os
from pathlib import Path

import numpy as np
import pytest

from mrta_zoo import Scenario
from mrta_zoo.errors import ScenarioError
from mrta_zoo.io import read_cases, read_scenario, write_scenario, write_taptc
from mrta_zoo.io.taptc import find_agent_file

TASKS = "2 3 100 50\n0 1 2 20 255\n2 5.5 6 0 30\n1 3 4 20.25 1e2"
AGENTS = "2 100 50\n1 7 8 1.0\n0 9 10 2.0"


def lay_out(folder: Path, files: dict[str, str | bytes]) -> Path:
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder


def check_content(scenario: Scenario) -> None:
    # Lines may come in any order; the id is the index.
    assert scenario.task_xy.tolist() == [[1, 2], [3, 4], [5.5, 6]]
    assert scenario.workload.tolist() == [20, 20.25, 0]
    assert scenario.deadline.tolist() == [255, 100, 30]
    assert scenario.robot_xy.tolist() == [[9, 10], [7, 8]]
    assert scenario.capacity.tolist() == [2, 1]
    assert scenario.speed.tolist() == [1, 1]
    assert scenario.map_size == (100, 50)
    assert scenario.name == "r11a2i00"


@pytest.mark.parametrize(
    "tasks",
    [
        TASKS,
        TASKS.removeprefix("2 "),  # header of three numbers, without the number of agents
        TASKS + "\n",
        TASKS + "\n\n  \n\n",
        TASKS.replace("\n", "\r\n"),
        TASKS.replace("\n", "\r\n") + "\r\n\r\n",
        "\ufeff" + TASKS,
        TASKS.replace(" ", "\t"),
        TASKS.replace("\n", " \n "),
    ],
)
def test_reads_all_layouts(tmp_path: Path, tasks: str) -> None:
    lay_out(tmp_path, {"group1/r11a2i00.txt": tasks, "agent/a2i00.txt": AGENTS})
    check_content(read_scenario(tmp_path / "group1/r11a2i00.txt"))


@pytest.mark.parametrize(
    "agent", ["agent/r11a2i00.txt", "agent/a2i00.txt", "group1/agent/r11a2i00.txt", "group1/agent/a2i00.txt"]
)
def test_finds_agent_file(tmp_path: Path, agent: str) -> None:
    lay_out(tmp_path, {"group1/r11a2i00.txt": TASKS, agent: AGENTS})
    assert find_agent_file(tmp_path / "group1/r11a2i00.txt") == tmp_path / agent
    check_content(read_scenario(tmp_path / "group1/r11a2i00.txt"))


def test_agent_file_of_same_name_comes_first(tmp_path: Path) -> None:
    files = {"group1/r11a2i00.txt": TASKS, "agent/r11a2i00.txt": AGENTS, "agent/a2i00.txt": "1 1 1\n0 0 0 1"}
    check_content(read_scenario(lay_out(tmp_path, files) / "group1/r11a2i00.txt"))


def test_finds_agent_file_from_inside_the_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lay_out(tmp_path, {"group1/r11a2i00.txt": TASKS, "agent/a2i00.txt": AGENTS})
    monkeypatch.chdir(tmp_path / "group1")
    check_content(read_scenario("r11a2i00.txt"))


def test_agents_option_wins(tmp_path: Path) -> None:
    files = {"r11a2i00.txt": TASKS, "agent/a2i00.txt": "1 1 1\n0 0 0 1", "mine.dat": AGENTS}
    lay_out(tmp_path, files)
    check_content(read_scenario(tmp_path / "r11a2i00.txt", agents=tmp_path / "mine.dat"))
    check_content(read_scenario(tmp_path / "r11a2i00.txt", tmp_path / "mine.dat"))


def test_missing_agent_file_says_what_was_looked_for(tmp_path: Path) -> None:
    lay_out(tmp_path, {"group1/r11a2i00.txt": TASKS})
    with pytest.raises(ScenarioError) as caught:
        read_scenario(tmp_path / "group1/r11a2i00.txt")
    for sought in ("agent/r11a2i00.txt", "agent/a2i00.txt", "group1/agent/a2i00.txt", "--agents"):
        assert sought in str(caught.value)


@pytest.mark.parametrize("seed", range(5))
def test_round_trip(tmp_path: Path, seed: int) -> None:
    rng = np.random.default_rng(seed)
    scenario = Scenario(
        task_xy=rng.uniform(0, 7.3, (4, 2)),
        deadline=10.0 ** rng.uniform(-9, 9, 4),
        workload=[0, 20, 1 / 3, 1e8],  # type: ignore[arg-type]
        robot_xy=rng.integers(0, 7, (3, 2)),
        capacity=rng.uniform(1, 3, 3),
        map_size=(7.3, 8),
        name="one",
    )
    write_taptc(scenario, tmp_path / "one.txt", tmp_path / "robots.txt")
    assert read_scenario(tmp_path / "one.txt", tmp_path / "robots.txt") == scenario
    write_scenario(scenario, tmp_path / "one.txt")
    assert read_scenario(tmp_path / "one.txt") == scenario
    assert sorted(path.name for path in tmp_path.iterdir()) == ["agent", "one.txt", "robots.txt"]


def test_refuses_speeds(tmp_path: Path) -> None:
    scenario = Scenario([[1, 1]], [5], [1], [[0, 0], [1, 1]], [1, 1], [1, 1.5])  # type: ignore[arg-type]
    with pytest.raises(ScenarioError, match=r"robot 1 has speed 1.5; expected 1"):
        write_scenario(scenario, tmp_path / "one.txt")
    assert not (tmp_path / "one.txt").exists()


PUBLISHED = Path(os.environ.get("MRTA_ZOO_TAPTC", Path(__file__).parents[3] / "shared" / "taptc"))


@pytest.mark.skipif(not PUBLISHED.is_dir(), reason="the published TAPTC cases are not here")
@pytest.mark.parametrize(("folder", "tasks", "robots"), [("n100", 100, {2, 3, 5, 7}), ("n200", 200, {4, 6, 10, 14})])
def test_published_cases(folder: str, tasks: int, robots: set[int]) -> None:
    cases = read_cases(PUBLISHED / folder)
    assert len(cases) == 32
    for case in cases:
        assert case.scenario.num_tasks == tasks
        assert case.scenario.num_robots == int(case.name.partition("a")[2].partition("i")[0])
        assert set(case.scenario.workload) == {20}
        assert case.best_known is not None
        assert case.best_known <= tasks
    assert {case.scenario.num_robots for case in cases} == robots
