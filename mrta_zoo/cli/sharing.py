"""The command ``mrta-zoo sharing``: what is trained, on how many processes, and what becomes of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated

from tyro.conf import arg

from mrta_zoo.cli.flags import names, parse
from mrta_zoo.eval.experiment import make_manifest, resumable
from mrta_zoo.eval.report.files import publish
from mrta_zoo.eval.studies.held_out import HeldOut
from mrta_zoo.eval.studies.job import Job
from mrta_zoo.eval.studies.sharing.arms import QUESTIONS, TRAINED_ROBOTS, UNSEEN_ROBOTS, Budget, needed
from mrta_zoo.eval.studies.sharing.report import make_report
from mrta_zoo.eval.studies.sharing.study import DISTRIBUTION, Study
from mrta_zoo.eval.studies.study import check_counts, choose, perform_study, read_curves
from mrta_zoo.io import Case

USUAL = Budget()


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """Should robots share one policy? Train it shared, by kind of robot and one for each robot, and write a report.

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
    """What to compare at: equal episodes, or equal decisions a network."""
    seeds: int = 3
    """Runs of each kind, with seeds 0, 1, …; with one there are no intervals."""
    updates: int = USUAL.updates
    """Gradient steps of each run."""
    scenarios: int = USUAL.scenarios
    """Scenarios an update, a multiple of 4; for equal decisions the shared network gets a quarter of them."""
    samples: int = USUAL.samples
    """Missions sampled of each scenario."""
    tasks: int = USUAL.tasks
    """Tasks of a scenario."""
    held_out: int = 64
    """Scenarios to compare on, for each number of robots."""
    workers: int = 2
    """Runs at a time, each a process with one CPU thread. Results do not depend on it."""


@resumable()
def sharing_command(argv: Sequence[str]) -> None:
    """Run `mrta-zoo sharing` with these arguments.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or training diverges.
    """
    command = parse(Share, argv, "sharing")
    check_counts(command.seeds, command.workers)
    questions = choose(names(command.only, "only", "questions", "episodes,decisions"), QUESTIONS)
    budget = Budget(updates=command.updates, scenarios=command.scenarios, samples=command.samples, tasks=command.tasks)
    arms = needed(questions, budget)
    every = HeldOut(command.tasks, command.held_out, tuple(sorted({*TRAINED_ROBOTS, *UNSEEN_ROBOTS})))
    jobs = [
        Job(
            variant=arm.name,
            folder=command.out / "runs" / f"{arm.name}-seed{seed}",
            config=replace(arm.config, seed=seed),
            held_out=replace(every, robots=arm.robots),
            distributions=(DISTRIBUTION,),
        )
        for seed in range(command.seeds)  # all arms with a seed before the next one
        for arm in arms.values()
    ]
    settings = {"only": [question.name for question in questions], "seeds": command.seeds, **asdict(budget),
                "held_out": command.held_out}  # fmt: skip
    cases = [
        Case(scenario.name, scenario) for robots in every.robots for scenario in every.scenarios(DISTRIBUTION, robots)
    ]
    manifest = make_manifest("sharing", settings, cases, [])
    rows, sessions = perform_study(command.out, manifest, jobs, command.workers)
    study = Study(
        questions=questions,
        arms={name: arms[name] for question in questions for name in question.arms},
        budget=budget,
        seeds=command.seeds,
        held_out=every,
        rows=rows,
        curves=read_curves(jobs),
        folders={(job.variant, job.seed): job.folder for job in jobs},
    )
    publish(make_report(study, manifest, sessions), command.out)
