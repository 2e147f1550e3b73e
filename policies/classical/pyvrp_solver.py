"""PyVRP, an open-source solver of vehicle routing problems, as a strong reference.

Wouda, Lan and Kool, "PyVRP: a high-performance VRP solver package", INFORMS Journal on Computing 36 (2024).
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from mrta_zoo.bounds import check_seed
from mrta_zoo.errors import ConfigError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.drop_late import Routes, drop_late
from mrta_zoo.policies.classical.exact.task_sets import IntArray, within_reach
from mrta_zoo.policies.stop import TimeLimit, check_budget
from mrta_zoo.reach import in_time
from mrta_zoo.rules import travel_time
from mrta_zoo.scales import frame_of, slack_time, useful_robots
from mrta_zoo.scenario import Scenario

BUDGET = 5.0
RESOLUTION = 10**7
"""Model time units until the latest deadline, or until the time beyond which no deadline binds."""
LATEST = 4.0
"""Deadlines are cut at this many times `mrta_zoo.scales.slack_time`, beyond which they cannot bind."""
WARPS = (2e-5, 2e-6, 2e-4)
"""Largest penalty of a model time unit of lateness, in prizes. The search starts at half of it and adapts it, so that
it passes through late plans but also finds plans in time. The first value is the best for large scenarios; a search
that starts again tries the others in turn."""
NEIGHBOURS = 20
PATIENCE = 2
"""Iterations without improvement per pair of tasks before the search starts again; further ones hardly find any."""
SEARCHES = 20
"""Most searches per mission."""


class PyVrpSolver:
    """Models the mission exactly, as a prize-collecting vehicle routing problem with time windows.

    Every robot is a vehicle type of its own. It starts at its own depot and ends at a dummy depot, to which travel is
    free. The duration to a task is travel and work, at the robot's own speed and capacity. Each task is an optional
    client with a deadline and a prize. Travel time costs as well: the search needs it to tell routes with equally many
    tasks apart, and finds far more tasks with it. The prize is larger than all that robots can travel in time, so that
    one more task is always worth it.

    No task is planned to end later than `LATEST` times the time by which all that can wait could be done. This costs no
    task, and durations keep their digits where one deadline is far beyond all others.

    PyVRP counts in integers. Durations are rounded down and deadlines up, so that a route in time in floating-point
    arithmetic is in time there, even where a deadline is met exactly. Visits that only the model finds in time are
    dropped from the plan. Every planned task is finished by its deadline, whatever the mask rule.

    Args:
        seed: of the search, from 0 to `bounds.MAX_SEED`; PyVRP's own have 32 bits.
        budget: seconds per scenario, > 0; None is `BUDGET`. Building the model and the first solution comes on top.
            The search ends earlier if all tasks within reach are done, or several searches have stalled.
        iterations: most iterations, >= 1. With it, the same seed gives the same plan if the budget suffices.

    Raises:
        ConfigError: if an argument is out of range.
    """

    def __init__(self, seed: int = 0, budget: float | None = None, iterations: int | None = None) -> None:
        budget = BUDGET if budget is None else budget
        check_seed(seed)
        check_budget(budget)
        if iterations is not None and iterations < 1:
            raise ConfigError(f"iterations is {iterations}; expected a whole number >= 1")
        self._seed, self._budget, self._iterations = seed, budget, iterations

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        tasks = np.flatnonzero(within_reach(scenario).any(axis=0))
        routes: Routes = ((),) * scenario.num_robots
        if len(tasks):
            routes = drop_late(scenario, self._search(scenario, tasks))
        return Plan(routes, scenario.name, "pyvrp")

    def _search(self, scenario: Scenario, tasks: IntArray) -> list[list[int]]:
        """Routes through some of `tasks`."""
        from pyvrp import PenaltyParams, SolveParams, solve
        from pyvrp.exceptions import PenaltyBoundWarning
        from pyvrp.search import NeighbourhoodParams
        from pyvrp.stop import MaxIterations, MaxRuntime, MultipleCriteria, NoImprovement

        prize = RESOLUTION * (scenario.num_robots + 1)
        model = _model(scenario, tasks, prize)
        limit, left = TimeLimit.of(self._budget), self._iterations or 2**62
        best = None
        for search in range(SEARCHES):
            stop: list[Any] = [
                MaxRuntime(limit.left()),
                MaxIterations(left),
                NoImprovement(PATIENCE * len(tasks) ** 2),
                lambda cost: cost < prize,  # all tasks are done
            ]
            seed = (self._seed * SEARCHES + search) % 2**32
            params = SolveParams(
                penalty=PenaltyParams(max_penalty=WARPS[search % len(WARPS)] * prize),
                neighbourhood=NeighbourhoodParams(num_neighbours=NEIGHBOURS),
            )
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", PenaltyBoundWarning)  # it may stay at its bound
                found = solve(model, MultipleCriteria(stop), seed, collect_stats=False, display=False, params=params)
            if best is None or found.cost() < best.cost():
                best = found
            left -= found.num_iterations
            if best.cost() < prize or left <= 0 or limit.over:
                break
        assert best is not None
        routes: list[list[int]] = [[] for _ in range(scenario.num_robots)]
        for route in best.best.routes():
            routes[route.vehicle_type()] = [int(tasks[visit.idx]) for visit in route if visit.is_client()]
        return routes


def _model(scenario: Scenario, tasks: IntArray, prize: int) -> Any:
    """The `pyvrp.ProblemData`. Its locations are the robots' starts, the dummy end and the `tasks`."""
    from pyvrp import Client, Depot, Location, ProblemData, VehicleType

    end = scenario.num_robots
    places = np.concatenate([scenario.robot_xy, np.zeros((1, 2)), scenario.task_xy[tasks]])
    possible = in_time(scenario)
    slack = slack_time(scenario, frame_of(scenario, possible)[1], useful_robots(possible), scenario.workload)
    latest = min(float(scenario.deadline.max()), LATEST * slack)
    kinds: dict[tuple[float, float], int] = {}
    travels: list[Any] = []
    durations: list[Any] = []
    vehicles = []
    for robot in range(scenario.num_robots):
        speed, capacity = float(scenario.speed[robot]), float(scenario.capacity[robot])
        if (speed, capacity) not in kinds:
            kinds[speed, capacity] = len(kinds)
            (from_x, from_y), (x, y) = places.T[:, :, None], places.T[:, None, :]
            travel = travel_time(x - from_x, y - from_y, speed, np.sqrt)
            work = np.concatenate([np.zeros(end + 1), scenario.workload[tasks] / capacity])
            travels.append(_units(travel, latest, end))
            durations.append(_units(travel + work, latest, end))
        vehicles.append(VehicleType(start_depot=robot, end_depot=end, profile=kinds[speed, capacity]))
    deadlines = np.floor(np.minimum(scenario.deadline[tasks] / latest, 1.0) * RESOLUTION).astype(np.int64) + 1
    return ProblemData(
        [Location(x, y) for x, y in places.tolist()],
        [
            Client(end + 1 + index, tw_late=deadline, prize=prize, required=False)
            for index, deadline in enumerate(deadlines.tolist())
        ],
        [Depot(location) for location in range(end + 1)],
        vehicles,
        travels,
        durations,
    )


def _units(times: Any, latest: float, end: int) -> IntArray:
    """(L, L) times between locations in model units, rounded down; 0 to any depot.

    Times longer than the mission are cut, so that they fit an integer.
    """
    units: IntArray = np.floor(np.minimum(times / latest, 2.0) * RESOLUTION).astype(np.int64)
    units[:, : end + 1] = 0
    np.fill_diagonal(units, 0)
    return units
