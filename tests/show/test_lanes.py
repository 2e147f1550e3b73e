"""Lines from tasks to their deadlines do not cross."""

from __future__ import annotations

import numpy as np

from mrta_zoo.show.lanes import deadline_lanes, lanes
from mrta_zoo.verify import Visit


def test_ways_to_deadlines_do_not_cross() -> None:
    assert lanes([1, 2, 3, 6], [5, 4, 9, 7]) == [0, 1, 2, 3]  # all side by side; the fourth begins under the third's
    assert lanes([1, 2, 5, 6], [3, 9, 9, 7]) == [0, 1, 2, 3]
    assert lanes([1, 4, 6], [3, 9, 7]) == [0, 0, 1]  # the first has ended when the second begins
    rng = np.random.default_rng(0)
    starts = np.sort(rng.random(60)) * 100
    ends = starts + rng.exponential(20, 60)
    found = lanes(starts.tolist(), ends.tolist())
    for one in range(60):
        for other in range(one + 1, 60):
            if starts[other] <= ends[one]:  # what leads down to the other one must not meet this one
                assert found[other] > found[one]


def test_late_tasks_have_their_lines_on_the_other_side() -> None:
    visits = [
        Visit(0, 0, 10, 5, False),
        Visit(1, 15, 20, 90, True),
        Visit(2, 25, 30, 8, False),
        Visit(3, 35, 40, 50, True),
    ]
    # Task 2's line goes back from 30 to 8, under which task 0 finishes at 10: task 0's lies nearer to the bars.
    assert deadline_lanes(visits) == [1, 0, 0, 1]
    assert deadline_lanes([]) == []
