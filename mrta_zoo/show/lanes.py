"""Lanes in the chart of a schedule, in which lines from tasks to their deadlines run without crossing."""

from __future__ import annotations

from collections.abc import Sequence

from mrta_zoo.verify import Visit


def deadline_lanes(visits: Sequence[Visit]) -> list[int]:
    """The lane of each task's line from its finish to its deadline; see `lanes`.

    The lines of tasks done in time run forwards below the bars, in lanes counted from the bottom; those of late tasks
    run back above the bars, in lanes counted from the top.

    Args:
        visits: a robot's, in order.
    """
    found = [0] * len(visits)
    in_time = [index for index, visit in enumerate(visits) if visit.completed]
    late = [index for index, visit in enumerate(visits) if not visit.completed][::-1]
    for sign, which in ((1.0, in_time), (-1.0, late)):
        starts = [sign * visits[index].finish for index in which]
        ends = [sign * visits[index].deadline for index in which]
        for index, lane in zip(which, lanes(starts, ends), strict=True):
            found[index] = lane
    return found


def lanes(starts: Sequence[float], ends: Sequence[float]) -> list[int]:
    """A lane for each line, so that no line crosses another, nor the connector that leads down to another's start.

    The connector of a line leads down to its start through all higher lanes.

    Args:
        starts: where the lines start, ascending.
        ends: where they end, not before they start.

    Returns:
        For each line its lane, counted from the bottom.
    """
    found: list[int] = []
    below: list[float] = []  # where the lines end that lie below the next one
    for start, end in zip(starts, ends, strict=True):
        while below and below[-1] < start:
            below.pop()
        found.append(len(below))
        below.append(end)
    return found
