"""PyVRP, an open solver of vehicle routing problems, as the strong reference.

Wouda, Lan and Kool, "PyVRP: a high-performance VRP solver package", INFORMS Journal on Computing 36 (2024).
"""

from __future__ import annotations

import math
import time
import warnings
from typing import Any

import numpy as np

from mrta_zoo.bounds import check_seed
from mrta_zoo.errors import ConfigError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.exact.task_sets import IntArray, within_reach
from mrta_zoo.policies.classical.on_time import Routes, on_time
from mrta_zoo.reach import in_time
from mrta_zoo.rules import travel_time
from mrta_zoo.scales import frame_of, slack_time, useful_robots
from mrta_zoo.scenario import Scenario

BUDGET = 5.0
RESOLUTION = 10**7
"""Model time units until the latest deadline, or until the time beyond which none counts."""
LATEST = 4.0
"""Deadlines count up to so many times `mrta_zoo.scales.slack_time`, beyond which they cannot bind."""
WARPS = (2e-5, 2e-6, 2e-4)
"""What a model time unit of lateness costs at most during the search, in prizes. A search starts at half of it and
adapts it, so that it passes through plans that are late, but finds some that are not. The first value is the best for
large scenarios; if it starts anew, the search tries the others in turn."""
NEIGHBOURS = 20
PATIENCE = 2
"""Iterations for each pair of tasks without improvement, after which hardly any follows and the search starts anew."""
SEARCHES = 20
"""How often it starts at most."""


class PyVrpSolver:
    """Models the mission exactly, as a prize-collecting routing problem with time windows.

    Every robot is a vehicle type of its own that starts at its own depot and ends at a dummy one, to which every way
    is free; going to a task takes the way and the work there, at the robot's own speed and capacity; each task is an
    optional client with a deadline and a prize. The travel time costs, too: the search needs it to tell routes with
    as many tasks apart, and finds far more tasks with it. The prize is larger than all that robots can travel in
    time, so that one more task is always worth it.

    No task is planned to end later than at `LATEST` times the time by which all that can wait could be done: that
    costs no task, and leaves the durations their digits where one deadline is far beyond all others.

    PyVRP counts in integers. Durations are rounded down and deadlines up, so that what is in time in floating-point
    arithmetic is in time there, also where a deadline is met exactly. What only the model finds in time is dropped
    from the plan. What is planned is finished by its deadline, whatever the mask rule.

    Args:
        seed: of the search, from 0 to `bounds.MAX_SEED`; PyVRP's own have 32 bits.
        budget: seconds a scenario, > 0, not counting what it takes to build the model and the first solution. It stops
            earlier if all tasks are done that are within reach, or several searches have stalled.
        iterations: stop after so many, too, >= 1; then the same seed gives the same plan, if the budget suffices.

    Raises:
        ConfigError: if an argument is out of range.
    """

    def __init__(self, seed: int = 0, budget: float = BUDGET, iterations: int | None = None) -> None:
        check_seed(seed)
        if not 0 < budget < math.inf:
            raise ConfigError(f"budget is {budget:g}; expected a number of seconds > 0")
        if iterations is not None and iterations < 1:
            raise ConfigError(f"iterations is {iterations}; expected a whole number >= 1")
        self._seed, self._budget, self._iterations = seed, budget, iterations

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        tasks = np.flatnonzero(within_reach(scenario).any(axis=0))
        routes: Routes = ((),) * scenario.num_robots
        if len(tasks):
            routes = on_time(scenario, self._search(scenario, tasks))
        return Plan(routes, scenario.name, "pyvrp")

    def _search(self, scenario: Scenario, tasks: IntArray) -> list[list[int]]:
        """Routes through some of `tasks`."""
        from pyvrp import PenaltyParams, SolveParams, solve
        from pyvrp.exceptions import PenaltyBoundWarning
        from pyvrp.search import NeighbourhoodParams
        from pyvrp.stop import MaxIterations, MaxRuntime, MultipleCriteria, NoImprovement

        prize = RESOLUTION * (scenario.num_robots + 1)
        model = _model(scenario, tasks, prize)
        stop_at, left = time.perf_counter() + self._budget, self._iterations or 2**62
        best = None
        for search in range(SEARCHES):
            stop: list[Any] = [
                MaxRuntime(max(0.0, stop_at - time.perf_counter())),
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
            if best.cost() < prize or left <= 0 or time.perf_counter() >= stop_at:
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
    """(L, L) times between locations in model units, rounded down; 0 on the way to any depot.

    What is longer than there is time is cut, as integers have a greatest.
    """
    units: IntArray = np.floor(np.minimum(times / latest, 2.0) * RESOLUTION).astype(np.int64)
    units[:, : end + 1] = 0
    np.fill_diagonal(units, 0)
    return units
