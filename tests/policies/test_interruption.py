"""Ctrl-C ends what runs in threads and in compiled code at once."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial, wraps
from typing import Any

import numpy as np
import pytest

from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.policies.interruption import interruptible, run_in_parallel
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.policies.stop import TimeLimit

pytest.importorskip("numba")

from numba.core.dispatcher import Dispatcher

from mrta_zoo.policies.classical.exact import relaxation, selection
from mrta_zoo.policies.classical.local_search import annealing, eils, ils, insertion, tours

CASE = TaptcGenerator(tasks=(40, 40), robots=(3, 3))(np.random.default_rng(3))
BUDGET = 20.0
AT_ONCE = 4.0
"""Seconds; far less than the budget, and more than a busy machine needs."""

pytestmark = pytest.mark.usefixtures("signals_heard")
needs_kill = pytest.mark.skipif(os.name == "nt", reason="os.kill ends the process there")


def interrupt_soon(after: float = 0.1) -> None:
    """Press Ctrl-C in a moment."""
    threading.Timer(after, os.kill, (os.getpid(), signal.SIGINT)).start()


@pytest.fixture
def long_job() -> Iterator[Callable[..., None]]:
    """Takes as long as the test, and would keep the main thread from hearing of Ctrl-C, as compiled code does."""
    over = threading.Event()

    def job(*arguments: object, **options: object) -> None:
        assert threading.current_thread() is not threading.main_thread()
        over.wait(BUDGET)

    yield job
    over.set()


@needs_kill
@pytest.mark.parametrize(
    ("method", "threads"), [("eils", 1), ("eils", 2), ("eils", 3), ("nearest+polish", 2), ("nearest+polish", 3)]
)
def test_searches(method: str, threads: int) -> None:
    solver = make_solver(method, budget=BUDGET, threads=threads)
    begun = time.perf_counter()
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        solver.solve(CASE)
    assert time.perf_counter() - begun < AT_ONCE
    assert not any(thread.name.startswith("ThreadPool") for thread in threading.enumerate())


@needs_kill
def test_a_solver_that_was_interrupted_plans_again() -> None:
    solver = make_solver("eils", budget=0.2, threads=2)
    interrupt_soon(0.05)
    with pytest.raises(KeyboardInterrupt):
        solver.solve(CASE)
    begun = time.perf_counter()
    solver.solve(CASE)
    assert time.perf_counter() - begun >= 0.2  # it searched for all of its budget


@pytest.mark.parametrize("method", ["eils", "ils", "exact", "nearest+polish"])
@pytest.mark.parametrize("budget", [None, 0.05])
def test_nothing_is_raised_within_compiled_code(
    method: str, budget: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Signals' handlers run in the main thread, and what they raise while Numba unpacks arguments can crash it."""
    solver = make_solver(method, budget=budget)
    solver.solve(CASE)  # compiles what it calls
    callers = []

    def watched(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def call(*arguments: Any) -> Any:
            callers.append(threading.current_thread())
            return function(*arguments)

        return call

    for module in (annealing, eils, ils, insertion, tours):
        for name, value in list(vars(module).items()):
            if isinstance(value, Dispatcher):
                monkeypatch.setattr(module, name, watched(value))
    solver.solve(CASE)
    assert callers
    assert threading.main_thread() not in callers


@needs_kill
@pytest.mark.parametrize("what", ["integer-program", "linear-program", "compiling-eils", "compiling-ils"])
def test_what_cannot_be_stopped_is_not_waited_for(
    what: str, monkeypatch: pytest.MonkeyPatch, long_job: Callable[..., None]
) -> None:
    work: Callable[[], object]
    if what == "integer-program":
        monkeypatch.setattr("scipy.optimize.milp", long_job)
        team = selection.Team([0], np.array([[0], [1]]))
        work = partial(selection.select_sets, [team], 2, disjoint=False, limit=TimeLimit.of(BUDGET))
    elif what == "linear-program":
        monkeypatch.setattr("scipy.optimize.linprog", long_job)
        work = partial(relaxation.most_completable, CASE)
    elif what == "compiling-eils":
        monkeypatch.setattr(eils, "_compile", long_job)
        work = eils.compile_once.__wrapped__
    else:
        monkeypatch.setattr(ils, "_solve", long_job)
        work = ils.compile_once.__wrapped__
    begun = time.perf_counter()
    interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        work()
    assert time.perf_counter() - begun < AT_ONCE


def test_jobs_give_what_they_give_and_raise_what_they_raise() -> None:
    threads = set()

    def job(number: int) -> int:
        threads.add(threading.get_ident())
        return number

    assert run_in_parallel([partial(job, number) for number in range(3)], lambda: None) == [0, 1, 2]
    assert threading.get_ident() in threads
    assert interruptible(partial(job, 7)) == 7
    assert interruptible(partial(job, 7), lambda: None) == 7
    with pytest.raises(ZeroDivisionError):
        interruptible(lambda: 1 // 0)


@pytest.mark.parametrize("failing", [0, 1])
def test_where_one_job_fails_the_others_are_stopped(failing: int) -> None:
    stop = threading.Event()

    def wait() -> bool:
        return stop.wait(BUDGET)

    def fail() -> bool:
        raise MemoryError("here")

    begun = time.perf_counter()
    with pytest.raises(MemoryError, match="here"):
        run_in_parallel([fail, wait] if failing == 0 else [wait, fail], stop.set)
    assert time.perf_counter() - begun < AT_ONCE
