"""Stepping at a terminal, and by script."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable

from rich.console import Console, Group, RenderableType

from mrta_zoo.debug.called import without_comment
from mrta_zoo.debug.screen import fit, header, prompt, screen, table
from mrta_zoo.debug.session import Session
from mrta_zoo.errors import MrtaError

SCRIPT_ROWS = 20
"""Rows of a table that `show` prints by default."""


def interact(session: Session, console: Console) -> None:
    """Show the session, ask for a command, carry it out, and so on until somebody leaves."""
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
            with console.status("…"):  # a policy may need some seconds for a long way
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
    """Carry out commands, one a line, and print what comes of each; at the end, where that has led.

    Empty lines and what follows a ``#`` that is no part of a name are passed over, so that the policy's choice is
    written `follow`. Besides the commands of a session there is ``show [rows]``, which prints what a terminal would.

    Args:
        session: is stepped.
        lines: the script.
        source: what messages call it.
        console: where to print.

    Raises:
        MrtaError: at the first command that cannot be carried out; the message names its line.
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
            elif not session.over:  # it was to look at something
                _print(console, Group(*table(session, SCRIPT_ROWS, console.width)))
        except MrtaError as error:
            raise type(error)(f"{source}, line {number}: {error}") from None
        if session.over:
            break
    _print(console, Group(*header(session, console.width)))


def _print(console: Console, what: RenderableType) -> None:
    """Print without the blanks at the ends of lines, which tables have."""
    with console.capture() as captured:
        console.print(what)
    for line in captured.get().splitlines():
        console.print(line.rstrip(), soft_wrap=True)
