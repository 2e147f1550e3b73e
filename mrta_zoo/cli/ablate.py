"""The command ``mrta-zoo ablate``: what is trained, on how many processes, and what becomes of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Annotated

from tyro.conf import arg

from mrta_zoo.cli.flags import names, parse
from mrta_zoo.eval.experiment import make_manifest, resumable
from mrta_zoo.eval.report.files import publish
from mrta_zoo.eval.studies.ablation.questions import QUESTIONS, needed
from mrta_zoo.eval.studies.ablation.report import make_report
from mrta_zoo.eval.studies.ablation.study import Study
from mrta_zoo.eval.studies.ablation.variants import ROBOTS, Budget, all_variants
from mrta_zoo.eval.studies.held_out import HeldOut
from mrta_zoo.eval.studies.job import Job
from mrta_zoo.eval.studies.study import check_counts, choose, perform_study, read_curves
from mrta_zoo.io import Case

USUAL = Budget()


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
    paper_updates: int = USUAL.paper_updates
    """Gradient steps of each run with the paper's decoder, which takes about a fifth of the time a step."""
    scenarios: int = USUAL.scenarios
    """Scenarios an update."""
    samples: int = USUAL.samples
    """Missions sampled of each scenario."""
    tasks: int = USUAL.tasks
    """Tasks of a scenario, which 1 to 4 robots share."""
    held_out: int = 64
    """Scenarios to compare on, for each distribution and number of robots (1, 2, 4)."""
    workers: int = 2
    """Runs at a time, each a process with one CPU thread. Results do not depend on it."""


@resumable()
def ablate_command(argv: Sequence[str]) -> None:
    """Run `mrta-zoo ablate` with these arguments.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or training diverges.
    """
    command = parse(Ablate, argv, "ablate")
    check_counts(command.seeds, command.workers)
    questions = choose(names(command.only, "only", "questions", "encoder,moments"), QUESTIONS)
    budget = Budget(
        updates=command.updates,
        paper_updates=command.paper_updates,
        scenarios=command.scenarios,
        samples=command.samples,
        tasks=command.tasks,
    )
    held_out = HeldOut(command.tasks, command.held_out, ROBOTS)
    evaluated = needed(questions)
    every = all_variants(budget)
    jobs = [
        Job(
            variant=variant.name,
            folder=command.out / "runs" / f"{variant.name}-seed{seed}",
            config=replace(variant.config, seed=seed),
            held_out=held_out,
            distributions=evaluated[variant.name],
        )
        for variant in every.values()
        if variant.name in evaluated
        for seed in range(command.seeds)
    ]
    settings = {"only": [question.name for question in questions], "seeds": command.seeds, **asdict(budget),
                "held_out": command.held_out}  # fmt: skip
    distributions = dict.fromkeys(each for question in questions for each in question.distributions)
    cases = [
        Case(scenario.name, scenario)
        for distribution in distributions
        for robots in ROBOTS
        for scenario in held_out.scenarios(distribution, robots)
    ]
    manifest = make_manifest("ablate", settings, cases, [])
    rows, sessions = perform_study(command.out, manifest, jobs, command.workers)
    study = Study(
        questions=questions,
        variants={name: every[name] for name in evaluated},
        budget=budget,
        seeds=command.seeds,
        rows=rows,
        curves=read_curves(jobs),
    )
    publish(make_report(study, manifest, sessions), command.out)
