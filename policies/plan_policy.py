"""A plan as a policy: any solver's plan, decision by decision, in the environment."""

from __future__ import annotations

from mrta_zoo.actions import must_wait, noop, split_mask
from mrta_zoo.env.observation import ROBOT_FEATURES, Observation
from mrta_zoo.errors import PlanError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.protocol import Policy
from mrta_zoo.wording import counted

_IS_EGO = ROBOT_FEATURES.index("is_ego")


class PlanPolicy:
    """Each robot takes the next task of its route in `plan`. One mission; `reset` before the next.

    In the environment a robot cannot decline: as long as the mask offers a task, it must take one. A plan may end a
    route all the same, or hold a task that the mask forbids (one that would be late, under "feasible"). So there
    are two ways to follow it:

    - exactly (``then=None``): either is an error. A plan of a policy that ran under the same mask rule can always be
      followed so. The mission ends when no robot has a choice left, be it before the plan does: compare what comes out.
    - as a guide (``then=policy``): a task that the robot may not take any more is passed over, and a robot at the end
      of its route goes on by `then`. Under "feasible" this completes whatever the plan completes, and maybe more:
      what is passed over was completed by another robot or would have been late, and by the triangle inequality the
      robot is no later at what follows.

    Args:
        plan: the routes.
        then: decides for a robot at the end of its route; None to follow the plan exactly.
    """

    def __init__(self, plan: Plan, then: Policy | None = None) -> None:
        self.plan = plan
        self.then = then
        self.reset()

    def reset(self) -> None:
        """Start over, for another mission."""
        self._next = [0] * len(self.plan.routes)

    def act(self, observation: Observation, agent: str = "") -> int:
        """The task to take, or the no-op where that is all the robot may. `agent` is not needed.

        Raises:
            PlanError: if the plan has no route for this robot or, where it is followed exactly, its route is at its end
                or goes on with a task that it may not take.
        """
        robot = int(observation["observation"]["robots"][:, _IS_EGO].argmax())
        if robot >= len(self._next):
            raise PlanError(f"the plan has {counted(len(self._next), 'route')}, none for robot {robot}")
        max_tasks = len(observation["observation"]["tasks"])
        if must_wait(observation["action_mask"], max_tasks):
            return noop(max_tasks)
        route, (mask, _) = self.plan.routes[robot], split_mask(observation["action_mask"], max_tasks)
        while self._next[robot] < len(route):
            task = route[self._next[robot]]
            self._next[robot] += 1
            if 0 <= task < len(mask) and mask[task]:
                return task
            if self.then is None:
                raise PlanError(
                    f"the plan sends robot {robot} to task {task}, which it may not choose now: it is taken, or the "
                    "mask rule forbids it; follow it under the rule it was made for, or give a policy as `then`"
                )
        if self.then is None:
            raise PlanError(
                f"the plan's route for robot {robot} is at its end, but the robot may still choose {int(mask.sum())} "
                "tasks and cannot decline; give a policy as `then`"
            )
        return self.then.act(observation, agent)
