"""Every method that can plan a mission, by name. To add one, give it an entry in `METHODS`.

Importing this imports no optional dependency; methods load theirs when they are made.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from mrta_zoo.errors import ConfigError
from mrta_zoo.extras import require
from mrta_zoo.io.paths import check_no_url, suffix_of
from mrta_zoo.plan import Plan
from mrta_zoo.policies.aec_loop import run_in_environment
from mrta_zoo.policies.classical.big_mrta import BigMrtaSolver
from mrta_zoo.policies.classical.heuristics import EarliestDeadlinePolicy, NearestPolicy, RandomPolicy
from mrta_zoo.policies.classical.pyvrp_solver import BUDGET as PYVRP_BUDGET
from mrta_zoo.policies.classical.pyvrp_solver import PyVrpSolver
from mrta_zoo.policies.neural.policy_files import SUFFIX
from mrta_zoo.policies.options import Decode, SolverOptions
from mrta_zoo.policies.pretrained import pretrained_names
from mrta_zoo.policies.protocol import Policy, Solver
from mrta_zoo.policies.stop import TimeLimit
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import Scenario

if TYPE_CHECKING:
    from mrta_zoo.policies.neural.policy import NeuralPolicy


@dataclass(frozen=True, slots=True)
class Method:
    """A way to plan.

    Attributes:
        summary: what it does, in a few words.
        make: the solver, given the options.
        uses: those of the options that may be left out, of which it makes something.
        extra: the extra of the package that it needs, one of `extras.EXTRAS`.
    """

    summary: str
    make: Callable[[SolverOptions], Solver]
    uses: frozenset[str] = frozenset()
    extra: str | None = None


class PolicySolver:
    """Plans by running a fresh policy through the AEC environment.

    Args:
        make_policy: gives the policy for one mission.
        options: of which the mask rule counts.
        method: what plans are signed with.

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


class LearnedSolver:
    """Plans with a trained policy.

    Args:
        policy: the policy.
        options: how to use it.
    """

    def __init__(self, policy: NeuralPolicy, options: SolverOptions) -> None:
        self.policy, self.options = policy, options

    def solve(self, scenario: Scenario) -> Plan:
        """A plan for `scenario`."""
        options = self.options
        return self.policy.solve(
            scenario,
            decode=options.decode or "greedy",
            samples=options.samples,
            budget=options.budget,
            mask_rule=options.mask_rule,
            seed=options.seed,
        )

    @property
    def name(self) -> str:
        """What plans are signed with."""
        return self.policy.name

    def solve_within(self, scenario: Scenario, limit: TimeLimit) -> Plan | None:
        """The plan without a search if the policy searches only on a budget, else the best found in that time.

        None if not even the first greedy mission is finished in time.
        """
        return self.policy.solve_within(scenario, limit, self.options)

    def warm_up(self, scenario: Scenario) -> None:
        """Plan once without a search: the first pass of a network is slower than those that follow."""
        self.policy.solve(scenario, mask_rule=self.options.mask_rule)


def _ils(options: SolverOptions) -> Solver:
    from mrta_zoo.policies.classical.local_search.ils import IlsSolver

    return IlsSolver(options.budget)


def _eils(options: SolverOptions) -> Solver:
    from mrta_zoo.policies.classical.local_search.eils import EilsSolver

    return EilsSolver(options.seed, options.budget, threads=options.threads)


def _exact(options: SolverOptions) -> Solver:
    from mrta_zoo.policies.classical.exact.solver import BUDGET, ExactSolver

    return ExactSolver(budget=options.budget or BUDGET)


_RULE, _BUDGET = frozenset({"mask_rule"}), frozenset({"budget"})
_LEARNED = frozenset({"decode", "samples", "budget", "mask_rule"})

METHODS: dict[str, Method] = {
    "random": Method(
        "any feasible task, drawn evenly",
        lambda options: PolicySolver(lambda: RandomPolicy(options.seed), options, "random"),
        uses=_RULE,
    ),
    "nearest": Method(
        "the nearest feasible task",
        lambda options: PolicySolver(NearestPolicy, options, "nearest"),
        uses=_RULE,
    ),
    "edf": Method(
        "the feasible task with the earliest deadline",
        lambda options: PolicySolver(EarliestDeadlinePolicy, options, "edf"),
        uses=_RULE,
    ),
    "big-mrta": Method(
        "a maximum-weight matching of robots and tasks at each decision",
        lambda options: BigMrtaSolver(),
        extra="solvers",
    ),
    "ils": Method("iterated local search (Vansteenwegen et al. 2009), compiled", _ils, _BUDGET, extra="solvers"),
    "eils": Method(
        "local search in the spirit of EILS (details unknown): removes and refills strings of visits",
        _eils,
        _BUDGET,
        extra="solvers",
    ),
    "exact": Method(
        "as many tasks as possible, proven; for small missions",
        _exact,
        _BUDGET,
        extra="solvers",
    ),
    "pyvrp": Method(
        "the routing solver PyVRP, which searches until the budget ends or nothing more comes",
        lambda options: PyVrpSolver(seed=options.seed, budget=options.budget or PYVRP_BUDGET),
        _BUDGET,
        extra="pyvrp",
    ),
}
"""Methods that need no training. The policies that ship with the package are methods, too: see `method_names`."""


POLISH = "+polish"
"""What is added to a method's name to have its plan improved by local search."""


def method_names() -> list[str]:
    """What `make_solver` knows by name: `METHODS`, then the trained policies that ship with the package."""
    return [*METHODS, *pretrained_names()]


def used_options(name: str) -> frozenset[str]:
    """Those of the options that may be left out, of which the method of that name makes something."""
    if name.endswith(POLISH):
        return used_options(name.removesuffix(POLISH)) | _BUDGET
    return METHODS[name].uses if name in METHODS else _LEARNED


def make_solver(
    name: str,
    *,
    seed: int = 0,
    decode: Decode | None = None,
    samples: int | None = None,
    budget: float | None = None,
    mask_rule: MaskRule | None = None,
    threads: int = 1,
) -> Solver:
    """The method of that name, ready to plan.

    Args:
        name: one of `method_names()`, a trained policy's ``.safetensors`` file, or the folder of a training run; with
            `POLISH` at its end, local search improves the plan and has most of the budget.
        seed: see `SolverOptions`, as for all that follow.
        decode: how learned methods choose.
        samples: missions that sampling draws in one go, or the width of the beam.
        budget: seconds a scenario for methods that search.
        mask_rule: what robots may choose.
        threads: searches that local search carries on at a time, if there is a budget.

    Raises:
        ConfigError: if there is no such method, or an option is out of range.
        MissingExtraError: if the method needs what is not installed.
    """
    polished = name.endswith(POLISH)
    options = SolverOptions(
        seed=seed,
        decode="greedy" if polished and decode is None and samples is None else decode,
        samples=samples,
        budget=budget,
        mask_rule=mask_rule,
        threads=threads,
    )
    return _polished(name.removesuffix(POLISH), options) if polished else _make(name, options)


def _polished(name: str, options: SolverOptions) -> Solver:
    require("solvers", f"method {name + POLISH!r}")
    from mrta_zoo.policies.classical.local_search.polish import METHOD_SHARE, PolishedSolver

    share = None if options.budget is None else METHOD_SHARE * options.budget
    return PolishedSolver(_make(name, replace(options, budget=share)), options.seed, options.budget, options.threads)


def _make(name: str, options: SolverOptions) -> Solver:
    if name in METHODS:
        method = METHODS[name]
        if method.extra is not None:
            require(method.extra, f"method {name!r}")
        return method.make(options)
    check_no_url(name, ConfigError)
    names = method_names()
    if name not in names and suffix_of(name) != SUFFIX and not os.path.isdir(name):
        raise ConfigError(
            f"there is no method {name!r}; expected one of {', '.join(names)}, a .safetensors file, or the folder of a "
            f"training run, {POLISH} added if wanted"
        )
    return LearnedSolver(load_learned(name), options)


def load_learned(name: str) -> NeuralPolicy:
    """A trained policy, by name or path.

    Raises:
        ConfigError: if there is none, or its files are damaged.
        MissingExtraError: if torch is not installed.
    """
    require("torch", f"method {name!r}")
    from mrta_zoo.policies.neural.policy import load_policy

    return load_policy(name)
