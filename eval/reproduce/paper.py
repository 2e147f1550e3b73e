"""The paper's own numbers, to be held against ours.

Source: S. Paul, P. Ghassemi, S. Chowdhury, "Learning Scalable Policies over Graphs for Multi-Robot Task Allocation
using Capsule Attention Networks" (CapAM), ICRA 2022, tables II to IV. The methods are named as `policies.registry`
names ours.
"""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from mrta_zoo.eval.report.parts import Section, Table
from mrta_zoo.wording import counted

SOURCE = "Paul, Ghassemi and Chowdhury, ICRA 2022"

CAVEAT = (
    "The numbers of the paper stand here for orientation only and are no like-for-like comparison: its exact cases "
    "cannot be recovered, its implementation and machine were others, and its figures for 100 tasks cannot have been "
    "measured on the published TAPTC cases, for which they exceed what any known plan reaches (36.2 % with 2 robots "
    "and 94.8 % with 7, where PyVRP with 20 s a case reaches 34.3 % and 89.6 %)."
)

SECONDS = {"ils": 1.342, "eils": 0.992, "big-mrta": 0.301, "am": 0.086, "capam": 0.085}
"""Table II: seconds to plan a whole mission with 100 tasks, mean over 96 cases."""

P_VALUES = {
    "ils": {2: 2.03e-4, 3: 0.0307, 5: 0.024, 7: 0.025},
    "eils": {2: 0.002, 3: 0.079, 5: 0.163, 7: 0.049},
    "big-mrta": {2: 0.003, 3: 0.038, 5: 8.8e-4, 7: 0.003},
    "am": {2: 1.6e-11, 3: 2.4e-8, 5: 0.42, 7: 0.031},
}
"""Table III: p-values of paired t-tests of CapAM (P = 3) against each method, by number of robots; 100 tasks, 24 cases
each."""

COMPLETION = {
    "capam": {
        (100, 2): 34.6, (100, 3): 51.1, (100, 5): 74.9, (100, 7): 94.8,
        (200, 4): 28.2, (200, 6): 46.7, (200, 10): 67.8, (200, 14): 77.8,
    },
    "capam-p2": {
        (100, 2): 36.2, (100, 3): 50.3, (100, 5): 74.9, (100, 7): 94.1,
        (200, 4): 27.1, (200, 6): 47.0, (200, 10): 68.6, (200, 14): 77.5,
    },
    "capam-p1": {
        (100, 2): 32.6, (100, 3): 49.4, (100, 5): 73.2, (100, 7): 91.2,
        (200, 4): 24.4, (200, 6): 45.2, (200, 10): 66.5, (200, 14): 76.2,
    },
    "am": {
        (100, 2): 22.7, (100, 3): 38.0, (100, 5): 70.2, (100, 7): 85.6,
        (200, 4): 10.7, (200, 6): 29.4, (200, 10): 61.4, (200, 14): 74.3,
    },
}  # fmt: skip
"""Table IV: mean % of tasks completed, by number of tasks and robots; 24 cases each."""


def paper_section() -> Section:
    """The paper's tables II to IV."""
    seconds = pd.DataFrame([SECONDS]).reset_index(drop=True)
    tables = (
        Table(
            name="paper_seconds",
            caption=f"Table II ({SOURCE}): seconds to plan a mission with 100 tasks, mean over 96 cases.",
            shown=seconds.map(str),
            data=seconds,
        ),
        _by_robots(
            "paper_p_values",
            "Table III: p-values of paired t-tests of CapAM (P = 3) against each method on 24 cases each with 100 "
            "tasks, not adjusted. The paper gives no sizes of differences.",
            {(method, 100, robots): p for method, values in P_VALUES.items() for robots, p in values.items()},
        ),
        _by_robots(
            "paper_completion",
            "Table IV: tasks completed, mean %, 24 cases a number, without intervals.",
            {(method, *key): value for method, values in COMPLETION.items() for key, value in values.items()},
        ),
    )
    return Section(title="The paper’s numbers", text=(CAVEAT,), tables=tables)


def _by_robots(name: str, caption: str, values: Mapping[tuple[str, int, int], float]) -> Table:
    """A line for each method, a column for each number of tasks and robots."""
    lines: dict[str, dict[str, str]] = {}
    for (method, tasks, robots), value in values.items():
        line = lines.setdefault(method, {"method": method})
        line[f"{counted(tasks, 'task')}, {counted(robots, 'robot')}"] = f"{value:.3g}"
    data = pd.DataFrame(
        [(*key, value) for key, value in values.items()], columns=["method", "tasks", "robots", "value"]
    )
    return Table(name=name, caption=caption, shown=pd.DataFrame(list(lines.values())), data=data)
