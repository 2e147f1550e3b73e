"""A plan: for each robot the tasks it does, in order. The common currency of all solvers and policies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from operator import index


@dataclass(frozen=True, slots=True)
class Plan:
    """Who does what, in which order.

    Attributes:
        routes: one tuple of task indices for each robot of the scenario; empty if the robot stays where it is.
        scenario: name of the scenario it was made for.
        method: name of the method that made it.
        bound: the most tasks that any plan can complete, as the method has proven; None if it proved nothing.
    """

    routes: tuple[tuple[int, ...], ...]
    scenario: str = ""
    method: str = ""
    bound: int | None = None

    @classmethod
    def of(cls, routes: Sequence[Sequence[int]], scenario: str = "", method: str = "") -> Plan:
        """A plan from any nested sequence of whole numbers; a TypeError if they are not."""
        return cls(tuple(tuple(index(task) for task in route) for route in routes), scenario, method)
