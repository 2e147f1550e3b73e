"""Making the plans to imitate, in several processes, with a progress bar."""

from __future__ import annotations

from concurrent.futures import as_completed
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from mrta_zoo.errors import ConfigError
from mrta_zoo.extras import require
from mrta_zoo.show.terminal.console import fitting, messages_console, say
from mrta_zoo.train.child_process import pool_of
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.imitation.experts import SHARD, ExpertPlan, make_shard, read_plans, shard_path


def make_plans(config: TrainConfig, folder: Path, workers: int = 1, console: Console | None = None) -> list[ExpertPlan]:
    """The plans that a run imitates, read from a folder; those that are missing there are made first.

    Args:
        config: the run.
        folder: where the files of plans are, or go. What is there already is kept, so that this can be interrupted.
        workers: processes.
        console: where to show progress; standard error by default.

    Raises:
        ConfigError: if a file is damaged or belongs to another run, none can be written, or a process dies.
        MissingExtraError: if plans are to be made and the extra "solvers" is missing.
    """
    readers = workers if workers > 1 else 0
    have = read_plans(config, folder, config.imitation_plans, readers)
    if len(have) >= config.imitation_plans:
        return have
    require("solvers", "making plans to imitate")
    from mrta_zoo.policies.classical.local_search import eils

    console = console or messages_console()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ConfigError(f"{folder}: can't write plans there ({error.strerror})") from None
    missing = -(-(config.imitation_plans - len(have)) // SHARD)
    taken = (number for number in range(0, 10**7, SHARD) if not shard_path(folder, number).exists())
    todo = [next(taken) for _ in range(missing)]
    columns = (
        TextColumn("plans {task.completed}/{task.total}"), BarColumn(bar_width=None), TimeElapsedColumn(),
        TimeRemainingColumn(),
    )  # fmt: skip
    say(console, f"{folder}: makes {missing * SHARD:,} plans to imitate")
    eils.compile_once()  # for the processes, which find it on disk; if it cannot be kept, this one says so for all
    with (
        Progress(*fitting(columns, console), console=console, disable=not console.is_terminal) as progress,
        pool_of(workers) as pool,
    ):
        bar = progress.add_task("", total=missing * SHARD)
        # An interrupt need not wait for unfinished files: a file is there as a whole or not at all.
        for made in as_completed([pool.submit(make_shard, config, first, folder) for first in todo]):
            made.result()
            progress.advance(bar, SHARD)
    return read_plans(config, folder, config.imitation_plans, readers)
