"""Runs in processes of their own, one torch thread each."""

from __future__ import annotations

import multiprocessing
import queue
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from typing import Any

import torch

from mrta_zoo.eval.studies.job import Job, perform
from mrta_zoo.show.terminal.console import messages_console, progress_bar, say
from mrta_zoo.train.child_process import pool_of
from mrta_zoo.wording import counted

Report = Callable[[Job, float], None]
"""Is told which share of a job is done; 1 only once its rows are there."""

POLL = 0.2
"""Seconds between two looks at what the processes have to tell."""

_told: Any = None


def train_all(jobs: Sequence[Job], missing: Sequence[Job], workers: int) -> None:
    """Do what is missing, with a bar if there is a terminal, and a line on standard error for each run that ends."""
    console = messages_console()
    done = {job.folder: 1.0 for job in jobs if job not in missing}
    with progress_bar() as progress:
        bar = progress.add_task("runs", total=len(jobs), completed=len(done))

        def report(job: Job, share: float) -> None:
            done[job.folder] = share
            progress.update(bar, completed=sum(done.values()))
            if share == 1:
                finished = sum(each == 1 for each in done.values())
                line = (
                    f"{job.variant}, seed {job.seed}: trained and compared ({finished} of {counted(len(jobs), 'run')})"
                )
                say(progress.console if progress.console.is_terminal else console, line)

        perform_all(missing, workers, report)


def perform_all(jobs: Sequence[Job], workers: int, report: Report) -> None:
    """Do all jobs, at most `workers` at a time; with one, in this process.

    Results are the same for any number of workers. Where this process is interrupted or killed, or a job fails, the
    others end at once; they go on from their last checkpoints.

    Raises:
        MrtaError: if a job fails, or a process dies.
    """
    if workers == 1:
        for job in jobs:
            _alone(job, report)
        return
    told = multiprocessing.get_context("spawn").Queue()
    with pool_of(workers, _prepare, (told,)) as pool:
        _watch(jobs, {pool.submit(_perform, index, job): job for index, job in enumerate(jobs)}, told, report)


def _alone(job: Job, report: Report) -> None:
    perform(job, lambda share: report(job, min(share, 0.999)))
    report(job, 1.0)


def _watch(jobs: Sequence[Job], running: dict[Future[None], Job], told: Any, report: Report) -> None:
    while running:
        finished, _ = wait(running, timeout=POLL, return_when=FIRST_COMPLETED)
        while True:
            try:
                index, share = told.get_nowait()
            except queue.Empty:
                break
            report(jobs[index], min(share, 0.999))
        for future in finished:
            job = running.pop(future)
            future.result()
            report(job, 1.0)


def _prepare(told: Any) -> None:
    """Make a process ready, before its first job."""
    global _told
    _told = told
    torch.set_num_threads(1)


def _perform(index: int, job: Job) -> None:
    perform(job, lambda share: _told.put((index, share)))
