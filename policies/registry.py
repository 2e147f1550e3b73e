"""Every method that can plan a mission, by name. To add one, give it an entry in `METHODS`.

Importing this imports no torch; learned methods load it when they are made.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from importlib import resources
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args

from mrta_zoo.bounds import check_seed
from mrta_zoo.errors import ConfigError, MissingExtraError
from mrta_zoo.plan import Plan
from mrta_zoo.policies.aec_loop import run_in_environment
from mrta_zoo.policies.heuristics import EarliestDeadlinePolicy, NearestPolicy, RandomPolicy
from mrta_zoo.policies.protocol import Policy, Solver
from mrta_zoo.rules import MaskRule, check_mask_rule
from mrta_zoo.scenario import Scenario

if TYPE_CHECKING:
    from mrta_zoo.policies.neural import NeuralPolicy

Decode = Literal["greedy", "sample"]

MAX_SAMPLES = 10_000
"""More at a time than memory holds; a budget draws as many as there is time for, some at a time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SolverOptions:
    """What any method may be told; each uses what it can.

    Attributes:
        seed: of all draws, from 0 to `bounds.MAX_SEED`. Every scenario starts from it, so that a case has the same plan
            in any company.
        decode: how learned methods choose: "greedy", the likeliest task each time; "sample", the best of several drawn
            missions and the greedy one. None is "sample" if there is a budget, else "greedy".
        samples: missions that "sample" draws in one go, from 1 to `MAX_SAMPLES`.
        budget: seconds a scenario that methods which search may take, > 0; None leaves it to the method.
        mask_rule: what robots may choose, see `rules.MaskRule`. None is "feasible" or, for learned methods, the rule
            they were trained under.

    Raises:
        ConfigError: if a value is out of range.
    """

    seed: int = 0
    decode: Decode | None = None
    samples: int = 64
    budget: float | None = None
    mask_rule: MaskRule | None = None

    def __post_init__(self) -> None:
        check_seed(self.seed)
        if self.decode is None:
            object.__setattr__(self, "decode", "greedy" if self.budget is None else "sample")
        if self.decode not in get_args(Decode):
            raise ConfigError(f"decode is {self.decode!r}; expected one of {', '.join(get_args(Decode))}")
        if not 1 <= self.samples <= MAX_SAMPLES:
            raise ConfigError(f"samples is {self.samples}; expected a whole number from 1 to {MAX_SAMPLES}")
        if self.budget is not None and not 0 < self.budget < math.inf:
            raise ConfigError(f"budget is {self.budget:g}; expected a number of seconds > 0")
        if self.mask_rule is not None and self.mask_rule not in get_args(MaskRule):
            raise check_mask_rule(self.mask_rule)


@dataclass(frozen=True, slots=True)
class Method:
    """A way to plan.

    Attributes:
        summary: what it does, in a few words.
        make: the solver, given the options.
    """

    summary: str
    make: Callable[[SolverOptions], Solver]


class PolicySolver:
    """Plans by running a fresh policy through the AEC environment.

    Args:
        make_policy: gives the policy for one mission.
        options: of which the mask rule counts.
        method: what plans are signed with.
    """

    def __init__(self, make_policy: Callable[[], Policy], options: SolverOptions, method: str) -> None:
        self._make_policy, self._mask_rule, self._method = make_policy, options.mask_rule or "feasible", method

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        return run_in_environment(self._make_policy(), scenario, self._mask_rule, self._method)


class LearnedSolver:
    """Plans with a trained policy.

    Args:
        policy: the policy.
        options: how to use it.
    """

    def __init__(self, policy: NeuralPolicy, options: SolverOptions) -> None:
        self.policy, self._options = policy, options

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        options = self._options
        return self.policy.solve(
            scenario,
            decode=options.decode or "greedy",
            samples=options.samples,
            budget=options.budget,
            mask_rule=options.mask_rule,
            seed=options.seed,
        )

    def warm_up(self, scenario: Scenario) -> None:
        """Plan once without a search: the first pass of a network is slower than those that follow."""
        self.policy.solve(scenario, mask_rule=self._options.mask_rule)


METHODS: dict[str, Method] = {
    "random": Method(
        "any feasible task, drawn evenly",
        lambda options: PolicySolver(lambda: RandomPolicy(options.seed), options, "random"),
    ),
    "nearest": Method(
        "the nearest feasible task",
        lambda options: PolicySolver(NearestPolicy, options, "nearest"),
    ),
    "edf": Method(
        "the feasible task with the earliest deadline",
        lambda options: PolicySolver(EarliestDeadlinePolicy, options, "edf"),
    ),
}
"""Methods that need no training. The policies that ship with the package are methods, too: see `method_names`."""


def method_names() -> list[str]:
    """What `make_solver` knows by name: `METHODS`, then the trained policies that ship with the package."""
    folder = resources.files("mrta_zoo.policies.pretrained")
    shipped = sorted(Path(file.name).stem for file in folder.iterdir() if file.name.endswith(".safetensors"))
    return [*METHODS, *shipped]


def make_solver(
    name: str,
    *,
    seed: int = 0,
    decode: Decode | None = None,
    samples: int = 64,
    budget: float | None = None,
    mask_rule: MaskRule | None = None,
) -> Solver:
    """The method of that name, ready to plan.

    Args:
        name: one of `method_names()`, a trained policy's ``.safetensors`` file, or the folder of a training run.
        seed: see `SolverOptions`, as for all that follow.
        decode: how learned methods choose.
        samples: missions that sampling draws in one go.
        budget: seconds a scenario for methods that search.
        mask_rule: what robots may choose.

    Raises:
        ConfigError: if there is no such method, or an option is out of range.
        MissingExtraError: if a learned method is asked for and torch is not installed.
    """
    options = SolverOptions(seed=seed, decode=decode, samples=samples, budget=budget, mask_rule=mask_rule)
    if name in METHODS:
        return METHODS[name].make(options)
    names = method_names()
    if name not in names and not name.endswith(".safetensors") and not os.path.isdir(name):
        raise ConfigError(
            f"there is no method {name!r}; expected one of {', '.join(names)}, a .safetensors file, or the folder of a "
            "training run"
        )
    return LearnedSolver(load_learned(name), options)


def load_learned(name: str) -> NeuralPolicy:
    """A trained policy, by name or path.

    Raises:
        ConfigError: if there is none, or its files are damaged.
        MissingExtraError: if torch is not installed.
    """
    require_torch(f"method {name!r}")
    from mrta_zoo.policies.neural import load_policy

    return load_policy(name)


def require_torch(what: str) -> None:
    """Make sure that trained networks can be used.

    Raises:
        MissingExtraError: if torch or safetensors is not installed; the message begins with `what`.
    """
    for module in ("torch", "safetensors"):
        if find_spec(module) is None:
            raise MissingExtraError(
                f'{what} needs {module}, which is not installed; install it with: pip install "mrta_zoo[torch]"'
            )
