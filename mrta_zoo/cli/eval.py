"""The command ``mrta-zoo eval``."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from tyro.conf import arg

from mrta_zoo.cli.cases import read_one, suite_named
from mrta_zoo.cli.flags import names, optional, takes_flags
from mrta_zoo.cli.methods import TRAINED_HELP, files_of_methods
from mrta_zoo.cli.planning import PlanningFlags
from mrta_zoo.eval.progress import evaluate_with_progress
from mrta_zoo.eval.table import summary_tables
from mrta_zoo.io.destination import check_outputs
from mrta_zoo.io.outputs import Outputs
from mrta_zoo.io.records import records_text, write_records
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.registry import method_names
from mrta_zoo.show.terminal.console import preparing, results_console, say
from mrta_zoo.wording import counted


@dataclass(frozen=True, slots=True, kw_only=True)
class Eval:
    """Compare methods on the same cases. The independent verifier scores every plan.

    Prints means by number of tasks and robots, and with --out writes one row per case and method. If the folder
    contains a reference.csv (columns case,tasks,robots and one per method with the tasks that it completed), also
    prints the share of the best known plan. The first plan of a trained network is not timed.

    For example:
      mrta-zoo eval --cases builtin --methods capam,nearest --out rows.csv
      mrta-zoo eval --cases taptc/n100 --methods capam,runs/mine --decode sample
    """

    cases: Annotated[str, arg(metavar="DIR|SUITE")]
    """A folder of cases (TAPTC: group*/NAME.txt with agent/NAME.txt or agent/a{n}i0{i}.txt; or .json or .csv
    scenarios), or a built-in suite: suite-100 (or builtin), 96 cases with 100 tasks and 2 to 7 robots, or suite-200,
    96 cases with 200 tasks and 4 to 14."""
    methods: Annotated[
        str, arg(metavar="METHOD,METHOD,…", help=f"The methods: {', '.join(method_names())}, {TRAINED_HELP}.")
    ] = "random,nearest,edf,capam,capam-plus"
    out: Annotated[Path | None, optional("ROWS.csv")] = None
    """Write the rows to this file at the end: case, method, tasks, robots, completed, completion (0 to 1), cost,
    distance, makespan, seconds."""
    planning: Annotated[PlanningFlags, arg(name="")] = field(default_factory=PlanningFlags)


@takes_flags
def eval_command(command: Eval) -> None:
    """Run the methods on the cases, write the rows, and print the tables.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    methods = names(command.methods)
    if command.out:
        inputs = {f"{path} of the cases": path for path in _files_of(command.cases)}
        check_outputs({"--out": command.out}, inputs | files_of_methods(methods))
    with preparing():
        solvers = {method: command.planning.solver(method) for method in methods}
    command.planning.warn_unused(methods)
    cases = read_one(command.cases)
    with cpu_threads(command.planning.threads):
        rows = evaluate_with_progress(cases, solvers)
    with Outputs() as outputs:
        lost = command.out and not outputs.write(
            counted(len(rows), "row"), command.out, lambda path: write_records(rows, path)
        )
        console = results_console()
        best_known = {case.name: case.best_known for case in cases if case.best_known is not None}
        for table in summary_tables(rows, best_known):
            console.print(table, crop=False)
        if lost:
            console.print(records_text(rows), soft_wrap=True)
        for line in outputs.written:
            say(console, line)


def _files_of(cases: str) -> list[Path]:
    return list(Path(cases).rglob("*")) if suite_named(cases) is None and os.path.isdir(cases) else []
