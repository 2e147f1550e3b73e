"""The built-in suite must be the same for everyone, always."""

import hashlib

import numpy as np

from mrta_zoo.suite import builtin_suite


def test_names_and_shapes() -> None:
    suite = builtin_suite()
    names = [scenario.name for scenario in suite]
    assert len(names) == len(set(names)) == 96
    assert names[:4] == ["r11a2i00", "r11a2i01", "r11a2i02", "r11a3i00"]
    assert names[-1] == "r24a7i02"
    for scenario in suite:
        assert scenario.num_tasks == 100
        assert scenario.num_robots == int(scenario.name[4])
        latest = scenario.deadline.max()
        slack, quarters = scenario.name[1] == "2", int(scenario.name[2])
        if quarters < 4:
            assert 250 * (1 + slack) <= latest <= 300 * (1 + slack)
            assert abs(np.sum(scenario.deadline < latest) - 25 * quarters) <= 1
        else:
            assert latest <= 300 * (1 + slack)


def test_never_changes() -> None:
    """A different hash means that results on the suite can no longer be compared with published ones."""
    digest = hashlib.sha256()
    for scenario in builtin_suite():
        digest.update(scenario.name.encode())
        for array in (
            scenario.task_xy, scenario.deadline, scenario.workload,
            scenario.robot_xy, scenario.capacity, scenario.speed, np.array(scenario.map_size),
        ):  # fmt: skip
            digest.update(array.astype("<f8").tobytes())
    assert digest.hexdigest() == "8ced5b61e452bd9c8b3231fa06e46427ecc0951b81280c1fdf2c210fda3cde94"
