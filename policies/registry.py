"""Every method that can plan a mission, by name. To add one, add an entry to `METHODS`.

Importing this imports no optional dependency: those of a method are imported when it is made.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from pkgutil import resolve_name

from mrta_zoo.errors import ConfigError
from mrta_zoo.extras import require
from mrta_zoo.io.paths import check_no_url, suffix_of
from mrta_zoo.policies.aec_loop import PolicySolver
from mrta_zoo.policies.classical.heuristics import EarliestDeadlinePolicy, NearestPolicy, RandomPolicy
from mrta_zoo.policies.neural.learned_solver import LearnedSolver, load_learned
from mrta_zoo.policies.neural.policy_files import SUFFIX
from mrta_zoo.policies.options import Decode, SolverOptions
from mrta_zoo.policies.pretrained import pretrained_names
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.rules import MaskRule


@dataclass(frozen=True, slots=True)
class Method:
    """An entry of the table.

    Attributes:
        summary: what the method does, in a few words; shown in the help.
        make: makes the solver from the options.
        uses: options that have an effect on it, of those that are None by default.
        extra: the extra of the package that it needs, one of `extras.EXTRAS`.
    """

    summary: str
    make: Callable[[SolverOptions], Solver]
    uses: frozenset[str] = frozenset()
    extra: str | None = None


def imported(solver: str, *options: str) -> Callable[[SolverOptions], Solver]:
    """Makes a solver of this package that is imported only then.

    Args:
        solver: its module within `policies.classical` and its class, as "module:Class".
        options: the fields of `SolverOptions` that the class takes, by the same names.
    """

    def make(given: SolverOptions) -> Solver:
        made: Solver = resolve_name(f"mrta_zoo.policies.classical.{solver}")(**{o: getattr(given, o) for o in options})
        return made

    return make


RULE, BUDGET = frozenset({"mask_rule"}), frozenset({"budget"})

METHODS: dict[str, Method] = {
    "random": Method(
        "a random feasible task",
        lambda options: PolicySolver(lambda: RandomPolicy(options.seed), options, "random"),
        RULE,
    ),
    "nearest": Method(
        "the nearest feasible task",
        lambda options: PolicySolver(NearestPolicy, options, "nearest"),
        RULE,
    ),
    "edf": Method(
        "the feasible task with the earliest deadline",
        lambda options: PolicySolver(EarliestDeadlinePolicy, options, "edf"),
        RULE,
    ),
    "big-mrta": Method(
        "a maximum-weight matching of robots and tasks at each decision",
        imported("big_mrta:BigMrtaSolver"),
        extra="solvers",
    ),
    "ils": Method(
        "iterated local search (Vansteenwegen et al. 2009), compiled",
        imported("local_search.ils:IlsSolver", "budget"),
        BUDGET,
        extra="solvers",
    ),
    "eils": Method(
        "local search in the spirit of EILS (details unknown): removes strings of visits and refills the tours",
        imported("local_search.eils:EilsSolver", "seed", "budget", "threads"),
        BUDGET,
        extra="solvers",
    ),
    "exact": Method(
        "a provably largest number of tasks; for small missions",
        imported("exact.solver:ExactSolver", "budget"),
        BUDGET,
        extra="solvers",
    ),
    "pyvrp": Method(
        "the routing solver PyVRP; it searches until the budget ends or several searches have stalled",
        imported("pyvrp_solver:PyVrpSolver", "seed", "budget"),
        BUDGET,
        extra="pyvrp",
    ),
}
"""Methods that need no training. The policies that ship with the package are methods, too: see `method_names`."""

LEARNED = frozenset({"decode", "samples", "budget", "mask_rule"})
"""Options that have an effect on trained policies."""

POLISH = "+polish"
"""Suffix of a method's name that has local search improve its plan."""


def method_names() -> list[str]:
    """The names that `make_solver` knows: `METHODS`, then the trained policies that ship with the package."""
    return [*METHODS, *pretrained_names()]


def used_options(name: str) -> frozenset[str]:
    """The options that have an effect on a method, of those that are None by default."""
    if name.endswith(POLISH):
        return used_options(name.removesuffix(POLISH)) | BUDGET
    return METHODS[name].uses if name in METHODS else LEARNED


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
        name: one of `method_names()`, a trained policy's ``.safetensors`` file, or the folder of a training run. With
            `POLISH` at its end, local search improves the plan and has most of the budget.
        seed: see `SolverOptions`, as for all that follow.
        decode: how learned methods choose.
        samples: number of missions that sampling draws in one go, or the width of the beam.
        budget: seconds per scenario for methods that search.
        mask_rule: what robots may choose.
        threads: number of parallel local searches, if there is a budget.

    Raises:
        ConfigError: if there is no such method, or an option is out of range.
        MissingExtraError: if an optional dependency of the method is not installed.
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
