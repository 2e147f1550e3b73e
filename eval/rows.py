"""One line for each method and case: the data behind every table and figure."""

from __future__ import annotations

from dataclasses import dataclass, fields

from mrta_zoo.digits import full
from mrta_zoo.show.markup import table

KEY = ("case", "method")
"""The columns that tell rows apart."""


@dataclass(frozen=True, slots=True)
class Row:
    """What a method reached on a case. All scores are the verifier's, see `verify.Score`.

    Attributes:
        case: name of the case.
        method: the method, as it was asked for.
        tasks: number of tasks.
        robots: number of robots.
        completed: tasks finished by their deadline.
        completion: completed / tasks, 0 to 1.
        cost: the objective, Eq. 1 of the paper.
        distance: travelled by all robots together, in distance units.
        makespan: the latest finish, in time units.
        seconds: wall-clock time it took to plan.
    """

    case: str
    method: str
    tasks: int
    robots: int
    completed: int
    completion: float
    cost: float
    distance: float
    makespan: float
    seconds: float

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        values = ((each.name, getattr(self, each.name)) for each in fields(self))
        rows = [(name, full(value) if isinstance(value, float) else value) for name, value in values]
        return table(f"{self.method} on {self.case}", ("", ""), rows)
