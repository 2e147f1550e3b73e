"""Which methods are compared, and what they get."""

from __future__ import annotations

from collections.abc import Sequence

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.runner import those_there
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.policies.registry import make_solver, method_names

USUAL = (
    "random", "nearest", "edf", "big-mrta", "ils", "eils", "pyvrp",
    "am", "capam-p1", "capam-p2", "capam", "capam-plus",
)  # fmt: skip
"""What is compared unless the user says otherwise, in the order of the report: those of them that there are."""
PYVRP_SECONDS = 2.0
"""For PyVRP, which never stops by itself, if no budget is given."""
AGAINST = "capam"


def usual_methods(absent: dict[str, str]) -> list[str]:
    """The methods compared by default. Those that cannot be made go to `absent` with the reason."""
    shipped = [name for name in method_names() if name.startswith(("am", "capam")) and name not in USUAL]
    return those_there((*USUAL, *shipped), absent)


def reference_of(methods: Sequence[str], asked: str | None) -> str:
    """The method that the others are compared with.

    Raises:
        ConfigError: if it was asked for and is not run.
    """
    if asked is not None and asked not in methods:
        raise ConfigError(f"against is {asked!r}; expected one of the methods that are run: {', '.join(methods)}")
    return asked or (AGAINST if AGAINST in methods else methods[-1])


def solver_of(method: str, budget: float | None, seed: int, threads: int) -> Solver:
    """A method as it is compared: trained ones choose greedily."""
    seconds = PYVRP_SECONDS if method == "pyvrp" and budget is None else budget
    return make_solver(method, seed=seed, decode="greedy", budget=seconds, threads=threads)
