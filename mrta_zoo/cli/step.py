"""The command ``mrta-zoo step``."""

from __future__ import annotations

import os
import sys
from contextlib import nullcontext
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated

import numpy as np
from tyro.conf import Positional, arg

from mrta_zoo.cli.flags import optional, takes_flags
from mrta_zoo.cli.hangups import hangups_raised
from mrta_zoo.cli.methods import METHOD_HELP
from mrta_zoo.cli.planning import PlanningFlags
from mrta_zoo.debug.advisors import Advisor, make_advisor
from mrta_zoo.debug.session import Session
from mrta_zoo.debug.stepper import Stepper
from mrta_zoo.debug.terminal import interact, run_script
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.io import read_scenario, read_trace
from mrta_zoo.io.destination import check_outputs
from mrta_zoo.io.formats import AGENT_FILE, SCENARIO_FILE
from mrta_zoo.io.outputs import Outputs
from mrta_zoo.io.text_files import decode, read_text
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.policies.registry import method_names
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.terminal.console import PIPED_WIDTH, LiteralConsole, preparing
from mrta_zoo.trace import Trace

NOBODY = "none"
DEFAULT = "capam-plus"


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """Go through an episode one decision at a time, back and forth, and choose differently.

    Shows whose turn it is, and every task as that robot sees it: distance, travel, finish, slack, why it may not be
    chosen, the policy's probability, and who else could do it; at the end also the cost (Eq. 1 of the paper: the sum of
    finish / deadline over the tasks missed). Enter takes the policy's choice, the name or number of a task takes that
    task, and ? lists the commands. A terminal of 80 x 24 is enough, also over ssh.

    For example:
      mrta-zoo step group1/r11a7i00.txt
      mrta-zoo step mission.json --policy plan.json --session session.json
      mrta-zoo step --seed 3 --policy nearest --script commands.txt
    """

    scenario: Annotated[
        Positional[Path | None],
        arg(
            metavar="[SCENARIO]",
            help_behavior_hint="",
            help=f"The mission: {SCENARIO_FILE}. Without it, one like the published cases is drawn with --seed.",
        ),
    ] = None
    agents: Annotated[
        Path | None,
        optional(
            "AGENTFILE",
            help=f"The robots: {AGENT_FILE}. Without it they are in SCENARIO or, for TAPTC, in agent/ beside it.",
        ),
    ] = None
    policy: Annotated[
        str | None,
        arg(
            metavar="METHOD",
            help_behavior_hint="",
            help=f"Who advises: a .json plan or trace, a method, or {NOBODY}; by default {DEFAULT}, or whoever advised "
            f"the session. Methods that are not policies plan once, at the start. {METHOD_HELP}",
        ),
    ] = None
    script: Annotated[str | None, optional("FILE|-")] = None
    """Take commands from this file, one per line, instead of a terminal; - is standard input. The first command that
    fails ends the script with exit code 2."""
    session: Annotated[Path | None, optional("SESSION.json")] = None
    """Continue the session, or any trace, in this file if it exists, and save there on leaving. If a scenario is given,
    too, it must be the session's."""
    planning: Annotated[PlanningFlags, arg(name="")] = field(default_factory=PlanningFlags)


@takes_flags
def step_command(command: Step) -> None:
    """Step at the terminal or by script, and save the session.

    Raises:
        MrtaError: if an option cannot be used, a file cannot be read or written, or a command of a script fails.
    """
    if command.scenario is None and command.agents is not None:
        raise ConfigError("--agents is given without a scenario; expected SCENARIO --agents AGENTFILE")
    script = _script(command)
    check_outputs({"--session": command.session}, {"the scenario": command.scenario})
    with cpu_threads(command.planning.threads), hangups_raised() if command.session else nullcontext():
        session = _begin(command)
        try:
            if script is None:
                interact(session, LiteralConsole(file=sys.stdout))
            else:
                source, lines = script
                console = LiteralConsole(file=sys.stdout, width=PIPED_WIDTH, no_color=True)
                run_script(session, lines, source, console)
        finally:  # also after Ctrl-C
            if command.session and session.path:  # another one, if it was loaded
                with Outputs() as outputs:
                    outputs.write("session", session.path, session.stepper.save)
                if script is None:
                    print(f"saved; go on with: mrta-zoo step --session {session.path}")


def _begin(command: Step) -> Session:
    """The session, new or continued, as the flags say."""
    resumed: Trace | None = None
    if command.session and os.path.exists(command.session) and os.path.getsize(command.session):
        resumed = read_trace(command.session)
        if command.scenario is not None and _scenario(command) != resumed.scenario:
            raise ConfigError(
                f"{command.session} is there already, a session on {resumed.scenario.name or 'another mission'}, "
                f"which is not {command.scenario}; leave out the scenario to go on with it, or name another file"
            )
        if command.planning.mask_rule not in (None, resumed.mask_rule):
            raise ConfigError(
                f"--mask-rule is {command.planning.mask_rule}, but {command.session} is a session with the mask rule "
                f"{resumed.mask_rule}; leave it out to go on with it, or name another file"
            )
    with preparing():
        if resumed is None:
            scenario = _scenario(command)
            policy = DEFAULT if command.policy is None else command.policy
            advisor = None if policy == NOBODY else command.planning.advisor(policy, scenario)
            command.planning.warn_unused([policy], "mask_rule")
            rule = {"mask_rule": command.planning.mask_rule} if command.planning.mask_rule else {}
            return Session(Stepper(scenario, advisor, **rule), advisor, command.session)
        advisor = _advisor_again(resumed, command.policy, command.planning)
        return Session(Stepper.resume(resumed, advisor), advisor, command.session)


def _scenario(command: Step) -> Scenario:
    if command.scenario is not None:
        return read_scenario(command.scenario, command.agents)
    seed = command.planning.seed
    return TaptcGenerator()(np.random.default_rng(seed), f"drawn with seed {seed}")


def _advisor_again(trace: Trace, name: str | None, planning: PlanningFlags) -> Advisor | None:
    """The advisor that the flags name, or else the one that the session had, with its options."""
    if name is not None:
        return None if name == NOBODY else planning.advisor(name, trace.scenario)
    if trace.method not in method_names():
        return None
    options = asdict(planning) | {"mask_rule": trace.mask_rule, "decode": trace.decode or planning.decode}
    if trace.seed is not None:
        options["seed"] = trace.seed
    return make_advisor(trace.scenario, trace.method, **options)


def _script(command: Step) -> tuple[str, list[str]] | None:
    """The script's name in messages, and its lines; None if commands come from a terminal."""
    if command.script is not None and command.script != "-":
        return command.script, read_text(command.script, ConfigError, "commands, one a line").split("\n")
    if sys.stdin is None:
        raise ConfigError("standard input is closed; expected a terminal, commands there, or --script FILE")
    if command.script == "-" or not sys.stdin.isatty():
        bytes_of = getattr(sys.stdin, "buffer", None)  # read as files are, whatever the terminal's encoding
        text = sys.stdin.read() if bytes_of is None else decode(bytes_of.read(), "standard input", ConfigError)
        return "standard input", text.split("\n")
    return None
