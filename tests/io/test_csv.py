"""CSV scenarios: columns, ids, the map row and separate robots."""

from pathlib import Path

import numpy as np
import pytest

from mrta_zoo.generators import UniformGenerator
from mrta_zoo.io import read_scenario, write_scenario


def read(folder: Path, text: str, agents: str | None = None) -> object:
    (folder / "one.csv").write_bytes(text.encode())
    if agents is None:
        return read_scenario(folder / "one.csv")
    (folder / "robots.csv").write_text(agents)
    return read_scenario(folder / "one.csv", folder / "robots.csv")


FULL = """kind,x,y,deadline,workload,capacity,speed
map,10,20,,,,
task,1,2,30,0,,
task,3,4,50,6.5,,
robot,7,8,,,2,
robot,9,10,,,1,0.5
"""


@pytest.mark.parametrize("seed", range(5))
def test_round_trip_is_exact(tmp_path: Path, seed: int) -> None:
    generator = UniformGenerator(speed=(0.1, 3), map_size=(50.5, 200))
    scenario = generator(np.random.default_rng(seed), name="one")
    write_scenario(scenario, tmp_path / "one.csv")
    assert read_scenario(tmp_path / "one.csv") == scenario


def test_content(tmp_path: Path) -> None:
    (tmp_path / "one.csv").write_text(FULL)
    scenario = read_scenario(tmp_path / "one.csv")
    assert scenario.task_xy.tolist() == [[1, 2], [3, 4]]
    assert scenario.deadline.tolist() == [30, 50]
    assert scenario.workload.tolist() == [0, 6.5]
    assert scenario.robot_xy.tolist() == [[7, 8], [9, 10]]
    assert scenario.capacity.tolist() == [2, 1]
    assert scenario.speed.tolist() == [1, 0.5]
    assert scenario.map_size == (10, 20)
    assert scenario.name == "one"


@pytest.mark.parametrize(
    "text",
    [
        "\ufeff" + FULL.replace("\n", "\r\n"),
        FULL + "\n\n",
        FULL.replace(",", " , "),
        FULL.replace("task,1,", 'task,"1",'),
        # as spreadsheets leave rows and columns that something was deleted from
        ",,,,,,\n" + FULL.replace("robot,7", ',,,,,,\n , ,,,,,\n"","",,,,,""\nrobot,7') + ",,,,,,\n,,,,,,\n",
        FULL.replace("\n", ",,\n"),
        FULL.replace("\n", ', ,""\n') + ",,,,,,,,\n",
        FULL.replace("\n", "\n,").removesuffix(",").replace("kind", ",kind", 1),
        "\n".join(",".join([*line.split(",")[:3], " ", *line.split(",")[3:]]) for line in FULL.splitlines()),
        FULL.replace("task,3,4,50,6.5,,", "task,3,4,50,6.5,,,,"),
        "\ufeff" + FULL,
        # columns in another order, rows by id
        "id,speed,kind,y,x,capacity,workload,deadline\n"
        "1,,task,4,3,,6.5,50\n0,,task,2,1,,0,30\n,,map,20,10,,,\n1,0.5,robot,10,9,1,,\n0,,robot,8,7,2,,\n",
    ],
)
def test_other_ways_to_write_the_same(tmp_path: Path, text: str) -> None:
    assert read(tmp_path, text) == read(tmp_path, FULL)


def test_tasks_and_robots_in_two_files(tmp_path: Path) -> None:
    tasks = "kind,x,y,deadline,workload\ntask,1,2,30,0\ntask,3,4,50,6.5\n"
    robots = "kind,x,y,capacity,speed\nmap,10,20,,\nrobot,7,8,2,\nrobot,9,10,1,0.5\n"
    assert read(tmp_path, tasks, robots) == read(tmp_path, FULL)


@pytest.mark.parametrize(("largest", "side"), [("0", 1), ("0.5", 1), ("7", 7), ("7.25", 8), ("1e8", 1e8)])
def test_without_map_row_it_is_the_smallest_whole_square(tmp_path: Path, largest: str, side: float) -> None:
    (tmp_path / "one.csv").write_text(
        f"kind,x,y,deadline,workload,capacity,speed\ntask,0,0,1,0,,\nrobot,0,{largest},,,1,\n"
    )
    assert read_scenario(tmp_path / "one.csv").map_size == (side, side)
