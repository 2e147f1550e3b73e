"""The command ``mrta-zoo ablate``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

from tyro.conf import arg

from mrta_zoo.cli.flags import names, takes_flags
from mrta_zoo.eval.experiment import resumable
from mrta_zoo.eval.report.files import publish
from mrta_zoo.eval.studies.ablation import PAPER_UPDATES, QUESTIONS, USUAL, ablation
from mrta_zoo.eval.studies.report import study_report
from mrta_zoo.eval.studies.study import perform_study


@dataclass(frozen=True, slots=True, kw_only=True)
class Ablate:
    """Train variants that differ in one thing each, compare them on held-out scenarios, and write a report.

    It asks what encoder, P, decision-time features, baseline, mask rule and training distribution are worth, and
    whether the claims of the CapAM paper show. After an interruption the same command goes on where it stopped.

    For example:
      mrta-zoo ablate --out ablation
      mrta-zoo ablate --out ablation --only encoder,moments --seeds 5 --workers 8
    """

    out: Annotated[Path, arg(metavar="DIR")]
    """Folder for runs, rows, report and pictures; new, empty, or of the same command."""
    only: Annotated[str, arg(metavar="QUESTION,QUESTION,…")] = ",".join(QUESTIONS)
    """What to ask."""
    seeds: int = 2
    """Runs of each variant, with seeds 0, 1, …; with one there are no intervals."""
    updates: int = USUAL.updates
    """Gradient steps of each run with the candidate decoder."""
    paper_updates: int = PAPER_UPDATES
    """Gradient steps of each run with the paper's decoder, which takes about a fifth of the time per step."""
    scenarios: int = USUAL.scenarios
    """Scenarios per update."""
    samples: int = USUAL.samples
    """Missions sampled of each scenario."""
    tasks: int = USUAL.tasks
    """Tasks of a scenario, which 1 to 4 robots share."""
    held_out: int = 64
    """Scenarios to compare on, for each distribution and number of robots (1, 2, 4)."""
    workers: int = 2
    """Runs at a time, each a process with one CPU thread. Results do not depend on it."""


@resumable()
@takes_flags
def ablate_command(command: Ablate) -> None:
    """Train the variants and publish the report.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or training diverges.
    """
    design = ablation(
        names(command.only, "only", "questions", "encoder,moments"),
        command.seeds,
        replace(
            USUAL,
            updates=command.updates,
            scenarios=command.scenarios,
            samples=command.samples,
            tasks=command.tasks,
        ),
        command.paper_updates,
        command.held_out,
    )
    publish(study_report(perform_study(design, command.out, command.workers)), command.out)
