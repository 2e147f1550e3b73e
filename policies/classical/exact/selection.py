"""The choice of a set of tasks for each robot, so that together they hold the most tasks: an integer program."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial

import numpy as np

from mrta_zoo.policies.classical.exact.task_sets import IntArray
from mrta_zoo.policies.interruption import interruptible
from mrta_zoo.policies.stop import TimeLimit


@dataclass(frozen=True, slots=True)
class Team:
    """Identical robots, and the routes from which each may take one.

    Attributes:
        robots: their numbers.
        routes: (S, L) tasks in order, padded with -1.
    """

    robots: list[int]
    routes: IntArray


@dataclass(frozen=True, slots=True)
class Selection:
    """The sets selected, and how good a selection can be.

    Attributes:
        routes: the tasks of each robot that got a route.
        bound: the most tasks that any selection can hold, as far as was proven.
    """

    routes: dict[int, list[int]]
    bound: int


def select_sets(teams: list[Team], num_tasks: int, *, disjoint: bool, limit: TimeLimit) -> Selection:
    """The selection that holds the most tasks, by HiGHS.

    Args:
        teams: what each team of robots can choose from.
        num_tasks: N, the number of tasks.
        disjoint: whether the sets must have no task in common; otherwise a task in several of them counts once.
        limit: of HiGHS; if it is too short, the selection may be worse or empty, and the bound higher.
    """
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import csr_array

    num_sets = sum(len(team.routes) for team in teams)
    if num_sets == 0 or limit.over:
        return Selection({}, num_tasks if num_sets else 0)
    # Variables: for each task whether it is done, then for each set whether it is selected.
    # Rows: for each task the selected sets that hold it, less whether it is done; then for each team its selected sets.
    done = np.arange(num_tasks)
    team_of = np.repeat(np.arange(len(teams)), [len(team.routes) for team in teams])
    sets, tasks = _entries(teams)
    rows = np.concatenate([done, tasks, num_tasks + team_of])
    columns = np.concatenate([done, num_tasks + sets, num_tasks + np.arange(num_sets)])
    values = np.where(np.arange(len(rows)) < num_tasks, -1.0, 1.0)
    shape = (num_tasks + len(teams), num_tasks + num_sets)
    most = [0.0 if disjoint else math.inf] * num_tasks + [float(len(team.robots)) for team in teams]
    is_set = np.arange(shape[1]) >= num_tasks
    program = partial(
        milp,
        np.where(is_set, 0.0, -1.0),
        integrality=is_set.astype(int),  # whether a task is done follows
        bounds=Bounds(0, 1),
        constraints=LinearConstraint(csr_array((values, (rows, columns)), shape=shape), 0.0, most),
        options={"time_limit": limit.left(), "mip_rel_gap": 0.0},
    )
    found = interruptible(program)
    bound = num_tasks
    if found.mip_dual_bound is not None and math.isfinite(found.mip_dual_bound):
        bound = min(bound, math.floor(-found.mip_dual_bound + 1e-4))
    selected = [] if found.x is None else np.flatnonzero(found.x[num_tasks:] > 0.5).tolist()
    return Selection(_assigned(teams, selected), bound)


def _entries(teams: list[Team]) -> tuple[IntArray, IntArray]:
    """For each task of each set the numbers of both, with sets numbered through all teams."""
    sets, tasks, before = [], [], 0
    for team in teams:
        rows, places = np.nonzero(team.routes >= 0)
        sets.append(rows + before)
        tasks.append(team.routes[rows, places])
        before += len(team.routes)
    return np.concatenate(sets), np.concatenate(tasks)


def _assigned(teams: list[Team], selected: list[int]) -> dict[int, list[int]]:
    """The selected sets as routes, one for each robot, in order."""
    routes: dict[int, list[int]] = {}
    before = 0
    for team in teams:
        own = [index - before for index in selected if before <= index < before + len(team.routes)]
        for robot, index in zip(team.robots, own, strict=False):
            routes[robot] = [task for task in team.routes[index].tolist() if task >= 0]
        before += len(team.routes)
    return routes
