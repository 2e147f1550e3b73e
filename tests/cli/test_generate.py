"""The command ``mrta-zoo generate``."""

from __future__ import annotations

from pathlib import Path

from mrta_zoo.cli.main import main
from mrta_zoo.io import read_cases
from mrta_zoo.scenario import Scenario


def test_generate_is_fixed_by_its_seed(tmp_path: Path) -> None:
    def drawn(name: str, *flags: str) -> list[Scenario]:
        line = "generate --generator uniform --format json --tasks 3-9 --out"
        main([*line.split(), str(tmp_path / name), *flags])
        return [case.scenario for case in read_cases(tmp_path / name)]

    three = drawn("a", "--count", "3", "--seed", "5")
    assert three == drawn("b", "--count", "3", "--seed", "5")
    assert three == drawn("c", "--count", "9", "--seed", "5")[:3]
    assert three != drawn("d", "--count", "3", "--seed", "6")
    assert len({scenario.num_tasks for scenario in drawn("e", "--count", "12")}) > 1


def test_generate_takes_bounds(tmp_path: Path) -> None:
    flags = "--generator uniform --format json --robots 3 --map 50-20 --speed 0.5-1.5 --capacity 2 --deadline 10-12.5"
    assert main(["generate", "--out", str(tmp_path / "cases"), "--count", "4", *flags.split()]) == 0
    for case in read_cases(tmp_path / "cases"):
        scenario = case.scenario
        assert (scenario.num_tasks, scenario.num_robots, scenario.map_size) == (100, 3, (50, 20))
        assert 0.5 <= scenario.speed.min() < scenario.speed.max() <= 1.5
        assert (scenario.capacity == 2).all()
        assert 10 <= scenario.deadline.min() < scenario.deadline.max() <= 12.5
