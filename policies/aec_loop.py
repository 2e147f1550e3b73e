"""The AEC loop: a policy plans a mission robot by robot, through PettingZoo's public interface alone."""

from __future__ import annotations

from collections.abc import Callable

from mrta_zoo import mrta_v0
from mrta_zoo.env.settings import ObservationForm
from mrta_zoo.plan import Plan
from mrta_zoo.policies.options import SolverOptions
from mrta_zoo.policies.protocol import Policy
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import Scenario


def run_in_environment(
    policy: Policy,
    scenario: Scenario,
    mask_rule: MaskRule = "feasible",
    method: str = "",
    observation: ObservationForm = "dict",
) -> Plan:
    """The plan that results if `policy` decides for every robot of a mission.

    Args:
        policy: decides for each robot when it is its turn.
        scenario: the mission.
        mask_rule: what robots may choose, see `rules.MaskRule`.
        method: method name stored in the plan.
        observation: the form in which the policy reads observations.

    Raises:
        ActionError: if an action is not a whole number or not legal; the message names the robot, the task and the
            reason.
        ConfigError: if there is no such mask rule.
    """
    # Without the wrappers: they end the mission at an illegal action, where an error is wanted here.
    env = mrta_v0.raw_env(scenario=scenario, mask_rule=mask_rule, observation=observation)
    env.reset()
    routes: dict[str, list[int]] = {agent: [] for agent in env.agents}
    for agent in env.agent_iter():
        seen, _, termination, truncation, _ = env.last()
        if termination or truncation:
            env.step(None)
            continue
        task = policy.act(seen, agent)
        env.step(task)
        routes[agent].append(int(task))  # a NumPy integer, perhaps
    return Plan.of(list(routes.values()), scenario.name, method)


class PolicySolver:
    """Plans by running a new policy through the AEC environment for each mission.

    Args:
        make_policy: makes the policy.
        options: of which only the mask rule counts.
        method: method name stored in plans.

    Attributes:
        make_policy: as given.
        mask_rule: what robots may choose.
        method: as given.
    """

    def __init__(self, make_policy: Callable[[], Policy], options: SolverOptions, method: str) -> None:
        self.make_policy, self.method = make_policy, method
        self.mask_rule: MaskRule = options.mask_rule or "feasible"

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        return run_in_environment(self.make_policy(), scenario, self.mask_rule, self.method)
