"""One line instead of a traceback when a program of ours ends by Ctrl-C or by an error meant for people."""

from __future__ import annotations

import sys
from pathlib import Path
from types import TracebackType

from mrta_zoo.errors import MrtaError

SCRIPT, PACKAGE = "mrta-zoo", __name__.partition(".")[0]


def end_in_a_sentence() -> None:
    """Replace tracebacks by one line, if Python was started for a program of ours.

    ``mrta-zoo`` needs this only while it imports. Modules that are run by ``python -m`` need it throughout. Other
    people's programs that import us keep their tracebacks.
    """
    if _is_ours([*sys.argv, ""][0], sys.orig_argv):
        sys.excepthook = _tell


def _is_ours(script: str, started: list[str]) -> bool:
    """Whether Python was started as ``mrta-zoo …`` or ``python -m mrta_zoo…``."""
    if Path(script).stem == SCRIPT:
        return True
    module = started[started.index("-m") + 1] if "-m" in started[:-1] else ""
    return module.partition(".")[0] == PACKAGE


def _tell(kind: type[BaseException], error: BaseException, traceback: TracebackType | None) -> None:
    if issubclass(kind, KeyboardInterrupt):
        print("interrupted", file=sys.stderr)
    elif issubclass(kind, MrtaError):
        print(f"error: {' '.join(str(error).split())}", file=sys.stderr)
        raise SystemExit(2)
    else:
        sys.__excepthook__(kind, error, traceback)
