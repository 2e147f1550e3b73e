"""The method that plans a mission if none is named: the best one that is installed."""

from __future__ import annotations

from mrta_zoo.errors import MissingExtraError
from mrta_zoo.extras import require
from mrta_zoo.policies.registry import METHODS

BEST_FIRST = ("eils", "pyvrp", "capam-plus", "nearest")
"""Ranked by the tasks that they complete, then by the time that they take. The last has no optional dependency."""


def default_method() -> tuple[str, str]:
    """The first of `BEST_FIRST` whose dependencies are installed, and why it is not the very first.

    Returns:
        The method's name, and a sentence that says what the very first is missing; empty if this is the first.
    """
    missing = ""
    for name in BEST_FIRST:
        extra = METHODS[name].extra if name in METHODS else "torch"  # trained policies are not in the table
        try:
            if extra is not None:
                require(extra, f"method {name!r}")
        except MissingExtraError as error:
            missing = missing or str(error)
            continue
        break
    return name, missing
