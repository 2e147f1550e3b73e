"""What has been measured, as the sections of the report read it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields

import numpy as np
import pandas as pd

from mrta_zoo.eval.rows import Row
from mrta_zoo.eval.significance import LEAST_OF_STRATUM, estimate_mean
from mrta_zoo.wording import counted

BOOTSTRAP = f"BCa bootstrap over cases, within numbers of robots that all have {LEAST_OF_STRATUM} cases or more"


@dataclass(frozen=True, slots=True)
class OptimalityRow(Row):
    """A row of a small scenario.

    Attributes:
        bound: the most tasks that any plan can complete, as the method has proved; None if it proves nothing.
    """

    bound: int | None = None


@dataclass(frozen=True, slots=True)
class Group:
    """Cases that are looked at together.

    Attributes:
        tasks: their number of tasks.
        robots: their number of robots, None for any.
    """

    tasks: int
    robots: int | None = None

    @property
    def label(self) -> str:
        """What a column or panel is called."""
        if self.robots is not None:
            return counted(self.robots, "robot")
        return f"all with {counted(self.tasks, 'task')}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Results:
    """Rows of all methods on all cases.

    Attributes:
        frame: the rows, in the order of cases and methods, with the columns `percent` of tasks completed and
            `group` (tasks, robots).
        methods: in the order in which they are shown.
        against: the method that the others are compared with.
        seed: of the bootstrap.
        best_known: the most tasks completed by anyone, by case, where a reference table says so.
        small: rows of the small scenarios, None if they have not been run.
        absent: methods that are usually there and are not, with the reason.
    """

    frame: pd.DataFrame
    methods: tuple[str, ...]
    against: str
    seed: int
    best_known: Mapping[str, int] = field(default_factory=dict)
    small: pd.DataFrame | None = None
    absent: Mapping[str, str] = field(default_factory=dict)

    @property
    def sizes(self) -> list[int]:
        """The numbers of tasks that occur."""
        return sorted(self.frame["tasks"].unique().tolist())

    def groups(self, tasks: int) -> list[Group]:
        """All cases with so many tasks, then those with each number of robots, if there are several."""
        robots = sorted(self.frame.loc[self.frame["tasks"] == tasks, "robots"].unique().tolist())
        return (
            [Group(tasks), *(Group(tasks, each) for each in robots)] if len(robots) > 1 else [Group(tasks, robots[0])]
        )

    def select(self, group: Group, method: str) -> pd.DataFrame:
        """A method's rows of a group of cases, in the order of the cases."""
        chosen = (self.frame["method"] == method) & (self.frame["tasks"] == group.tasks)
        if group.robots is not None:
            chosen &= self.frame["robots"] == group.robots
        return self.frame[chosen]

    def cases(self, group: Group) -> int:
        """Number of cases in a group."""
        return len(self.select(group, self.methods[0]))

    def estimates(self, tasks: int, column: str) -> pd.DataFrame:
        """The mean of a column for each group of the cases with so many tasks and each method, with its interval."""
        lines = []
        for group in self.groups(tasks):
            for method in self.methods:
                rows = self.select(group, method)
                found = estimate_mean(rows[column].to_numpy(float), self.seed, rows["group"].tolist())
                lines.append(
                    {
                        "method": method, "tasks": tasks, "robots": "all" if group.robots is None else group.robots,
                        "cases": found.n, **found.columns(f"mean_{column}"), "note": found.note, "estimate": found,
                    }
                )  # fmt: skip
        return pd.DataFrame(lines)


def frame_of(rows: Sequence[Row], cases: Sequence[str], methods: Sequence[str]) -> pd.DataFrame:
    """Rows as a frame in the order of cases and methods, whatever order they were measured in."""
    frame = pd.DataFrame([asdict(row) for row in rows], columns=[column.name for column in fields(rows[0])])
    case_order = {name: index for index, name in enumerate(cases)}
    method_order = {name: index for index, name in enumerate(methods)}
    frame = frame[frame["case"].isin(case_order) & frame["method"].isin(method_order)]
    order = np.lexsort((frame["method"].map(method_order), frame["case"].map(case_order)))
    frame = frame.iloc[order].reset_index(drop=True)
    return frame.assign(
        percent=100 * frame["completed"] / frame["tasks"],
        group=list(zip(frame["tasks"].tolist(), frame["robots"].tolist(), strict=True)),
    )
