"""A plan: for each robot the tasks it does, in order. The common currency of all solvers and policies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from operator import index

from mrta_zoo.counted import counted
from mrta_zoo.html import in_order, table


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

    def _repr_html_(self) -> str:
        """What a notebook shows: each robot's tasks, in order."""
        of = f" of {self.scenario}" if self.scenario else ""
        by = f" by {self.method}" if self.method else ""
        rows = [(robot, len(route), in_order(route) or "-") for robot, route in enumerate(self.routes)]
        return table(
            f"Plan{of}{by}: {counted(sum(map(len, self.routes)), 'task')} taken",
            ("robot", "tasks", "in this order"),
            rows,
        )
