"""The commands ``mrta-zoo solve``, ``eval`` and ``demo``: their flags, and what they print."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated

from tyro.conf import Positional, arg

from mrta_zoo.cli.case_choice import read_one, suite_named
from mrta_zoo.cli.flags import names, optional, parse
from mrta_zoo.cli.plan_files import is_episode
from mrta_zoo.cli.solved_files import write_schedule, write_solved
from mrta_zoo.digits import rounded
from mrta_zoo.errors import ScenarioError
from mrta_zoo.eval.rows import Row
from mrta_zoo.eval.runner import evaluate, solve_and_score
from mrta_zoo.eval.table import summary_tables
from mrta_zoo.io import Case, read_scenario
from mrta_zoo.io.destination import check_outputs
from mrta_zoo.io.outputs import Outputs
from mrta_zoo.io.paths import suffix_of
from mrta_zoo.io.records import records_text, write_records
from mrta_zoo.io.taptc import find_agent_file
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.default_method import BEST_FIRST, default_method
from mrta_zoo.policies.neural.policy_files import info_file, weights_file
from mrta_zoo.policies.options import Decode
from mrta_zoo.policies.pretrained import pretrained_names
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.policies.registry import METHODS, POLISH, make_solver, method_names, used_options
from mrta_zoo.rules import MASK_RULES, MaskRule
from mrta_zoo.show.plan.text import missed, proven, schedule_table, totals
from mrta_zoo.show.terminal.console import preparing, progress_bar, results_console, say, warn
from mrta_zoo.wording import counted

LEARNED = "capam-plus"
"""What plans if no method is named, but how learned ones should."""

TRAINED_HELP = (
    f"a policy's .safetensors file, or the folder of a training run. NAME{POLISH} has a method's plan improved by "
    "local search"
)
METHOD_HELP = (
    "; ".join(f"{name}: {method.summary}" for name, method in METHODS.items())
    + f"; {', '.join(pretrained_names())}: trained, ship with the package; {TRAINED_HELP}."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanningFlags:
    """How methods plan. Each method uses what it can: heuristics only the mask rule (and random the seed), ils and
    exact only the budget, eils and pyvrp the budget and the seed, big-mrta nothing."""

    decode: Annotated[Decode | None, optional("{greedy,sample,augment,beam}")] = None
    """How learned methods choose: greedy takes the likeliest task each time; sample takes the best of several drawn
    missions and the greedy one; augment the best of 8 greedy ones, the map mirrored and turned, and with --budget of
    more drawn so; beam the best of a beam search, with --budget wider and wider. By default sample if --budget or
    --samples is given, otherwise greedy."""
    samples: Annotated[int | None, optional("N")] = None
    """Missions that sample draws in one go, 64 by default; with --budget it goes on drawing. For beam its width, 16 by
    default."""
    budget: Annotated[float | None, optional("SECONDS")] = None
    """Seconds a mission for methods that can search for longer. By default they stop by themselves; exact after 60
    at most, pyvrp after 5."""
    seed: int = 0
    """Of everything drawn at random. The same seed gives the same plan, unless a budget cuts the search off."""
    mask_rule: Annotated[
        MaskRule | None,
        optional(
            f"{{{','.join(MASK_RULES)}}}",
            help="Which of the tasks not yet taken a robot may choose: "
            f"{'; '.join(f'{name}, {rule.help}' for name, rule in MASK_RULES.items())}. By default feasible or, for a "
            "trained policy, what it was trained under. Methods that are neither heuristics nor trained only plan what "
            "is finished by its deadline.",
        ),
    ] = None
    threads: int = 1
    """CPU threads for learned methods: one is as fast as several for single missions, and timings compare. For eils
    and +polish with --budget, as many searches at a time, of which the best counts."""

    def warn_unused(self, methods: Sequence[str], *used: str) -> None:
        """Say on standard error which of these flags have no effect.

        Args:
            methods: that are to plan, or files of plans and traces.
            used: options that the command itself makes something of.
        """
        known = frozenset(used).union(*(used_options(name) for name in methods if not is_episode(name)))
        if self.decode == "greedy" or (self.decode == "augment" and self.budget is None):
            known -= {"samples"}
        for option in ("decode", "samples", "budget", "mask_rule"):
            if getattr(self, option) is not None and option not in known:
                warn(f"{' and '.join(methods)} make{'s' * (len(methods) == 1)} nothing of --{option.replace('_', '-')}")

    def solver(self, method: str) -> Solver:
        """The method, made with these flags."""
        return make_solver(method, **asdict(self))


@dataclass(frozen=True, slots=True, kw_only=True)
class Solve:
    """Plan one mission and print which robot does which task when.

    For example:
      mrta-zoo solve group1/r11a7i00.txt --plot plan.png
      mrta-zoo solve tasks.txt --agents robots.txt --method nearest
      mrta-zoo solve mission.json --budget 2 --out plan.json
    """

    taskfile: Annotated[Positional[Path], arg(metavar="TASKFILE")]
    """The mission: a TAPTC task file, or a scenario in .json or .csv."""
    agents: Annotated[Path | None, optional("AGENTFILE")] = None
    """The robots: a TAPTC agent file, or .csv. Without it they are in TASKFILE or, for TAPTC, in agent/ beside it."""
    method: Annotated[
        str | None,
        arg(
            metavar="METHOD",
            help_behavior_hint="",
            help=f"By default {BEST_FIRST[0]} or, where what it needs is not installed, the first of "
            f"{', '.join(BEST_FIRST[1:])} that is; with --decode, --samples or --mask-rule {LEARNED}. {METHOD_HELP}",
        ),
    ] = None
    out: Annotated[Path | None, optional("PLAN.json")] = None
    """Write routes, schedule, score and what was left out here, as JSON."""
    schedule: Annotated[Path | None, optional("SCHEDULE.csv")] = None
    """Write a row for each task that is done here, robot by robot and in order of time: robot, robot_name, task,
    task_name, x, y, depart, arrive, finish, deadline, slack. Names stay as they are: a spreadsheet may take one that
    begins with = for a formula."""
    plot: Annotated[Path | None, optional("PLAN.png")] = None
    """Draw routes and schedule here; .png, .svg or .pdf."""
    planning: Annotated[PlanningFlags, arg(name="")] = field(default_factory=PlanningFlags)


def solve_command(argv: Sequence[str]) -> None:
    """Run `mrta-zoo solve` with these arguments.

    Raises:
        MrtaError: if an option cannot be used, or a file cannot be read or written.
    """
    command = parse(Solve, argv, "solve")
    destinations = {"--out": command.out, "--schedule": command.schedule, "--plot": command.plot}
    read = {"the task file": command.taskfile, "the agent file": agent_file(command.taskfile, command.agents)}
    method = chosen_method(command.planning) if command.method is None else command.method
    check_outputs(destinations, {**read, **policy_files(method)})
    if command.plot:
        from mrta_zoo.show.figure import check_format
        from mrta_zoo.show.plan.picture import save_plan_picture

        check_format(command.plot)
    scenario = read_scenario(command.taskfile, command.agents)
    with preparing():
        solver = command.planning.solver(method)
    command.planning.warn_unused([method])
    with cpu_threads(command.planning.threads):
        solved = solve_and_score(solver, scenario)
    with Outputs() as outputs:
        if command.out:
            outputs.write("plan", command.out, lambda path: write_solved(solved, path))
        if command.schedule:
            outputs.write("schedule", command.schedule, lambda path: write_schedule(solved, path))
        if command.plot:
            outputs.write(
                "picture", command.plot, lambda path: save_plan_picture(scenario, solved.plan, path, solved.score)
            )
        console = results_console()
        say(console, f"{scenario.name}: {scenario.size}, planned by {method} in {rounded(solved.seconds, 3)} s")
        console.print(schedule_table(scenario, solved.score), crop=False)
        say(console, totals(solved.score))
        for line in missed(scenario, solved.plan, solved.score):
            say(console, line)
        if known := proven(solved.score, solved.plan.bound):
            say(console, known)
        for line in outputs.written:
            say(console, line)


def chosen_method(planning: PlanningFlags) -> str:
    """The method that plans if none is named; says on standard error if it is not the best, and why."""
    if any(option is not None for option in (planning.decode, planning.samples, planning.mask_rule)):
        return LEARNED  # the default would make nothing of them
    method, missing = default_method()
    if missing:
        print(f"note: planning by {method} instead of the default: {missing}", file=sys.stderr)
    return method


def policy_files(method: str) -> dict[str, Path]:
    """The files that a method is read from, if it is a policy of the user's; by what they are."""
    weights = weights_file(Path(method.removesuffix(POLISH)))
    return {f"the weights of {method}": weights, f"what belongs to the weights of {method}": info_file(weights)}


def agent_file(task_file: Path, agents: Path | None) -> Path | None:
    """The file that the robots are read from, None if it is the task file.

    Args:
        task_file: the mission's.
        agents: the file of the robots, if one is named.
    """
    if agents is not None or suffix_of(task_file) in (".json", ".csv"):
        return agents
    try:
        return find_agent_file(task_file)
    except ScenarioError:  # the reader has more to say: maybe there is no task file either
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Eval:
    """Compare methods on the same cases, every plan scored by the independent verifier.

    Prints means by number of tasks and robots, and with --out writes a row for each method and case. Where the folder
    holds a reference.csv (columns case,tasks,robots and one for each method with the tasks it completed), the share
    of the best known plan is printed, too. The first plan of a trained network is not timed.

    For example:
      mrta-zoo eval --cases builtin --methods capam,nearest --out rows.csv
      mrta-zoo eval --cases taptc/n100 --methods capam,runs/mine --decode sample
    """

    cases: Annotated[str, arg(metavar="DIR|SUITE")]
    """A folder of cases (TAPTC: group*/NAME.txt with agent/NAME.txt or agent/a{n}i0{i}.txt; or .json or .csv
    scenarios), or a built-in suite: suite-100 (or builtin), 96 cases with 100 tasks and 2 to 7 robots, or suite-200,
    96 cases with 200 tasks and 4 to 14."""
    methods: Annotated[
        str, arg(metavar="METHOD,METHOD,…", help=f"What to compare: {', '.join(method_names())}, {TRAINED_HELP}.")
    ] = "random,nearest,edf,capam,capam-plus"
    out: Annotated[Path | None, optional("ROWS.csv")] = None
    """Write the rows here, once all are known: case, method, tasks, robots, completed, completion (0 to 1), cost,
    distance, makespan, seconds."""
    planning: Annotated[PlanningFlags, arg(name="")] = field(default_factory=PlanningFlags)


def eval_command(argv: Sequence[str]) -> None:
    """Run `mrta-zoo eval` with these arguments.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    command = parse(Eval, argv, "eval")
    methods = names(command.methods)
    if command.out:
        inputs = {f"{path} of the cases": path for path in _files_of(command.cases)}
        for method in methods:
            inputs |= policy_files(method)
        check_outputs({"--out": command.out}, inputs)
    with preparing():
        solvers = {method: command.planning.solver(method) for method in methods}
    command.planning.warn_unused(methods)
    cases = read_one(command.cases)
    with cpu_threads(command.planning.threads):
        rows = run_with_progress(cases, solvers)
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


def run_with_progress(cases: Sequence[Case], solvers: dict[str, Solver]) -> list[Row]:
    """Every method on every case, with a progress bar if there is a terminal."""
    rows = []
    with progress_bar() as progress:
        bar = progress.add_task(next(iter(solvers)), total=len(cases) * len(solvers))
        for row in evaluate(cases, solvers):
            rows.append(row)
            progress.update(bar, advance=1, description=row.method)
    return rows


@dataclass(frozen=True, slots=True, kw_only=True)
class Demo:
    """See it all at work in a few minutes.

    Robots take turns in the environment under one shared, trained policy; methods are compared on the built-in suite;
    a small policy is trained from scratch; a plan is drawn.

    For example:
      mrta-zoo demo --out demo
    """

    out: Annotated[Path, arg(metavar="DIR")] = Path("mrta_zoo_demo")
    """Folder for the table's rows, the training run and the picture; made if it does not exist."""
    policy: Annotated[str, arg(metavar="POLICY")] = "capam-plus"
    """The trained policy to show: the one that ships with the package, a .safetensors file, or the folder of a run."""


def demo_command(argv: Sequence[str]) -> None:
    """Run `mrta-zoo demo` with these arguments.

    Raises:
        MrtaError: if an option cannot be used, or something is not installed.
    """
    command = parse(Demo, argv, "demo")
    from mrta_zoo.cli.demo import run_demo

    run_demo(command.out, command.policy)
