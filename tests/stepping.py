"""Running the stepper with a script."""

from __future__ import annotations

import io

from rich.console import Console

from mrta_zoo.debug.session import Session
from mrta_zoo.debug.terminal import run_script


def scripted(steps: Session, script: str, width: int = 80) -> str:
    """What a script prints."""
    output = io.StringIO()
    console = Console(file=output, width=width, no_color=True, markup=False, highlight=False, emoji=False)
    run_script(steps, script.split("\n"), "script.txt", console)
    return output.getvalue()
