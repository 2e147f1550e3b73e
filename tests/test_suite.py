"""The built-in suites must be the same for everyone, always."""

from __future__ import annotations

import hashlib
from collections.abc import Callable

import numpy as np
import pytest

from mrta_zoo.scenario import Scenario
from mrta_zoo.suite import builtin_suite, double_suite, small_suite

Suite = Callable[[], list[Scenario]]


@pytest.mark.parametrize(
    ("make", "tasks", "robots"), [(builtin_suite, 100, (2, 3, 5, 7)), (double_suite, 200, (4, 6, 10, 14))]
)
def test_names_and_shapes(make: Suite, tasks: int, robots: tuple[int, ...]) -> None:
    suite = make()
    names = [scenario.name for scenario in suite]
    few, more = robots[:2]
    assert len(names) == len(set(names)) == 96
    assert names[:4] == [f"r11a{few}i00", f"r11a{few}i01", f"r11a{few}i02", f"r11a{more}i00"]
    assert names[-1] == f"r24a{robots[-1]}i02"
    for scenario in suite:
        assert scenario.num_tasks == tasks
        assert scenario.num_robots == int(scenario.name[4:].split("i")[0])
        latest = scenario.deadline.max()
        slack, quarters = scenario.name[1] == "2", int(scenario.name[2])
        if quarters < 4:
            assert 250 * (1 + slack) <= latest <= 300 * (1 + slack)
            assert abs(np.sum(scenario.deadline < latest) - tasks / 4 * quarters) <= 1
        else:
            assert latest <= 300 * (1 + slack)


def test_small_scenarios() -> None:
    suite = small_suite()
    assert len({scenario.name for scenario in suite}) == len(suite) == 60
    for scenario in suite:
        assert scenario.name.startswith(f"s{scenario.num_tasks}a{scenario.num_robots}i0")
        assert 5 <= scenario.num_tasks <= 9
        assert 1 <= scenario.num_robots <= 3


@pytest.mark.parametrize(
    ("make", "expected"),
    [
        (builtin_suite, "8ced5b61e452bd9c8b3231fa06e46427ecc0951b81280c1fdf2c210fda3cde94"),
        (double_suite, "b752af94f2585f08eb8b0feb11ef5b293a4342445f3e5eb24370e4d71dbcca8d"),
        (small_suite, "b64e5ced31ddcf468ec978496d7f226a4077db593b98151dd4cafd0d963c803c"),
    ],
)
def test_never_changes(make: Suite, expected: str) -> None:
    """A different hash means that results on the suite can no longer be compared with published ones."""
    digest = hashlib.sha256()
    for scenario in make():
        digest.update(scenario.name.encode())
        for array in (
            scenario.task_xy, scenario.deadline, scenario.workload,
            scenario.robot_xy, scenario.capacity, scenario.speed, np.array(scenario.map_size),
        ):  # fmt: skip
            digest.update(array.astype("<f8").tobytes())
    assert digest.hexdigest() == expected
