"""An upper bound on the number of tasks that any plan can complete, from a linear program."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import numpy.typing as npt

from mrta_zoo.policies.classical.exact.task_sets import ROUNDING
from mrta_zoo.policies.interruption import interruptible
from mrta_zoo.policies.stop import TimeLimit
from mrta_zoo.reach import first_finish
from mrta_zoo.rules import travel_time, visit
from mrta_zoo.scenario import FloatArray, Scenario

MOST_TASKS = 2000
"""With more tasks, those within reach are counted instead: all distances would take gigabytes."""
MOST_ENTRIES = 200_000
"""Of the linear program's matrix. Beyond that some deadlines are left out, which weakens the bound."""


def most_completable(scenario: Scenario, limit: TimeLimit | None = None) -> int:
    """An upper bound on the number of tasks that a plan completes.

    A task takes a robot at least the travel from the nearest place that it can come from, and the work. What a robot
    completes by a time D must fit between 0 and D, for each deadline D. Pooling robots of one kind, and letting tasks
    be done in parts, in any order and place, makes this a linear program. Any prices of its constraints prove a bound
    (weak duality), even if HiGHS finds them inexactly. Times have some slack for rounding.

    Args:
        scenario: the scenario.
        limit: after it the bound is the number of tasks within reach.
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
    return min(within_reach, _dual_bound(shares, np.isfinite(least), limit))


def _least_durations(
    scenario: Scenario, robots: npt.NDArray[np.intp], finish: FloatArray, latest: FloatArray
) -> FloatArray:
    """(N,) the least time that each task takes a robot of one kind; infinite if it is out of their reach.

    Args:
        scenario: the scenario.
        robots: the robots of that kind.
        finish: (N,) the earliest time at which one of them finishes each task as its first.
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
    """(K, N) for at most `most` deadlines: the least share of the robots' time until then that each task due by then
    takes."""
    deadlines = np.unique(latest[np.isfinite(least)])
    if len(deadlines) > most:
        deadlines = deadlines[np.linspace(len(deadlines) - 1, 0, most).round().astype(int)]
    counts = np.isfinite(least) & (latest <= deadlines[:, None])
    return np.where(counts, least / (robots * deadlines[:, None]), 0.0)


def _dual_bound(shares: list[FloatArray], possible: npt.NDArray[np.bool_], limit: TimeLimit | None) -> int:
    """The bound that the linear program's prices prove.

    Args:
        shares: for each kind of robot its rows of the program, see `_shares`.
        possible: (kinds, N) which tasks they can reach in time.
        limit: after it the bound is N.
    """
    from scipy.optimize import linprog
    from scipy.sparse import block_diag, eye_array, hstack, vstack

    num_tasks = possible.shape[1]
    once = hstack([eye_array(num_tasks)] * len(shares))
    matrix = vstack([block_diag(shares), once]).tocsr()[:, possible.ravel()]
    limits = np.ones(matrix.shape[0])
    program = partial(
        linprog, -np.ones(matrix.shape[1]), A_ub=matrix, b_ub=limits, bounds=(0, 1), method="highs",
        options={"time_limit": math.inf if limit is None else limit.left()},
    )  # fmt: skip
    found = interruptible(program)
    if found.status != 0:
        return int(num_tasks)
    prices = np.maximum(0.0, -found.ineqlin.marginals)
    worth = np.maximum(0.0, 1.0 - matrix.T @ prices)
    return math.floor(float(prices.sum() + worth.sum()) + 1e-6)
