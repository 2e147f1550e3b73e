"""The command ``mrta-zoo replay``."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from tyro.conf import Positional, arg

from mrta_zoo.cli.flags import names, optional, takes_flags
from mrta_zoo.cli.methods import METHOD_HELP, PLAN, TRACE, files_of_methods, read_any_trace
from mrta_zoo.cli.planning import PlanningFlags
from mrta_zoo.errors import ConfigError
from mrta_zoo.io import read_scenario, read_trace
from mrta_zoo.io.destination import check_outputs
from mrta_zoo.io.files import agent_file
from mrta_zoo.io.formats import AGENT_FILE, SCENARIO_FILE
from mrta_zoo.io.json_format import json_kind
from mrta_zoo.io.outputs import Outputs
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.replay.page import MOST_SIDES, write_replay
from mrta_zoo.show.terminal.console import preparing, results_console, say
from mrta_zoo.trace import Trace

DEFAULT = "capam-plus"


@dataclass(frozen=True, slots=True, kw_only=True)
class Replay:
    """Make a page that replays an episode in a browser, or two of the same scenario side by side.

    The page has a map with a time slider, a chart of who does what when, completion over time, and for each decision
    the tasks to choose from with the policy's probabilities. It is one file, and needs no network.

    For example:
      mrta-zoo replay group1/r11a7i00.txt --policy capam-plus,nearest
      mrta-zoo replay plan.json --scenario group1/r11a7i00.txt
      mrta-zoo replay session.json --policy eils --budget 1 --out both.html
    """

    source: Annotated[
        Positional[Path],
        arg(
            metavar="SCENARIO|PLAN.json|TRACE.json",
            help=f"A mission ({SCENARIO_FILE}), or an episode (a trace, or a plan together with --scenario).",
        ),
    ]
    scenario: Annotated[Path | None, optional("SCENARIO")] = None
    """The mission that the plan was made for."""
    agents: Annotated[
        Path | None,
        optional(
            "AGENTFILE",
            help=f"The robots: {AGENT_FILE}. Without it they are with the tasks or, for TAPTC, in agent/ beside them.",
        ),
    ] = None
    policy: Annotated[
        str | None,
        arg(
            metavar="METHOD[,METHOD]",
            help_behavior_hint="",
            help=f"Who decides: a .json plan or trace, or a method; for a mission {DEFAULT} by default. Two are shown "
            f"side by side, as are an episode and a method. {METHOD_HELP}",
        ),
    ] = None
    out: Annotated[Path, arg(metavar="PAGE.html")] = Path("replay.html")
    """The file for the page."""
    planning: Annotated[PlanningFlags, arg(name="")] = field(default_factory=PlanningFlags)


@takes_flags
def replay_command(command: Replay) -> None:
    """Play the episodes and write the page.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a method fails.
    """
    kind = json_kind(command.source)
    chosen = names(command.policy, "policy") if command.policy is not None else [DEFAULT]
    if command.policy is None and kind in (PLAN, TRACE):
        chosen = []
    inputs = {
        "the source": command.source,
        "--scenario": command.scenario,
        "the agent file": agent_file(command.scenario or command.source, command.agents),
    }
    check_outputs({"--out": command.out}, {**inputs, **files_of_methods(chosen)})
    sides = len(chosen) + (kind in (PLAN, TRACE))
    if sides > MOST_SIDES:
        raise ConfigError(f"that makes {sides} episodes; expected {MOST_SIDES} at most, side by side")
    scenario, given = _source(command, kind)
    with preparing("plays the episodes"), cpu_threads(command.planning.threads):
        traces = [*given, *(command.planning.episode(name, scenario) for name in chosen)]
    command.planning.warn_unused([*chosen, *[str(command.source)] * (kind in (PLAN, TRACE))], "mask_rule")
    with Outputs() as outputs:
        outputs.write("page", command.out, lambda path: write_replay(traces, path))
    shown = " and ".join(trace.method or "an unnamed method" for trace in traces)
    size = command.out.stat().st_size / 1e6
    say(
        results_console(),
        f"{scenario.name}: {shown} replayed in {command.out} ({size:.1f} MB); open it in a browser",
    )


def _source(command: Replay, kind: str) -> tuple[Scenario, list[Trace]]:
    """The mission, and the episode if the source is one."""
    if kind == TRACE:
        for flag, path in (("--scenario", command.scenario), ("--agents", command.agents)):
            if path is not None:
                raise ConfigError(f"{flag} is given with a trace, which holds its scenario; expected one of them")
        trace = read_trace(command.source)
        return trace.scenario, [trace]
    if kind == PLAN:
        if command.scenario is None:
            raise ConfigError(
                f"{command.source} is a plan, which does not hold its scenario; expected --scenario SCENARIO"
            )
        scenario = read_scenario(command.scenario, command.agents)
        return scenario, [read_any_trace(command.source, scenario, command.planning.mask_rule)]
    if command.scenario is not None:
        raise ConfigError(f"--scenario is given, and {command.source} is no plan; expected a plan, or no --scenario")
    return read_scenario(command.source, command.agents), []
