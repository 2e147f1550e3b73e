"""What the reports of all studies have in common: how the study was made, and which arms have hardly been trained."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from statistics import fmean

from mrta_zoo import __version__
from mrta_zoo.eval.plot_history import LearningCurve
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.parts import Report, Section
from mrta_zoo.eval.studies.study import Study

HARDLY = 1.0
"""Percentage points of validation completion; an arm that training has improved by less has hardly been trained."""


def study_report(
    study: Study,
    *,
    title: str,
    summary: Iterable[str],
    sections: Iterable[Section],
    flags: Sequence[str],
    each_run: str,
    scores: str,
) -> Report:
    """A study as a report.

    Args:
        study: what was asked, and what was found.
        title: on top.
        summary: one point each.
        sections: in order.
        flags: the settings that make the study again, as flags of its command.
        each_run: how each run was trained.
        scores: how plans were made and scored.
    """
    manifest = study.manifest
    return Report(
        title=title,
        summary=(*summary, *warning(hardly_trained(study.design.arms, study.curves))),
        sections=tuple(sections),
        made=(
            ("Command", f"mrta-zoo {manifest.command} --out DIR {_shown(manifest.settings, flags)}"),
            ("Version", f"mrta_zoo {__version__}"),
            ("Seeds", f"0 to {study.design.seeds - 1}, of weights, training scenarios and samples"),
            ("Each run", each_run),
            ("Held-out scenarios", f"SHA-256 {manifest.cases}"),
            ("Scores", scores),
            *(
                (f"Trained from {machine.started}", machine.described("one torch thread a process"))
                for machine in study.machines
            ),
        ),
    )


def hardly_trained(names: Iterable[str], curves: Mapping[tuple[str, int], LearningCurve]) -> list[str]:
    """Arms whose best validation is, in the mean over runs, hardly better than that before the first update.

    Nobody shall take them for what they could become.

    Args:
        names: of the arms.
        curves: of each (arm, seed).
    """
    found = []
    for name in names:
        gains = [
            100 * (max(curve.completion) - curve.completion[0]) for (arm, _), curve in curves.items() if arm == name
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


def _shown(settings: Mapping[str, object], flags: Sequence[str]) -> str:
    def text(value: object) -> str:
        return ",".join(value) if isinstance(value, list) else str(value)

    return " ".join(f"--{name.replace('_', '-')} {text(settings[name])}" for name in flags)
