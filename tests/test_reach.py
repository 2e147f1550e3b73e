"""What robots could do first, by hand."""

from __future__ import annotations

from mrta_zoo.reach import first_finish, in_time
from mrta_zoo.scenario import Scenario

# Robots at 0 and 10 on a line, the second of speed 2 and capacity 4.
SCENARIO = Scenario(
    task_xy=[[4, 0], [10, 0]], deadline=[12, 9], workload=[8, 4],
    robot_xy=[[0, 0], [10, 0]], capacity=[1, 4], speed=[1, 2], map_size=(10, 10),
)  # type: ignore[arg-type]  # fmt: skip


def test_by_hand() -> None:
    # Robot 0: 4 of way and 8 of work, just in time; 10 and 4. Robot 1: 6 / 2 and 8 / 4; no way and 4 / 4.
    assert first_finish(SCENARIO).tolist() == [[12, 14], [5, 1]]
    assert first_finish(SCENARIO, [1]).tolist() == [[5, 1]]
    assert in_time(SCENARIO).tolist() == [[True, False], [True, True]]
