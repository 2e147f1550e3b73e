"""How our programs end where Python would show a traceback: interrupted, or with an error, while they still import."""

from __future__ import annotations

import sys
from pathlib import Path
from types import TracebackType

SCRIPT, PACKAGE = "mrta-zoo", __name__.partition(".")[0]


def end_in_a_sentence() -> None:
    """Have Ctrl-C tell that it interrupted and no more, if Python was started for a program of ours.

    What has imported us for a purpose of its own keeps its traceback.
    """
    if _is_ours([*sys.argv, ""][0], sys.orig_argv):
        sys.excepthook = _tell


def _is_ours(script: str, started: list[str]) -> bool:
    """Whether that was ``mrta-zoo …`` or ``python -m mrta_zoo…``."""
    if Path(script).stem == SCRIPT:
        return True
    module = started[started.index("-m") + 1] if "-m" in started[:-1] else ""
    return module.partition(".")[0] == PACKAGE


def _tell(kind: type[BaseException], error: BaseException, traceback: TracebackType | None) -> None:
    if issubclass(kind, KeyboardInterrupt):
        print("interrupted", file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, traceback)
