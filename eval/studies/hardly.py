"""Which variants of a study have hardly been trained, so that nobody takes them for what they could become."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from statistics import fmean

from mrta_zoo.eval.plot_history import LearningCurve
from mrta_zoo.eval.report import wording

HARDLY = 1.0
"""Percentage points of validation completion; a variant that training has improved by less has hardly been trained."""


def hardly_trained(names: Iterable[str], curves: Mapping[tuple[str, int], LearningCurve]) -> list[str]:
    """Variants whose best validation is, in the mean over runs, hardly better than that before the first update.

    Args:
        names: of the variants.
        curves: of each (variant, seed).
    """
    found = []
    for name in names:
        gains = [
            100 * (max(curve.completion) - curve.completion[0])
            for (variant, _), curve in curves.items()
            if variant == name
        ]
        if fmean(gains) < HARDLY:
            found.append(name)
    return found


def warning(found: list[str]) -> list[str]:
    """A sentence for a report's summary, if there is cause for one."""
    if not found:
        return []
    return [
        f"Beware: {wording.listed(found)} {'were' if len(found) > 1 else 'was'} hardly trained in so few updates: "
        f"validation gained less than {HARDLY:g} point. What is said of differences between such variants holds for "
        "networks about as they start, and is no answer to what a part is worth once trained; more --updates are."
    ]
