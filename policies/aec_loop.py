"""Running a policy through the AEC environment, robot by robot, with nothing but PettingZoo's public interface."""

from __future__ import annotations

from mrta_zoo import mrta_v0
from mrta_zoo.env.settings import ObservationForm
from mrta_zoo.plan import Plan
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
    """Let `policy` decide for every robot of a mission, and note who took what.

    Args:
        policy: decides for each robot when its turn comes.
        scenario: the mission.
        mask_rule: what robots may choose, see `rules.MaskRule`.
        method: method name stored in the plan.
        observation: the form in which the policy reads observations.

    Returns:
        The tasks of each robot in the order in which it took them.

    Raises:
        ActionError: if the policy chooses what it may not, or no whole number; the message names the robot, the
            task and the reason.
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
