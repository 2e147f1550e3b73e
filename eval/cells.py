"""Cells: what is measured in one go, in this process or in several."""

from __future__ import annotations

import multiprocessing
import queue
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from mrta_zoo.eval.runner import NamedSolver, Solved
from mrta_zoo.io import Case
from mrta_zoo.train.child_process import pool_of
from mrta_zoo.wording import composed

RowType = TypeVar("RowType")
Key = tuple[Any, ...]
Tell = Callable[[float], None]
"""Takes the share of a cell that is done, 0 to 1."""

POLL = 0.2
"""Seconds between two looks at what worker processes have told."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell(Generic[RowType]):
    """One measurement, done as a whole or not at all: a case by a method, or an arm of a study with a seed.

    Attributes:
        label: what the progress bar calls it.
        keys: the keys of its rows, in order.
        perform: makes the rows. Worker processes need one that can be pickled.
        kept: whether what it left beside its rows is still there; if not, it is done again.
        announcement: what is said once it is done; nothing if empty.
    """

    label: str
    keys: tuple[Key, ...]
    perform: Callable[[Tell], Sequence[RowType]]
    kept: Callable[[], bool] = lambda: True
    announcement: str = ""


def case_cells(
    cases: Sequence[Case],
    solver: NamedSolver,
    record: Callable[[Case, str, Solved], RowType],
    *rest: Any,
    what: str = "",
) -> list[Cell[RowType]]:
    """A cell for each case, all by one method.

    Args:
        cases: what to plan.
        solver: the method.
        record: makes the row of a solved case.
        rest: what follows case and method in the rows' keys.
        what: said before the method's name in the progress bar.
    """

    def cell(case: Case) -> Cell[RowType]:
        return Cell(
            label=f"{what}{solver.name}",
            keys=((composed(case.name), composed(solver.name), *rest),),
            perform=lambda _: [record(case, solver.name, solver.solve(case))],
        )

    return [cell(case) for case in cases]


def perform_all(
    cells: Sequence[Cell[RowType]], workers: int, tell: Callable[[Cell[RowType], float], None]
) -> Generator[tuple[Cell[RowType], Sequence[RowType]]]:
    """Each cell with its rows, as soon as it is done; with one worker, in this process.

    The rows do not depend on the number of workers. Where this process is interrupted or killed, or a cell fails, the
    worker processes end at once.

    Raises:
        MrtaError: if a cell fails, or a worker process dies.
    """
    if workers == 1:
        for cell in cells:
            tell(cell, 0.0)
            yield cell, cell.perform(lambda share, cell=cell: tell(cell, share))  # type: ignore[misc]
        return
    told = multiprocessing.get_context("spawn").Queue()
    with pool_of(workers, _prepare, (told,)) as pool:
        running = {pool.submit(_perform, index, cell.perform): cell for index, cell in enumerate(cells)}
        while running:
            finished, _ = wait(running, timeout=POLL, return_when=FIRST_COMPLETED)
            while True:
                try:
                    index, share = told.get_nowait()
                except queue.Empty:
                    break
                tell(cells[index], share)
            for future in finished:
                yield running.pop(future), future.result()


_told: Any = None  # in a worker process


def _prepare(told: Any) -> None:
    global _told
    _told = told


def _perform(index: int, perform: Callable[[Tell], Sequence[RowType]]) -> Sequence[RowType]:
    return perform(lambda share: _told.put((index, share)))
