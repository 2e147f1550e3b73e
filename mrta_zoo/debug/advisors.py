"""Advisors: any method, to be asked at any moment of a mission what it would do now.

Users go back and forth in a mission, so an advisor keeps no state of its own: it is given its policy's state before a
decision and returns the state after it. So a policy that draws at random gives the same advice whenever a decision is
revisited.
"""

from __future__ import annotations

import copy
from abc import ABC, abstractmethod
from typing import Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from mrta_zoo.actions import as_action
from mrta_zoo.env.observation import Observation, Observer
from mrta_zoo.mission import Mission
from mrta_zoo.plan import Plan
from mrta_zoo.policies.aec_loop import PolicySolver
from mrta_zoo.policies.neural.learned_solver import LearnedSolver
from mrta_zoo.policies.protocol import Policy, Solver
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import Scenario
from mrta_zoo.trace import TOLERANCE, Choice, tightest_rule

DIGITS = 6
"""Significant digits of a probability, and of the difference between the largest and 1."""


class Thought(Protocol):
    """A policy's decision, with probabilities."""

    @property
    def action(self) -> int:
        """The task to take."""

    @property
    def probabilities(self) -> npt.NDArray[np.floating]:
        """(max_tasks,) probability of each task."""


@runtime_checkable
class Probabilistic(Protocol):
    """A policy that shows its probabilities, as `policies.neural.NeuralPolicy` does."""

    def decide(self, observation: Observation) -> Thought:
        """The task to take, with probabilities."""


class Advisor(ABC):
    """A method that is asked for one decision at a time.

    Attributes:
        method: its name.
        mask_rule: the rule that it decides under.
        decode: how a learned policy chooses; empty if there is nothing to say.
        seed: of all random draws, None if none was given.
        bound: as in `Plan`, if a plan advises.
        memoryless: whether its advice depends on the mission alone, so that any earlier state of it will do.
    """

    method: str = ""
    mask_rule: MaskRule = "feasible"
    decode: str = ""
    seed: int | None = None
    bound: int | None = None
    memoryless: bool = False

    def begin(self) -> Any:
        """The state before the first decision."""
        return None

    @abstractmethod
    def advise(self, mission: Mission, state: Any) -> tuple[Choice, Any]:
        """What the acting robot should do.

        Args:
            mission: not over; not changed.
            state: the method's before the decision; not changed.

        Returns:
            The choice, and the state for the next decision.
        """


class PolicyAdvisor(Advisor):
    """Asks a policy of the AEC loop, with its probabilities if it has some.

    Args:
        policy: asked only through copies: those its method `fork` makes if it has one, otherwise deep copies. An
            attribute ``memoryless = True`` says that it decides by the observation alone.
        method: its name.
        mask_rule: the rule that it decides under.
        seed: the seed that it was made with.
    """

    def __init__(
        self, policy: Policy, method: str = "", mask_rule: MaskRule = "feasible", seed: int | None = None
    ) -> None:
        self.method, self.mask_rule, self.seed = method, mask_rule, seed
        self.decode = str(getattr(policy, "decode", ""))
        self.memoryless = getattr(policy, "memoryless", False) is True
        self._policy = policy
        self._observers: dict[Scenario, Observer] = {}

    def begin(self) -> Policy:
        """A copy of the policy."""
        return _fork(self._policy)

    def advise(self, mission: Mission, state: Policy) -> tuple[Choice, Policy]:
        """What the policy would do now, given what it went through before.

        Raises:
            ActionError: if its action is not the number of a task.
        """
        scenario, robot = mission.scenario, mission.actor
        if scenario not in self._observers:
            self._observers = {scenario: Observer(scenario, scenario.num_tasks, scenario.num_robots, mission.mask_rule)}
        observation = self._observers[scenario].observe(mission, robot)
        policy, agent = _fork(state), f"robot_{robot}"
        if not isinstance(policy, Probabilistic):
            return Choice(as_action(agent, policy.act(observation, agent), scenario.num_tasks)), policy
        thought = policy.decide(observation)
        return Choice(as_action(agent, thought.action, scenario.num_tasks), _exact(thought.probabilities)), policy


class PlanAdvisor(Advisor):
    """Advises what a plan does next.

    The robot takes the first task of its route that nobody has taken and that it may choose; at the end of its route
    it stays. As long as the advice is followed, the result is the plan.

    Args:
        scenario: what was planned.
        plan: the plan.
        mask_rule: by default the tightest that allows what the plan does.
        policy: a learned policy that made the plan: shows its probabilities, and decides once the plan has been left.
        decode: how the policy made it.
        seed: the seed given to the method.

    Raises:
        PlanError: if the plan does not fit the scenario.
    """

    def __init__(
        self,
        scenario: Scenario,
        plan: Plan,
        mask_rule: MaskRule | None = None,
        policy: PolicyAdvisor | None = None,
        decode: str = "",
        seed: int | None = None,
    ) -> None:
        self.method, self.decode, self.seed, self.bound = plan.method, decode, seed, plan.bound
        tightest = tightest_rule(scenario, plan)  # also checks that the plan fits
        self.mask_rule = tightest if mask_rule is None else mask_rule
        self.memoryless = policy is None or policy.memoryless
        self._routes, self._policy = plan.routes, policy

    def begin(self) -> Any:
        """The policy's state, if there is one."""
        return None if self._policy is None else self._policy.begin()

    def advise(self, mission: Mission, state: Any) -> tuple[Choice, Any]:
        """What the plan has the robot do next."""
        probabilities = None
        if self._policy is not None:
            choice, state = self._policy.advise(mission, state)
            if any(
                tuple(taken) != route[: len(taken)] for taken, route in zip(mission.routes, self._routes, strict=True)
            ):
                return choice, state
            probabilities = choice.probabilities
        mask = mission.mask(mission.actor)
        return Choice(next((task for task in self._routes[mission.actor] if mask[task]), None), probabilities), state


def make_advisor(scenario: Scenario, method: str | Policy | Solver | Plan, **options: Any) -> Advisor:
    """The advisor for a method. A solver plans once, now; a policy will be asked at each decision.

    Args:
        scenario: the mission.
        method: a name or path that `registry.make_solver` knows, a policy, a solver, or a plan.
        **options: of `make_solver` for a name; ``mask_rule`` also for a policy or a plan.

    Raises:
        MrtaError: if there is no such method, an option is out of range, or a plan does not fit the scenario.
    """
    rule: MaskRule | None = options.get("mask_rule")
    if isinstance(method, Plan):
        return PlanAdvisor(scenario, method, rule)
    seed: int | None = None
    if isinstance(method, str):
        name, seed = method, options.get("seed", 0)
        method = make_solver(name, **options)
    else:
        name = str(getattr(method, "name", type(method).__name__))
    if isinstance(method, PolicySolver):
        return PolicyAdvisor(method.make_policy(), method.method, method.mask_rule, seed)
    if isinstance(method, LearnedSolver):
        return _learned(scenario, method, seed)
    if isinstance(method, Policy):
        trained_under: MaskRule = getattr(getattr(method, "info", None), "mask_rule", "feasible")
        return PolicyAdvisor(method, name, rule or trained_under, seed)
    return PlanAdvisor(scenario, method.solve(scenario), rule, seed=seed)


def _learned(scenario: Scenario, solver: LearnedSolver, seed: int | None) -> Advisor:
    """A greedy policy is asked at each decision; otherwise the plan that its decoding finds gives the advice."""
    policy, options = solver.policy, solver.options
    live = PolicyAdvisor(policy, policy.name, options.mask_rule or policy.info.mask_rule, seed)
    if options.decode == "greedy" and options.budget is None:
        return live
    return PlanAdvisor(scenario, solver.solve(scenario), live.mask_rule, live, str(options.decode), seed)


def _fork(policy: Policy) -> Policy:
    fork = getattr(policy, "fork", None)
    forked: Policy = copy.deepcopy(policy) if fork is None else fork()
    return forked


def _exact(probabilities: npt.NDArray[np.floating]) -> dict[int, float]:
    """The probabilities > 0, likeliest first. The largest is 1 minus the others, which float32 may round away."""
    values = probabilities.astype(np.float64)
    order = np.argsort(-values, kind="stable").tolist()
    exact = {task: float(f"{values[task]:.{DIGITS}g}") for task in order if values[task] > 0}
    likeliest = order[0]
    if values[likeliest] > 0.5 and abs(values.sum() - 1) < TOLERANCE:
        rest = float(np.delete(values, likeliest).sum())
        exact[likeliest] = 1 - float(f"{rest:.{DIGITS}g}")
    return exact
