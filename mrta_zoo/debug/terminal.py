"""The stepper at a terminal, and driven by a script."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable, Sequence

from rich.console import Console, Group, RenderableType

from mrta_zoo.debug.screen import fit, header, prompt, screen, table
from mrta_zoo.debug.session import Session
from mrta_zoo.errors import MrtaError

SCRIPT_ROWS = 20
"""Rows of a table that `show` prints unless it is given a number."""


def interact(session: Session, console: Console) -> None:
    """Show the session, ask for a command and carry it out, until the user leaves."""
    with contextlib.suppress(ImportError):
        import readline  # noqa: F401  (lets `input` edit the line, where there is such a module)

    message, warned = "? lists the commands", False
    while True:
        console.clear()
        console.print(screen(session, fit(console), console.width, message))
        try:
            line = input(prompt(session))
        except EOFError:
            return
        try:
            with console.status("…"):  # a policy may need some seconds for many decisions
                message = session.do(line)
        except MrtaError as error:
            message = f"! {' '.join(str(error).split())}"
        if session.over:
            if session.unsaved and session.path is None and not warned:
                session.over, warned = False, True
                message = "! choices of your own are not saved: save FILE, or q again to leave"
                continue
            return
        warned = False


def run_script(session: Session, lines: Iterable[str], source: str, console: Console) -> None:
    """Carry out commands, one per line, and print the result of each; at the end, print where the session is.

    Comments, which begin with a ``#`` that is not part of a name, and empty lines are skipped, so taking the policy's
    choice must be written `follow`. ``show [rows]``, which only scripts have, prints what a terminal would.

    Args:
        session: the session to step.
        lines: the script.
        source: the script's name in messages.
        console: where to print.

    Raises:
        MrtaError: at the first command that cannot be carried out; the message names the line.
    """
    for number, line in enumerate(lines, start=1):
        scenario = session.stepper.scenario
        command = without_comment(line, (*scenario.task_names, *scenario.robot_names)).strip()
        if not command:
            continue
        console.print(f"> {command}")
        try:
            name, _, rows = command.partition(" ")
            if name == "show" and (not rows or re.fullmatch(r"\s*[1-9][0-9]{0,5}", rows, re.ASCII)):
                _print(console, screen(session, int(rows or SCRIPT_ROWS), console.width))
                continue
            said = session.do(command)
            if said:
                console.print(said, soft_wrap=True)
            elif not session.over:  # a command that shows a table
                _print(console, Group(*table(session, SCRIPT_ROWS, console.width)))
        except MrtaError as error:
            raise type(error)(f"{source}, line {number}: {error}") from None
        if session.over:
            break
    _print(console, Group(*header(session, console.width)))


def without_comment(line: str, names: Sequence[str]) -> str:
    """The line of a script up to a ``#`` that is not part of a name."""
    hidden = line
    for name in sorted((name for name in names if "#" in name), key=len, reverse=True):
        hidden = hidden.replace(name, "\0" * len(name))
    return line[: hidden.index("#")] if "#" in hidden else line


def _print(console: Console, what: RenderableType) -> None:
    """Print without the trailing blanks that tables leave."""
    with console.capture() as captured:
        console.print(what)
    for line in captured.get().splitlines():
        console.print(line.rstrip(), soft_wrap=True)
