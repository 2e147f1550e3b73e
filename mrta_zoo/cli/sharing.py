"""The command ``mrta-zoo sharing``."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated

from tyro.conf import arg

from mrta_zoo.cli.flags import names, takes_flags
from mrta_zoo.eval.experiment import resumable
from mrta_zoo.eval.report.files import publish
from mrta_zoo.eval.studies.sharing import QUESTIONS, USUAL, sharing, sharing_report
from mrta_zoo.eval.studies.study import perform_study


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """Should robots share one policy? Train it shared, one per kind and one per robot, and write a report.

    All else is equal: architecture, plain REINFORCE on TAPTC-like scenarios with 2 to 4 robots of capacities 1 and 2,
    and either the episodes or the decisions that a network learns from. After an interruption the same command goes on
    where it stopped.

    For example:
      mrta-zoo sharing --out sharing
      mrta-zoo sharing --out sharing --only episodes --seeds 5 --workers 8
    """

    out: Annotated[Path, arg(metavar="DIR")]
    """Folder for runs, rows, report and pictures; new, empty, or of the same command."""
    only: Annotated[str, arg(metavar="QUESTION,QUESTION")] = ",".join(QUESTIONS)
    """What to compare at: equal episodes, or equal decisions per network."""
    seeds: int = 3
    """Runs of each kind, with seeds 0, 1, …; with one there are no intervals."""
    updates: int = USUAL.updates
    """Gradient steps of each run."""
    scenarios: int = USUAL.scenarios
    """Scenarios per update, a multiple of 4; for equal decisions the shared network gets a quarter of them."""
    samples: int = USUAL.samples
    """Missions sampled of each scenario."""
    tasks: int = USUAL.tasks
    """Tasks of a scenario."""
    held_out: int = 64
    """Scenarios to compare on, for each number of robots."""
    workers: int = 2
    """Runs at a time, each a process with one CPU thread. Results do not depend on it."""


@resumable()
@takes_flags
def sharing_command(command: Share) -> None:
    """Train the arms and publish the report.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or training diverges.
    """
    design = sharing(
        names(command.only, "only", "questions", "episodes,decisions"),
        command.seeds,
        replace(
            USUAL,
            updates=command.updates,
            scenarios=command.scenarios,
            samples=command.samples,
            tasks=command.tasks,
        ),
        command.held_out,
    )
    publish(sharing_report(perform_study(design, command.out, command.workers)), command.out)
