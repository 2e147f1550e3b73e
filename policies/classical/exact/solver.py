"""Plans that provably complete as many tasks as possible, for small scenarios.

Dynamic programming for each robot, then set packing by an integer program. The paper speaks of the exact ILP solution
(§I); HiGHS proves the optimum of this formulation in a second or two for 12 tasks and 3 robots.
"""

from __future__ import annotations

from mrta_zoo.errors import ConfigError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.classical.drop_late import Routes, drop_late
from mrta_zoo.policies.classical.exact.relaxation import most_completable
from mrta_zoo.policies.classical.exact.selection import Team, select_sets
from mrta_zoo.policies.classical.exact.task_sets import task_sets
from mrta_zoo.policies.classical.local_search.eils import EilsSolver
from mrta_zoo.policies.stop import TimeLimit, check_budget
from mrta_zoo.scenario import Scenario
from mrta_zoo.verify import verify

BUDGET = 60.0
MAX_STATES = 4_000_000
MAX_SETS = 2_000
"""Sets that a kind of robot may choose from where optimality cannot be proven any more."""
PROVABLE_SETS = 100_000
"""HiGHS does not get through more sets than this in its time."""
BOUND_SHARE, SEARCH_SHARE = 0.1, 0.6
"""Shares of the budget after which the bound and the task sets must be known. The rest is for the integer program."""


class ExactSolver:
    """Maximises the number of completed tasks. `Plan.bound` is an upper bound on that number.

    Dynamic programming (`task_sets`) finds every set of tasks that a robot can complete; an integer program, solved by
    HiGHS, then selects one for each robot so that together they hold as many tasks as possible (`selection`). If both
    are finished, the plan is optimal and the bound is its number of tasks. Otherwise (too little time or memory, or
    more than 63 tasks within a robot's reach) the bound comes from a linear program (`relaxation`), and the plan is
    the best of those found so far and of local search (`local_search.eils`). Of several optimal plans it always gives
    the same one, unless time runs out.

    The objective is the number of completed tasks because the paper's tables count it. Eq. 1 is a different objective:
    a completed task costs nothing there and any other at least 1, so that one more completed task usually pays. But
    the later the mission ends, the more an untaken task costs. So another plan with as many tasks may cost less, and
    at times one with fewer. Every planned task is finished by its deadline, whatever the mask rule. The first instance
    compiles the local search: some 20 seconds on a new machine.

    Args:
        budget: seconds per scenario, > 0; None is `BUDGET`. It may be exceeded by about a second and by the time of
            the local search.
        max_states: number of states of the dynamic program to keep for each robot, >= 0. Four million need 200 MB and
            suffice for some 18 tasks that can be done in any order, or for more with tight deadlines.

    Raises:
        ConfigError: if an argument is out of range.
    """

    def __init__(self, budget: float | None = None, max_states: int = MAX_STATES) -> None:
        budget = BUDGET if budget is None else budget
        check_budget(budget)
        if max_states < 0:
            raise ConfigError(f"max_states is {max_states}; expected a whole number >= 0")
        self._budget, self._max_states = budget, max_states
        self._local_search = EilsSolver()  # compiles here, so that no budget is spent on it

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`, with its bound."""
        limit = TimeLimit.of(self._budget)
        bound = most_completable(scenario, limit.first(BOUND_SHARE))
        best = self._local_search.solve(scenario).routes
        completed = verify(scenario, Plan(best)).completed
        # The sets that are part of no other nearly always suffice. They may not where, by rounding, a robot is in time
        # for a set but not for a part of it.
        for only_largest in (True, False):
            if completed == bound:
                break
            teams, all_found = self._teams(scenario, only_largest, limit)
            selection = select_sets(teams, scenario.num_tasks, disjoint=not only_largest, limit=limit)
            routes = drop_late(scenario, [selection.routes.get(robot, []) for robot in range(scenario.num_robots)])
            best, completed = _best(scenario, [best, routes])
            if not all_found:
                break
            bound = min(bound, selection.bound)
        return Plan(best, scenario.name, "exact", bound)

    def _teams(self, scenario: Scenario, only_largest: bool, limit: TimeLimit) -> tuple[list[Team], bool]:
        """What each team of robots can choose from, and whether that is everything."""
        alike: dict[tuple[float, ...], list[int]] = {}
        for robot in range(scenario.num_robots):
            x, y = scenario.robot_xy[robot].tolist()
            alike.setdefault((x, y, float(scenario.capacity[robot]), float(scenario.speed[robot])), []).append(robot)
        teams, all_found = [], True
        for index, robots in enumerate(alike.values()):
            share = SEARCH_SHARE * (index + 1) / len(alike)
            found = task_sets(
                scenario, robots[0], only_largest=only_largest, max_states=self._max_states, limit=limit.first(share)
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
