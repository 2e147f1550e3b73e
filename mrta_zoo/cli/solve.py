"""The command ``mrta-zoo solve``."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from tyro.conf import Positional, arg

from mrta_zoo.cli.flags import optional, takes_flags
from mrta_zoo.cli.methods import METHOD_HELP, files_of_methods
from mrta_zoo.cli.planning import PlanningFlags
from mrta_zoo.digits import rounded
from mrta_zoo.eval.runner import solve_and_score
from mrta_zoo.eval.solved_files import write_schedule, write_solved
from mrta_zoo.io import read_scenario
from mrta_zoo.io.destination import check_outputs
from mrta_zoo.io.files import agent_file
from mrta_zoo.io.formats import AGENT_FILE, SCENARIO_FILE
from mrta_zoo.io.outputs import Outputs
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.default_method import BEST_FIRST, default_method
from mrta_zoo.show.plan.text import missed, proven, schedule_table, totals
from mrta_zoo.show.terminal.console import preparing, results_console, say

LEARNED = "capam-plus"
"""The method if none is named, but an option that only learned methods have is given."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Solve:
    """Plan one mission and print which robot does which task when.

    For example:
      mrta-zoo solve group1/r11a7i00.txt --plot plan.png
      mrta-zoo solve tasks.txt --agents robots.txt --method nearest
      mrta-zoo solve mission.json --budget 2 --out plan.json
    """

    taskfile: Annotated[Positional[Path], arg(metavar="TASKFILE", help=f"The mission: {SCENARIO_FILE}.")]
    agents: Annotated[
        Path | None,
        optional(
            "AGENTFILE",
            help=f"The robots: {AGENT_FILE}. Without it they are in TASKFILE or, for TAPTC, in agent/ beside it.",
        ),
    ] = None
    method: Annotated[
        str | None,
        arg(
            metavar="METHOD",
            help_behavior_hint="",
            help=f"The method. By default the first of {', '.join(BEST_FIRST)} whose libraries are installed; with "
            f"--decode, --samples or --mask-rule {LEARNED}. {METHOD_HELP}",
        ),
    ] = None
    out: Annotated[Path | None, optional("PLAN.json")] = None
    """Write routes, schedule, score and the tasks left out to this file, as JSON."""
    schedule: Annotated[Path | None, optional("SCHEDULE.csv")] = None
    """Write the schedule to this file, one row per visit, robot by robot and in order of time: robot, robot_name, task,
    task_name, x, y, depart, arrive, finish, deadline, slack. Names are written unchanged: a spreadsheet may take one
    that begins with = for a formula."""
    plot: Annotated[Path | None, optional("PLAN.png")] = None
    """Draw routes and schedule in this file: .png, .svg or .pdf."""
    planning: Annotated[PlanningFlags, arg(name="")] = field(default_factory=PlanningFlags)


@takes_flags
def solve_command(command: Solve) -> None:
    """Plan the mission, write what was asked for, and print the schedule and the score.

    Raises:
        MrtaError: if an option cannot be used, or a file cannot be read or written.
    """
    destinations = {"--out": command.out, "--schedule": command.schedule, "--plot": command.plot}
    read = {"the task file": command.taskfile, "the agent file": agent_file(command.taskfile, command.agents)}
    method = chosen_method(command.planning) if command.method is None else command.method
    check_outputs(destinations, {**read, **files_of_methods([method])})
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
    """The method if none is named. A note on standard error says why, if it is not the best one."""
    if any(option is not None for option in (planning.decode, planning.samples, planning.mask_rule)):
        return LEARNED  # the default would ignore them
    method, missing = default_method()
    if missing:
        print(f"note: planning by {method} instead of the default: {missing}", file=sys.stderr)
    return method
