"""Long jobs that Ctrl-C ends at once, where Python's own waiting would delay it and compiled code could crash."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

Result = TypeVar("Result")

POLL = 0.1
"""Seconds between two checks for Ctrl-C where waiting cannot be interrupted (Windows)."""


def run_in_parallel(jobs: Sequence[Callable[[], Result]], cancel: Callable[[], None]) -> list[Result]:
    """The jobs' results. The first job runs in this thread, where Ctrl-C reaches it, and the others in one thread each.

    Args:
        jobs: at least one.
        cancel: makes all of them end soon; called when one fails or is interrupted, and its exception is raised.
    """

    def run(job: Callable[[], Result]) -> Result:
        try:
            return job()
        except BaseException:
            cancel()
            raise

    if len(jobs) == 1:
        return [jobs[0]()]
    with ThreadPoolExecutor(len(jobs) - 1) as pool:
        others = [pool.submit(run, job) for job in jobs[1:]]
        return [run(jobs[0]), *(other.result() for other in others)]


def interruptible(job: Callable[[], Result], cancel: Callable[[], None] | None = None) -> Result:
    """The result of a job that Ctrl-C must not reach, such as compiled code.

    The job runs in a thread of its own. Python runs signal handlers in the main thread only, and an exception raised
    there while Numba unpacks arguments can crash the process.

    Args:
        job: the work.
        cancel: makes it end soon; called after Ctrl-C, which then waits for the end. Without it nobody waits, and the
            job runs on until it or the process ends.
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
        if cancel is not None:
            cancel()
            if thread.is_alive():  # else it was interrupted as it began
                thread.join()
        raise
    return found.result()
