"""The command ``mrta-zoo reproduce``: what is run, on what, and what becomes of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, astuple, dataclass
from pathlib import Path
from typing import Annotated

from tyro.conf import arg

from mrta_zoo import __version__
from mrta_zoo.cli.case_choice import read_all, shown_cases
from mrta_zoo.cli.flags import names, optional, parse
from mrta_zoo.errors import ConfigError, MissingExtraError
from mrta_zoo.eval.experiment import Manifest, make_manifest, measure, open_experiment, resumable
from mrta_zoo.eval.machine import Session, this_session
from mrta_zoo.eval.report.files import publish
from mrta_zoo.eval.report.parts import Report
from mrta_zoo.eval.reproduce.all_pairs import compare_all
from mrta_zoo.eval.reproduce.comparison import compare, comparison_section
from mrta_zoo.eval.reproduce.completion import completion_section
from mrta_zoo.eval.reproduce.moments import moments_section
from mrta_zoo.eval.reproduce.optimality import EXACT, optimality_section
from mrta_zoo.eval.reproduce.share import share_section
from mrta_zoo.eval.reproduce.study import OptimalityRow, Study, frame_of
from mrta_zoo.eval.reproduce.summary import summary
from mrta_zoo.eval.reproduce.timing import timing_section
from mrta_zoo.eval.rows import Row
from mrta_zoo.eval.rows_file import RowsFile
from mrta_zoo.eval.runner import Solved, row_of
from mrta_zoo.eval.significance import LEVEL, RESAMPLES
from mrta_zoo.io import Case
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.policies.registry import METHODS, make_solver, method_names
from mrta_zoo.show.terminal.console import preparing
from mrta_zoo.suite import small_suite
from mrta_zoo.wording import composed

USUAL = (
    "random", "nearest", "edf", "big-mrta", "ils", "eils", "pyvrp",
    "am", "capam-p1", "capam-p2", "capam", "capam-plus",
)  # fmt: skip
"""What is compared unless the user says otherwise, in the order of the report: those of them that there are."""
PYVRP_SECONDS = 2.0
"""For PyVRP, which never stops by itself, if no budget is given."""
AGAINST = "capam"


@dataclass(frozen=True, slots=True, kw_only=True)
class Reproduce:
    """Run the experiments of the CapAM paper and write a report: HTML, Markdown, pictures, and CSV files behind them.

    Completion by number of robots (Fig. 3), planning time (Table II), paired tests (Table III), P = 1, 2, 3 and AM at
    one and two times the size (Table IV), share of the best known plan, and optimality gaps on 60 small scenarios,
    where the method exact is there. After an interruption the same command goes on where it stopped.

    For example:
      mrta-zoo reproduce --cases builtin --out report
      mrta-zoo reproduce --cases taptc/n100,taptc/n200 --methods nearest,capam,runs/mine --out report
    """

    cases: Annotated[str, arg(metavar="DIR,DIR,…|builtin")]
    """Folders of cases, as for `mrta-zoo eval`; or builtin: 96 drawn cases with 100 tasks and 2 to 7 robots, and 96
    with 200 tasks and 4 to 14."""
    out: Annotated[Path, arg(metavar="DIR")]
    """Folder of the report; new, empty, or of the same command."""
    methods: Annotated[str | None, optional("METHOD,METHOD,…")] = None
    """What to compare. By default every method that there is: random, nearest, edf, big-mrta, ils, eils, pyvrp, and the
    trained policies that ship with the package, which choose greedily."""
    against: Annotated[str | None, optional("METHOD")] = None
    """The method that the others are tested against; capam by default or, if it is not run, the last method."""
    budget: Annotated[float | None, optional("SECONDS")] = None
    """Seconds a case for methods that search. By default they stop by themselves, and pyvrp, which does not, has 2."""
    seed: int = 0
    """Of everything drawn at random, the bootstrap included."""
    threads: int = 1
    """CPU threads for trained methods, and searches at a time for eils and polishing."""


@resumable()
def reproduce_command(argv: Sequence[str]) -> None:
    """Run `mrta-zoo reproduce` with these arguments.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    command = parse(Reproduce, argv, "reproduce")
    absent: dict[str, str] = {}
    asked = usual_methods(absent) if command.methods is None else names(command.methods)
    methods = [composed(method) for method in asked]  # as rows call them
    against = reference_of(methods, command.against and composed(command.against))
    with preparing():
        solvers = {composed(method): _solver(method, command) for method in asked}
    cases = read_all(command.cases)
    settings = {"cases": shown_cases(command.cases), "methods": methods, "budget": command.budget, "seed": command.seed,
                "threads": command.threads}  # fmt: skip
    manifest = make_manifest("reproduce", settings, cases, asked)
    with cpu_threads(command.threads):
        open_experiment(command.out, manifest)
        rows = RowsFile(command.out / "rows.csv", Row)
        small = RowsFile(command.out / "small_rows.csv", OptimalityRow)
        sessions = RowsFile(command.out / "sessions.csv", Session)
        exact = _exact_solver(command, absent)
        small_cases = [Case(scenario.name, scenario) for scenario in small_suite()] if exact else []
        small_solvers = {**exact, **{name: solver for name, solver in solvers.items() if name != EXACT}}
        if len(rows.rows) < len(cases) * len(methods) or len(small.rows) < len(small_cases) * len(small_solvers):
            sessions.append(this_session(command.threads))
        measure(cases, solvers, rows, row_of, lambda row: (row.case, row.method))
        measure(
            small_cases, small_solvers, small, _optimality_row, lambda row: (row.case, row.method), "small scenarios: "
        )
    study = Study(
        frame=frame_of(rows.rows, [case.name for case in cases], methods),
        methods=tuple(methods),
        against=against,
        seed=command.seed,
        best_known={case.name: case.best_known for case in cases if case.best_known is not None},
        small=frame_of(small.rows, [case.name for case in small_cases], list(small_solvers)) if exact else None,
        absent=absent,
    )
    publish(make_report(study, manifest, sessions.rows, absent), command.out)


def make_report(study: Study, manifest: Manifest, sessions: Sequence[Session], absent: Mapping[str, str]) -> Report:
    """All sections, the summary before them, and how they came about after them."""
    comparisons = compare(study)
    pairs = {tasks: compare_all(study, tasks) for tasks in study.sizes}
    sections = (
        completion_section(study),
        comparison_section(study, comparisons, pairs),
        timing_section(study, sessions),
        moments_section(study),
        share_section(study),
        optimality_section(study),
    )
    return Report(
        title=f"Comparison of {len(study.methods)} methods of multi-robot task allocation"
        if len(study.methods) > 1
        else f"Results of {study.methods[0]} in multi-robot task allocation",
        summary=summary(study, comparisons, pairs, sessions),
        sections=sections,
        made=_made(study, manifest, sessions, absent),
    )


def _made(
    study: Study, manifest: Manifest, sessions: Sequence[Session], absent: Mapping[str, str]
) -> tuple[tuple[str, str], ...]:
    settings = manifest.settings
    flags = [f"--cases {settings['cases']}", f"--methods {','.join(settings['methods'])}", f"--against {study.against}"]
    flags += [f"--budget {settings['budget']:g}"] if settings["budget"] is not None else []
    flags += [f"--seed {settings['seed']}", f"--threads {settings['threads']}"]
    made = [
        ("Command", f"mrta-zoo reproduce {' '.join(flags)}"),
        ("Version", f"mrta_zoo {__version__}"),
        ("Cases", f"{study.frame['case'].nunique()}, SHA-256 {manifest.cases}"),
        *((f"Weights of {method}", f"SHA-256 {digest}") for method, digest in manifest.weights.items()),
        (
            "Scores",
            "Every plan was scored by the package’s verifier, which shares no code with the methods or the "
            "environment. A task counts as completed if its work is finished by its deadline.",
        ),
        ("Trained methods", "one greedy pass, no search"),
        *((name, METHODS[name].summary) for name in settings["methods"] if name in METHODS),
        (
            "Effort",
            "methods that search stop by themselves, pyvrp after the seconds named below"
            if settings["budget"] is None
            else f"methods that search (ils, eils, pyvrp, exact) had {settings['budget']:g} s a case",
        ),
        (
            "Statistics",
            f"SciPy and statsmodels: BCa bootstrap with {RESAMPLES} resamples (percentile bootstrap where BCa has no "
            f"answer), {100 * LEVEL:.0f} % intervals; paired t-test, Wilcoxon signed-rank test, Holm’s adjustment.",
        ),
    ]  # fmt: skip
    if "pyvrp" in settings["methods"]:
        made.append(("PyVRP", f"{settings['budget'] or PYVRP_SECONDS:g} s a case"))
    made += [("Not run", f"{method}: {reason}") for method, reason in absent.items()]
    for session in sessions:
        load = "unknown" if session.load is None else f"{session.load:g}"
        made.append(
            (
                f"Measured {session.started}",
                f"{session.processor}, {session.cores} cores usable, load {load} at the beginning, "
                f"{session.threads} torch thread{'s' * (session.threads != 1)}, {session.system}; {session.libraries}",
            )
        )
    if len({astuple(session)[1:5] for session in sessions}) > 1:
        made.append(("Beware", "the sessions above ran on different machines, so planning times are a mixture"))
    return tuple(made)


def usual_methods(absent: dict[str, str]) -> list[str]:
    """The methods compared by default. Those that cannot be made go to `absent` with the reason."""
    there = method_names()
    shipped = [name for name in there if name.startswith(("am", "capam")) and name not in USUAL]
    found = []
    for method in (*USUAL, *shipped):
        if method not in there:
            continue
        try:
            make_solver(method)
            found.append(method)
        except MissingExtraError as error:
            absent[method] = str(error)
    return found


def reference_of(methods: Sequence[str], asked: str | None) -> str:
    """The method that the others are compared with.

    Raises:
        ConfigError: if it was asked for and is not run.
    """
    if asked is not None and asked not in methods:
        raise ConfigError(f"against is {asked!r}; expected one of the methods that are run: {', '.join(methods)}")
    return asked or (AGAINST if AGAINST in methods else methods[-1])


def _solver(method: str, command: Reproduce) -> Solver:
    budget = PYVRP_SECONDS if method == "pyvrp" and command.budget is None else command.budget
    return make_solver(method, seed=command.seed, decode="greedy", budget=budget, threads=command.threads)


def _exact_solver(command: Reproduce, absent: dict[str, str]) -> dict[str, Solver]:
    """The exact solver, none if there is none; then `absent` says why."""
    try:
        return {EXACT: make_solver(EXACT, seed=command.seed)}
    except MissingExtraError as error:
        absent[EXACT] = str(error)
        return {}


def _optimality_row(case: Case, method: str, solved: Solved) -> OptimalityRow:
    return OptimalityRow(**asdict(row_of(case, method, solved)), bound=solved.plan.bound)
