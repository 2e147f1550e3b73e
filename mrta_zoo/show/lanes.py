"""Where the lines from the tasks of a schedule to their deadlines lie, such that none crosses another."""

from __future__ import annotations

from collections.abc import Sequence

from mrta_zoo.verify import Visit


def deadline_lanes(visits: Sequence[Visit]) -> list[int]:
    """The lane of each task's line from its finish to its deadline; see `lanes`.

    Lines of tasks done in time go on below the bars, their lanes counted from the bottom; those of late ones go back
    above the bars, their lanes counted from the top.

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
    """The lane for each of some lines side by side, such that none crosses another one, nor what leads down to it.

    A line begins under its start, to which something leads down through all lanes that lie higher.

    Args:
        starts: where lines begin, rising.
        ends: where they end, not before.

    Returns:
        For each line its lane, counted from the bottom.
    """
    found: list[int] = []
    below: list[float] = []  # where the lines end over which the next one lies
    for start, end in zip(starts, ends, strict=True):
        while below and below[-1] < start:
            below.pop()
        found.append(len(below))
        below.append(end)
    return found
