"""The command ``mrta-zoo compare``."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from tyro.conf import Positional, arg

from mrta_zoo.cli.flags import names, optional, takes_flags
from mrta_zoo.cli.methods import TRAINED_HELP, files_of_methods
from mrta_zoo.cli.planning import PlanningFlags
from mrta_zoo.debug.comparison import compare
from mrta_zoo.debug.comparison_file import write_comparison
from mrta_zoo.debug.comparison_report import report
from mrta_zoo.errors import ConfigError
from mrta_zoo.io import read_scenario
from mrta_zoo.io.destination import check_outputs
from mrta_zoo.io.files import agent_file
from mrta_zoo.io.formats import AGENT_FILE, SCENARIO_FILE
from mrta_zoo.io.outputs import Outputs
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.registry import method_names
from mrta_zoo.show.terminal.console import preparing, results_console, say


@dataclass(frozen=True, slots=True, kw_only=True)
class Compare:
    """Find where two methods part on a mission, and what that costs.

    Prints what each completes; the first decision at which they choose differently, and how each would end if it took
    the other's choice there and then went on by itself; where the second method would choose differently in the first
    one's place; and the tasks that only one of them completes.

    For example:
      mrta-zoo compare group1/r11a7i00.txt --methods capam-plus,nearest
      mrta-zoo compare mission.json --methods capam-plus,exact --out comparison.json
      mrta-zoo compare mission.json --methods plan.json,other.json
    """

    scenario: Annotated[Positional[Path], arg(metavar="SCENARIO", help=f"The mission: {SCENARIO_FILE}.")]
    agents: Annotated[
        Path | None,
        optional(
            "AGENTFILE",
            help=f"The robots: {AGENT_FILE}. Without it they are in SCENARIO or, for TAPTC, in agent/ beside it.",
        ),
    ] = None
    methods: Annotated[
        str,
        arg(
            metavar="FIRST,SECOND",
            help=f"The two methods: a .json plan or trace, {', '.join(method_names())}, {TRAINED_HELP}. A method that "
            "is not a policy plans once, at the start; where it has to leave its plan, its robots do what they still "
            "can of their routes.",
        ),
    ] = "capam-plus,nearest"
    out: Annotated[Path | None, optional("COMPARISON.json")] = None
    """Write the whole comparison to this file, as JSON."""
    rows: int = 10
    """The most rows to print of each table."""
    planning: Annotated[PlanningFlags, arg(name="")] = field(default_factory=PlanningFlags)


@takes_flags
def compare_command(command: Compare) -> None:
    """Plan by both methods, compare them, write the comparison if asked to, and print the report.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    both = names(command.methods, example="capam-plus,nearest")
    if len(both) != 2:
        raise ConfigError(f"methods is {command.methods!r}; expected two, such as capam-plus,nearest")
    if command.rows < 1:
        raise ConfigError(f"rows is {command.rows}; expected a whole number >= 1")
    if command.out:
        read = {"the scenario": command.scenario, "the agent file": agent_file(command.scenario, command.agents)}
        check_outputs({"--out": command.out}, {**read, **files_of_methods(both)})
    scenario = read_scenario(command.scenario, command.agents)
    with (
        preparing(f"plans {command.scenario} by {' and '.join(both)}, and again from where they part"),
        cpu_threads(command.planning.threads),
    ):
        first, second = (command.planning.advisor(name, scenario) for name in both)
        found = compare(scenario, first, second)
    command.planning.warn_unused(both, "mask_rule")
    with Outputs() as outputs:
        if command.out:
            outputs.write("comparison", command.out, lambda path: write_comparison(found, both, path))
        console = results_console()
        for part in report(found, (both[0], both[1]), command.rows):
            if isinstance(part, str):
                say(console, part)
            else:
                console.print(part, crop=False)
        for line in outputs.written:
            say(console, line)
