"""Long work that Ctrl-C ends at once, though Python's own waiting or compiled code would hold it up or crash."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

Result = TypeVar("Result")

POLL = 0.1
"""Seconds between two looks at whether Ctrl-C was pressed, where waiting cannot be interrupted (Windows)."""


def side_by_side(jobs: Sequence[Callable[[], Result]], stop: Callable[[], None]) -> list[Result]:
    """What each job gives. The first runs in this thread, so that Ctrl-C reaches it, the others in one each.

    Args:
        jobs: one at least.
        stop: makes all of them end soon; called when one fails or is interrupted, whose exception then comes out.
    """

    def run(job: Callable[[], Result]) -> Result:
        try:
            return job()
        except BaseException:
            stop()
            raise

    if len(jobs) == 1:
        return [jobs[0]()]
    with ThreadPoolExecutor(len(jobs) - 1) as pool:
        others = [pool.submit(run, job) for job in jobs[1:]]
        return [run(jobs[0]), *(other.result() for other in others)]


def interruptible(job: Callable[[], Result], stop: Callable[[], None] | None = None) -> Result:
    """What a job gives that Ctrl-C must not reach, such as compiled code.

    It runs in a thread of its own: Python raises what a signal's handler raises in the main thread alone, and there
    perhaps amid what Numba does to hand over arguments, which then crashes.

    Args:
        job: the work.
        stop: makes it end soon; called after Ctrl-C, and the end is then waited for. Without it the job goes on there
            until it ends or the process does, but nobody waits.
    """
    found: Future[Result] = Future()

    def run() -> None:
        try:
            found.set_result(job())
        except BaseException as error:
            found.set_exception(error)

    thread = threading.Thread(target=run, daemon=True)
    try:
        thread.start()
        while thread.is_alive():
            thread.join(POLL)
    except BaseException:
        if stop is not None:
            stop()
            if thread.is_alive():  # else it was interrupted as it began
                thread.join()
        raise
    return found.result()
