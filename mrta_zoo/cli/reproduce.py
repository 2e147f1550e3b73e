"""The command ``mrta-zoo reproduce``."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from tyro.conf import arg

from mrta_zoo.cli.cases import read_all, shown_cases
from mrta_zoo.cli.flags import names, optional, takes_flags
from mrta_zoo.eval.experiment import resumable
from mrta_zoo.eval.report.files import publish
from mrta_zoo.eval.reproduce.experiment import reproduce


@dataclass(frozen=True, slots=True, kw_only=True)
class Reproduce:
    """Run the experiments of the CapAM paper and write a report: HTML, Markdown, pictures, and CSV files behind them.

    Completion by number of robots (Fig. 3), planning time (Table II), paired tests (Table III), P = 1, 2, 3 and AM at
    one and two times the size (Table IV), share of the best known plan, and optimality gaps on 60 small scenarios,
    where the method exact is there. After an interruption the same command goes on where it stopped.

    For example:
      mrta-zoo reproduce --cases suite-100,suite-200 --out report
      mrta-zoo reproduce --cases taptc/n100,taptc/n200 --methods nearest,capam,runs/mine --out report
    """

    cases: Annotated[str, arg(metavar="DIR|SUITE,…")]
    """Folders of cases, as for `mrta-zoo eval`, and built-in suites: suite-100 (or builtin), 96 cases with 100 tasks
    and 2 to 7 robots, and suite-200, 96 cases with 200 tasks and 4 to 14."""
    out: Annotated[Path, arg(metavar="DIR")]
    """Folder of the report; new, empty, or of the same command."""
    methods: Annotated[str | None, optional("METHOD,METHOD,…")] = None
    """What to compare. By default every method that there is: random, nearest, edf, big-mrta, ils, eils, pyvrp, and the
    trained policies that ship with the package, which choose greedily."""
    against: Annotated[str | None, optional("METHOD")] = None
    """The method that the others are tested against; capam by default or, if it is not run, the last method."""
    budget: Annotated[float | None, optional("SECONDS")] = None
    """Seconds per case for methods that search. By default they stop by themselves, and pyvrp, which does not, has
    2."""
    seed: int = 0
    """Of everything drawn at random, the bootstrap included."""
    threads: int = 1
    """CPU threads for trained methods, and searches at a time for eils and polishing."""


@resumable()
@takes_flags
def reproduce_command(command: Reproduce) -> None:
    """Run the methods and publish the report.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    report = reproduce(
        command.out,
        read_all(command.cases),
        shown_cases(command.cases),
        methods=None if command.methods is None else names(command.methods),
        against=command.against,
        budget=command.budget,
        seed=command.seed,
        threads=command.threads,
    )
    publish(report, command.out)
