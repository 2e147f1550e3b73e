"""The command ``mrta-zoo converge``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any

import pandas as pd
from tyro.conf import arg

from mrta_zoo.cli.case_choice import read_all, shown_cases
from mrta_zoo.cli.flags import names, optional, parse
from mrta_zoo.digits import full, percentage, rounded
from mrta_zoo.errors import ConfigError, MissingExtraError
from mrta_zoo.eval.converge.curves import BudgetRow, curves_of, draw_curves
from mrta_zoo.eval.experiment import make_manifest, measure, open_experiment, resumable
from mrta_zoo.eval.machine import Session, this_session
from mrta_zoo.eval.report import wording
from mrta_zoo.eval.report.figure_style import save_figure
from mrta_zoo.eval.rows_file import RowsFile
from mrta_zoo.eval.runner import Solved, row_of
from mrta_zoo.io import Case
from mrta_zoo.io.outputs import Outputs
from mrta_zoo.io.source import write_text
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.policies.registry import POLISH, make_solver, method_names
from mrta_zoo.show.terminal.console import results_console, say
from mrta_zoo.show.terminal.sheet import Sheet
from mrta_zoo.wording import composed

USUAL = ("ils", "eils", "pyvrp", "capam-plus", f"capam-plus{POLISH}")
USUAL_POINTS = ("nearest", "capam")


@dataclass(frozen=True, slots=True, kw_only=True)
class Converge:
    """Measure how many tasks are completed after how much planning time, and draw it.

    Methods that can search for longer get a line over all budgets; methods without a budget a point at the time that
    they take. After an interruption the same command goes on where it stopped.

    For example:
      mrta-zoo converge --cases builtin --every 4 --out convergence
      mrta-zoo converge --cases taptc/n100 --methods capam-plus --budgets 0.1,1,10 --out convergence
    """

    cases: Annotated[str, arg(metavar="DIR,DIR,…|builtin")]
    """Folders of cases, as for `mrta-zoo eval`; or builtin: 96 drawn cases with 100 tasks and 96 with 200."""
    out: Annotated[Path, arg(metavar="DIR")]
    """Folder for rows, curves and figure; new, empty, or of the same command."""
    methods: Annotated[str | None, optional("METHOD,METHOD,…")] = None
    """Methods that search, trained ones by sampling. By default ils, eils, pyvrp, capam-plus, and its greedy plan
    polished by local search, as far as they are there."""
    points: Annotated[str | None, optional("METHOD,METHOD,…")] = None
    """Methods without a budget, trained ones greedy; nearest and capam by default."""
    budgets: Annotated[str, arg(metavar="SECONDS,SECONDS,…")] = "0.1,0.3,1,3,10"
    """Seconds a case."""
    every: int = 1
    """Only every so many-th case of each number of tasks and robots."""
    seed: int = 0
    """Of everything drawn at random, the bootstrap included."""
    threads: int = 1
    """CPU threads for trained methods, and searches at a time for eils and polishing."""


@resumable()
def converge_command(argv: Sequence[str]) -> None:
    """Run `mrta-zoo converge` with these arguments.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    command = parse(Converge, argv, "converge")
    budgets = seconds_of(command.budgets)
    methods = _usual(USUAL) if command.methods is None else names(command.methods)
    points = _usual(USUAL_POINTS) if command.points is None else names(command.points)
    cases = every_of_each_size(read_all(command.cases), command.every)
    # Under their names as rows have them.
    plan: list[tuple[float | None, dict[str, Solver]]] = [
        (None, {composed(name): make_solver(name, seed=command.seed) for name in points})
    ]
    for seconds in budgets:
        options: dict[str, Any] = {"seed": command.seed, "budget": seconds, "threads": command.threads}
        plan.append((seconds, {composed(name): make_solver(name, **options) for name in methods}))
    settings = {"cases": shown_cases(command.cases), "methods": methods, "points": points, "budgets": budgets,
                "every": command.every, "seed": command.seed, "threads": command.threads}  # fmt: skip
    manifest = make_manifest("converge", settings, cases, dict.fromkeys((*methods, *points)))
    with cpu_threads(command.threads):
        open_experiment(command.out, manifest)
        rows = RowsFile(command.out / "rows.csv", BudgetRow)
        sessions = RowsFile(command.out / "sessions.csv", Session)
        if len(rows.rows) < len(cases) * sum(len(solvers) for _, solvers in plan):
            sessions.append(this_session(command.threads))
        for budget, solvers in plan:
            _measure(cases, solvers, rows, budget)
    order: list[tuple[str, float | None]] = [(composed(name), None) for name in points]
    order += [(composed(name), seconds) for name in methods for seconds in budgets]
    curves = curves_of(rows.rows, order, command.seed)
    text = curves.to_csv(index=False, lineterminator="\n")
    with Outputs() as outputs:
        outputs.write("data", command.out / "curves.csv", lambda path: write_text(text, path, ConfigError))
        outputs.write(
            "figure", command.out / "curves.png", lambda path: save_figure(draw_curves(curves), path.with_suffix(""))
        )
        _tell(curves, outputs)


def _tell(curves: pd.DataFrame, outputs: Outputs) -> None:
    console = results_console()
    console.print(
        Sheet(
            f"Tasks completed, mean % with its {wording.INTERVAL} over cases; budget and time taken in seconds",
            ("tasks", "method", "budget", "took", "completed", "cases"),
            [
                (
                    str(line["tasks"]), line["method"], _number(line["budget"]), rounded(line["mean_seconds"], 3),
                    f"{percentage(line['mean_percent'])} [{_ends(line)}]", str(line["cases"]),
                )
                for line in curves.to_dict("records")
            ],
            left=("method",),
        ),
        crop=False,
    )  # fmt: skip
    say(
        console,
        "The cases are the same for all methods: a difference between two methods can be sure even where their "
        "intervals overlap (mrta-zoo reproduce tests it).",
    )
    for line in outputs.written:
        say(console, line)


def _measure(
    cases: Sequence[Case], solvers: dict[str, Solver], rows: RowsFile[BudgetRow], budget: float | None
) -> None:
    def record(case: Case, method: str, solved: Solved) -> BudgetRow:
        return BudgetRow(**asdict(row_of(case, method, solved)), budget=budget)

    def known(row: BudgetRow) -> tuple[str, str] | None:
        return (row.case, row.method) if row.budget == budget else None

    measure(cases, solvers, rows, record, known, "" if budget is None else f"{budget:g} s: ")


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


def every_of_each_size(cases: Sequence[Case], every: int) -> list[Case]:
    """The first, and then every `every`-th case of each number of tasks and robots, in the same order.

    Raises:
        ConfigError: if `every` is not positive.
    """
    if every < 1:
        raise ConfigError(f"every is {every}; expected a whole number >= 1")
    seen: dict[tuple[int, int], int] = {}
    chosen = []
    for case in cases:
        size = case.scenario.num_tasks, case.scenario.num_robots
        if seen.setdefault(size, 0) % every == 0:
            chosen.append(case)
        seen[size] += 1
    return chosen


def _usual(wanted: Sequence[str]) -> list[str]:
    """Those methods that this version has and this installation can run."""
    found = []
    for name in wanted:
        if name.removesuffix(POLISH) in method_names():
            try:
                make_solver(name)
            except MissingExtraError:
                continue
            found.append(name)
    return found


def _number(value: float) -> str:
    return wording.DASH if value != value else full(value)


def _ends(line: dict[str, float | None]) -> str:
    low, high = line["low"], line["high"]
    return str(line["note"]) if low is None or low != low or high is None else f"{percentage(low)}, {percentage(high)}"
