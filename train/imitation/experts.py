"""Expert plans: those of a strong search on training scenarios, for a network to imitate before REINFORCE.

A plan is stored as its routes alone: its scenario follows from the seed and the plan's number.
"""

from __future__ import annotations

import io
import struct
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import numpy.typing as npt

from mrta_zoo.errors import ConfigError, PlanError
from mrta_zoo.io.atomic import replacing
from mrta_zoo.io.stand_ins import why_unreadable
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario
from mrta_zoo.train.child_process import pool_of
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.distribution import draw_size, training_generator
from mrta_zoo.train.random_streams import Stream, random_numbers
from mrta_zoo.verify import verify

ITERATIONS_PER_TASK = 24
"""How long the search (`EilsSolver`) looks for each plan: about 0.1 s with 100 tasks, within 1 % of its best."""
SHARD = 500
"""Plans per file."""

UNREADABLE = (
    OSError,
    ValueError,
    KeyError,
    TypeError,
    EOFError,
    RuntimeError,
    struct.error,
    zipfile.BadZipFile,
    zlib.error,
)
"""What NumPy raises for a damaged file."""

Routes = tuple[tuple[int, ...], ...]


@dataclass(frozen=True, slots=True)
class ExpertPlan:
    """A scenario and the routes that the search found for it."""

    scenario: Scenario
    routes: Routes


def expert_scenario(config: TrainConfig, number: int) -> Scenario:
    """The scenario of plan `number`."""
    rng = random_numbers(config.seed, Stream.PLANS, number)
    return training_generator(config, draw_size(config, rng))(rng)


def shard_path(folder: Path, first: int) -> Path:
    """The file of the plans from number `first` on."""
    return folder / f"{first:07d}.npz"


def make_shard(config: TrainConfig, first: int, folder: Path) -> Path:
    """Plan `SHARD` scenarios, from number `first` on, and write them to a file, through `replacing`.

    Needs the extra `solvers`.
    """
    from mrta_zoo.policies.classical.local_search.eils import EilsConfig, EilsSolver

    # Insertion by deadline is newer than the shipped policies, which imitated the plans made without it.
    solver = EilsSolver(config=EilsConfig(iterations_per_task=ITERATIONS_PER_TASK, by_deadline=0.0))
    routes = [solver.solve(expert_scenario(config, number)).routes for number in range(first, first + SHARD)]
    path = shard_path(folder, first)
    with replacing(path) as partial, partial.open("wb") as file:
        np.savez_compressed(
            file,
            index=np.arange(first, first + SHARD),
            robots=np.array([len(each) for each in routes]),
            lengths=np.array([len(route) for each in routes for route in each]),
            tasks=np.array([task for each in routes for route in each for task in route], dtype=np.int16),
        )
    return path


def read_plans(config: TrainConfig, folder: Path, most: int, workers: int = 0) -> list[ExpertPlan]:
    """The first plans in a folder, with their scenarios.

    Args:
        config: the run.
        folder: where the files are.
        most: how many plans to read.
        workers: processes that read; 0 reads in this process.

    Raises:
        ConfigError: if a file is damaged, or does not belong to the configuration: the first plan of each file must
            finish all its tasks in time, which plans of other scenarios do not.
    """
    plans: list[ExpertPlan] = []
    paths = sorted(folder.glob("*.npz"))
    read = partial(_read_shard, config)
    if workers:
        with pool_of(workers) as pool:
            for shard in pool.map(read, paths):
                plans += shard
                if len(plans) >= most:
                    pool.shutdown(wait=False, cancel_futures=True)
                    break
        return plans[:most]
    for path in paths:
        if len(plans) >= most:
            break
        plans += read(path)
    return plans[:most]


def _read_shard(config: TrainConfig, path: Path) -> list[ExpertPlan]:
    try:
        with np.load(io.BytesIO(path.read_bytes()), allow_pickle=False) as file:
            index, robots, lengths, tasks = (file[name] for name in ("index", "robots", "lengths", "tasks"))
        numbered = list(zip(index.tolist(), _split(robots, lengths, tasks), strict=True))
    except UNREADABLE as error:
        why = why_unreadable(path, type(error).__name__)
        raise ConfigError(f"{path}: not a readable file of plans{why}") from None
    plans = []
    for number, routes in numbered:
        scenario = expert_scenario(config, number)
        if not _fits(scenario, routes, in_full=number == numbered[0][0]):
            raise ConfigError(f"{path}: plan {number} does not fit its scenario; was it made with another seed?")
        plans.append(ExpertPlan(scenario, routes))
    return plans


def _fits(scenario: Scenario, routes: Routes, in_full: bool) -> bool:
    """Whether the routes can be this scenario's; in full, which takes longer, also whether each task is in time."""
    if not in_full:
        tasks = [task for route in routes for task in route]
        possible = all(0 <= task < scenario.num_tasks for task in tasks)
        return possible and len(set(tasks)) == len(tasks) and len(routes) == scenario.num_robots
    try:
        return verify(scenario, Plan(routes)).completed == sum(map(len, routes))
    except PlanError:
        return False


def _split(
    robots: npt.NDArray[np.int64], lengths: npt.NDArray[np.int64], tasks: npt.NDArray[np.int16]
) -> Sequence[Routes]:
    if lengths.sum() != len(tasks) or robots.sum() != len(lengths) or min(lengths.min(), robots.min()) < 0:
        raise ValueError("its routes do not add up")
    ends = np.cumsum(lengths).tolist()
    starts = [0, *ends[:-1]]
    routes = [tuple(tasks[start:end].tolist()) for start, end in zip(starts, ends, strict=True)]
    last = np.cumsum(robots).tolist()
    return [tuple(routes[end - count : end]) for end, count in zip(last, robots.tolist(), strict=True)]
