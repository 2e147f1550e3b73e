"""Plans that provably complete as many tasks as possible, for small scenarios.

Dynamic programming for each robot, then set packing by an integer program; what the paper calls the exact ILP solution
(§I), in a formulation whose optimum HiGHS proves in a second or two for 12 tasks and 3 robots.
"""

from __future__ import annotations

import math
import time

from mrta_zoo.errors import ConfigError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.exact.relaxation import most_completable
from mrta_zoo.policies.classical.exact.set_choice import Team, choose_sets
from mrta_zoo.policies.classical.exact.task_sets import task_sets
from mrta_zoo.policies.classical.local_search.eils import EilsSolver
from mrta_zoo.policies.classical.on_time import Routes, on_time
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify

BUDGET = 60.0
MAX_STATES = 4_000_000
MAX_SETS = 2_000
"""How many sets a kind of robot may choose from once there is nothing left to prove."""
PROVABLE_SETS = 100_000
"""More sets than this HiGHS does not get through in the time that it is given."""
BOUND_SHARE, SEARCH_SHARE = 0.1, 0.6
"""When bounding and enumerating must be done, as shares of the budget; the rest is for the integer program."""


class ExactSolver:
    """Maximises the number of completed tasks, and says in `Plan.bound` what no plan can exceed.

    Every set of tasks that a robot can complete is found by dynamic programming (`task_sets`); an integer program,
    solved by HiGHS, then picks one for each robot so that together they hold as many tasks as possible
    (`set_choice`). With everything found and solved, the plan is optimal and the bound is its number of tasks.
    Otherwise (too little time or memory, or more than 63 tasks within a robot's reach) the bound comes from a linear
    program (`relaxation`), and the plan is the best of what was found and of local search (`local_search.eils`). Of
    several optimal plans it gives always the same one, unless time runs out.

    The objective is the number of completed tasks because that is what the tables of the paper count. Eq. 1 is
    another one: a completed task costs nothing there, any other at least 1, so that completing one more usually
    pays. But a task that nobody takes costs the more the later the mission ends; so of the plans with as many
    tasks others may cost less, and at times one with fewer. What is planned is finished by its deadline, whatever
    the mask rule. Making the first one compiles the local search, some 20 seconds on a machine new to it.

    Args:
        budget: seconds a scenario, > 0. Kept up to about a second, and the time of the local search.
        max_states: how many states of the dynamic program to keep for a robot, >= 0. Four million need 200 MB and do
            for some 18 tasks that can be done in any order, or for more with tight deadlines.

    Raises:
        ConfigError: if an argument is out of range.
    """

    def __init__(self, budget: float = BUDGET, max_states: int = MAX_STATES) -> None:
        if not 0 < budget < math.inf:
            raise ConfigError(f"budget is {budget:g}; expected a number of seconds > 0")
        if max_states < 0:
            raise ConfigError(f"max_states is {max_states}; expected a whole number >= 0")
        self._budget, self._max_states = budget, max_states
        self._local_search = EilsSolver()  # compiles here, so that no budget is spent on it

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`, with its bound."""
        begun = time.perf_counter()
        bound = most_completable(scenario, BOUND_SHARE * self._budget)
        best = self._local_search.solve(scenario).routes
        completed = verify(scenario, Plan(best)).completed
        # The sets that are part of no other nearly always do. They may not where rounding lets a robot be in time for a
        # set but not for a part of it.
        for only_largest in (True, False):
            if completed == bound:
                break
            teams, all_found = self._teams(scenario, only_largest, begun)
            left = begun + self._budget - time.perf_counter()
            choice = choose_sets(teams, scenario.num_tasks, disjoint=not only_largest, seconds=left)
            routes = on_time(scenario, [choice.routes.get(robot, []) for robot in range(scenario.num_robots)])
            best, completed = _best(scenario, [best, routes])
            if not all_found:
                break
            bound = min(bound, choice.bound)
        return Plan(best, scenario.name, "exact", bound)

    def _teams(self, scenario: Scenario, only_largest: bool, begun: float) -> tuple[list[Team], bool]:
        """What each team of robots can choose from, and whether that is all."""
        alike: dict[tuple[float, ...], list[int]] = {}
        for robot in range(scenario.num_robots):
            x, y = scenario.robot_xy[robot].tolist()
            alike.setdefault((x, y, float(scenario.capacity[robot]), float(scenario.speed[robot])), []).append(robot)
        teams, all_found = [], True
        for index, robots in enumerate(alike.values()):
            share = SEARCH_SHARE * (index + 1) / len(alike)
            found = task_sets(
                scenario, robots[0],
                only_largest=only_largest, max_states=self._max_states, stop_at=begun + share * self._budget,
            )  # fmt: skip
            all_found = all_found and found.all_found
            teams.append(Team(robots, found.routes))
        all_found = all_found and sum(len(team.routes) for team in teams) <= PROVABLE_SETS
        if not all_found:
            teams = [Team(team.robots, team.routes[:MAX_SETS]) for team in teams]
        return teams, all_found


def _best(scenario: Scenario, candidates: list[Routes]) -> tuple[Routes, int]:
    """The first of the routes that complete the most tasks, and how many."""
    completed = [verify(scenario, Plan(routes)).completed for routes in candidates]
    return candidates[completed.index(max(completed))], max(completed)
