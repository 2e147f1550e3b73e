"""The command ``mrta-zoo converge``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from tyro.conf import arg

from mrta_zoo.cli.cases import read_all, shown_cases
from mrta_zoo.cli.flags import names, optional, takes_flags
from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.converge.experiment import converge
from mrta_zoo.eval.experiment import resumable
from mrta_zoo.eval.report.files import publish


@dataclass(frozen=True, slots=True, kw_only=True)
class Converge:
    """Measure how many tasks are completed after how much planning time, and draw it.

    Methods that can search for longer get a line over all budgets; methods without a budget a point at the time that
    they take. After an interruption the same command goes on where it stopped.

    For example:
      mrta-zoo converge --cases suite-100,suite-200 --every 8 --out convergence
      mrta-zoo converge --cases taptc/n100 --methods capam-plus --budgets 0.1,1,10 --out convergence
    """

    cases: Annotated[str, arg(metavar="DIR|SUITE,…")]
    """Folders of cases, as for `mrta-zoo eval`, and built-in suites: suite-100 (or builtin), 96 cases with 100 tasks,
    and suite-200, 96 cases with 200."""
    out: Annotated[Path, arg(metavar="DIR")]
    """Folder for rows, report and figure; new, empty, or of the same command."""
    methods: Annotated[str | None, optional("METHOD,METHOD,…")] = None
    """Methods that search, trained ones by sampling. By default ils, eils, pyvrp, capam-plus, and its greedy plan
    polished by local search, as far as they are there."""
    points: Annotated[str | None, optional("METHOD,METHOD,…")] = None
    """Methods without a budget, trained ones greedy; nearest and capam by default."""
    budgets: Annotated[str, arg(metavar="SECONDS,SECONDS,…")] = "0.1,0.3,1,3,10"
    """Seconds per case."""
    every: int = 1
    """Only every so many-th case of each number of tasks and robots."""
    seed: int = 0
    """Of everything drawn at random, the bootstrap included."""
    threads: int = 1
    """CPU threads for trained methods, and searches at a time for eils and polishing."""


@resumable()
@takes_flags
def converge_command(command: Converge) -> None:
    """Measure the curves and publish them.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    report = converge(
        command.out,
        read_all(command.cases),
        shown_cases(command.cases),
        seconds_of(command.budgets),
        methods=None if command.methods is None else names(command.methods),
        points=None if command.points is None else names(command.points),
        every=command.every,
        seed=command.seed,
        threads=command.threads,
    )
    publish(report, command.out)


def seconds_of(text: str) -> list[float]:
    """Budgets, in rising order.

    Raises:
        ConfigError: if one is no number of seconds > 0, or is there twice.
    """
    found = []
    for each in names(text, "budgets", "seconds", "0.1,1,10"):
        try:
            seconds = float(each)
        except ValueError:
            seconds = float("nan")
        if not 0 < seconds < float("inf"):
            raise ConfigError(f"budgets has {each!r}; expected numbers of seconds > 0, such as 0.1,1,10")
        found.append(seconds)
    return sorted(set(found))
