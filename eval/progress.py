"""An evaluation with a progress bar."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mrta_zoo.eval.rows import Row
from mrta_zoo.eval.runner import evaluate
from mrta_zoo.io import Case
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.show.terminal.console import progress_bar


def evaluate_with_progress(cases: Sequence[Case], solvers: Mapping[str, Solver]) -> list[Row]:
    """Every method on every case, with a progress bar on standard error if that is a terminal.

    Raises:
        MrtaError: if a method fails on a case; the message names both.
    """
    rows = []
    with progress_bar() as progress:
        bar = progress.add_task(next(iter(solvers)), total=len(cases) * len(solvers))
        for row in evaluate(cases, solvers):
            rows.append(row)
            progress.update(bar, advance=1, description=row.method)
    return rows
