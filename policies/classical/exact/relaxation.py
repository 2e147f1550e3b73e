"""An upper bound on the number of tasks that any plan can complete, from a linear program."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import numpy.typing as npt

from mrta_zoo.policies.classical.exact.task_sets import ROUNDING
from mrta_zoo.policies.interruption import interruptible
from mrta_zoo.reach import first_finish
from mrta_zoo.rules import travel_time, visit
from mrta_zoo.scenario import FloatArray, Scenario

MOST_TASKS = 2000
"""With more only those within reach are counted: all distances would take gigabytes."""
MOST_ENTRIES = 200_000
"""Of the linear program's matrix; beyond, some deadlines are left out, which weakens the bound."""


def most_completable(scenario: Scenario, seconds: float = math.inf) -> int:
    """A number of tasks that no plan can exceed.

    A task takes a robot at least the way from the nearest place that it can come from, and the work. What a robot
    completes by a time D must fit between 0 and D, for each deadline D. Robots that are alike are taken together, and
    tasks may be done in parts, in any order and place: a linear program. Any prices of its constraints prove a bound
    (weak duality); those that HiGHS finds need not be exact for that. Times have some slack for rounding.

    Args:
        scenario: the scenario.
        seconds: how long it may take; then the tasks within reach are counted.
    """
    finish = first_finish(scenario)
    latest = scenario.deadline * (1 + ROUNDING)
    within_reach = int(np.count_nonzero((finish <= latest).any(axis=0)))
    if within_reach == 0 or scenario.num_tasks > MOST_TASKS:
        return within_reach
    kinds, kind_of = np.unique(np.stack([scenario.capacity, scenario.speed], axis=1), axis=0, return_inverse=True)
    groups = [np.flatnonzero(kind_of == kind) for kind in range(len(kinds))]
    least = [_least_durations(scenario, robots, finish[robots].min(axis=0), latest) for robots in groups]
    most = max(1, MOST_ENTRIES // (len(groups) * scenario.num_tasks))
    shares = [_shares(each, latest, len(robots), most) for each, robots in zip(least, groups, strict=True)]
    return min(within_reach, _dual_bound(shares, np.isfinite(least), seconds))


def _least_durations(
    scenario: Scenario, robots: npt.NDArray[np.intp], finish: FloatArray, latest: FloatArray
) -> FloatArray:
    """(N,) the least time that each task takes one of `robots`, which are alike; infinite if it is out of their reach.

    Args:
        scenario: the scenario.
        robots: which.
        finish: (N,) when one of them finishes each task at the earliest, as its first.
        latest: (N,) deadlines with slack.
    """
    speed, capacity = scenario.speed[robots[0]], scenario.capacity[robots[0]]
    x, y = scenario.task_xy.T
    travel = travel_time(x[None, :] - x[:, None], y[None, :] - y[:, None], speed, np.sqrt)
    work = scenario.workload / capacity
    in_time = visit(finish[:, None], travel, work).finishes <= latest
    np.fill_diagonal(in_time, False)
    from_task = np.where(in_time & (finish <= latest)[:, None], travel, np.inf).min(axis=0) + work
    return np.where(finish <= latest, np.minimum(finish, from_task), np.inf)


def _shares(least: FloatArray, latest: FloatArray, robots: int, most: int) -> FloatArray:
    """(K, N) for at most `most` of the deadlines: the share of the robots' time until then that each task due by then
    takes at least."""
    deadlines = np.unique(latest[np.isfinite(least)])
    if len(deadlines) > most:
        deadlines = deadlines[np.linspace(len(deadlines) - 1, 0, most).round().astype(int)]
    counts = np.isfinite(least) & (latest <= deadlines[:, None])
    return np.where(counts, least / (robots * deadlines[:, None]), 0.0)


def _dual_bound(shares: list[FloatArray], possible: npt.NDArray[np.bool_], seconds: float) -> int:
    """The bound that the linear program's prices prove.

    Args:
        shares: for each kind of robot its rows of the program, see `_shares`.
        possible: (kinds, N) which tasks they can reach in time.
        seconds: how long it may take; then the bound is N.
    """
    from scipy.optimize import linprog
    from scipy.sparse import block_diag, eye_array, hstack, vstack

    num_tasks = possible.shape[1]
    once = hstack([eye_array(num_tasks)] * len(shares))
    matrix = vstack([block_diag(shares), once]).tocsr()[:, possible.ravel()]
    limits = np.ones(matrix.shape[0])
    program = partial(
        linprog, -np.ones(matrix.shape[1]), A_ub=matrix, b_ub=limits, bounds=(0, 1), method="highs",
        options={"time_limit": seconds},
    )  # fmt: skip
    found = interruptible(program)
    if found.status != 0:
        return int(num_tasks)
    prices = np.maximum(0.0, -found.ineqlin.marginals)
    worth = np.maximum(0.0, 1.0 - matrix.T @ prices)
    return math.floor(float(prices.sum() + worth.sum()) + 1e-6)
