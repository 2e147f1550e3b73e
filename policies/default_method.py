"""Which method plans a mission if none is named: the best that is installed."""

from __future__ import annotations

from mrta_zoo.errors import MissingExtraError
from mrta_zoo.extras import require
from mrta_zoo.policies.registry import METHODS

BEST_FIRST = ("eils", "pyvrp", "capam-plus", "nearest")
"""By the tasks that they complete, and then by the time that they take. The last needs nothing."""


def default_method() -> tuple[str, str]:
    """The first of `BEST_FIRST` that can be had here, and what the very first is missing, in a sentence.

    Returns:
        The method's name, and the sentence; empty if it is the first.
    """
    missing = ""
    for name in BEST_FIRST:
        extra = METHODS[name].extra if name in METHODS else "torch"  # trained policies are no entries there
        try:
            if extra is not None:
                require(extra, f"method {name!r}")
        except MissingExtraError as error:
            missing = missing or str(error)
            continue
        break
    return name, missing
