"""A folder of measurements that can be resumed: what was asked for is kept beside the rows, and must stay the same."""

from __future__ import annotations

import hashlib
import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal, TypeVar

import msgspec
import numpy as np
from filelock import FileLock

from mrta_zoo import __version__
from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.rows_file import RowsFile, RowType
from mrta_zoo.eval.runner import Solved, solve_cases
from mrta_zoo.io import Case
from mrta_zoo.io.lock import lock_folder
from mrta_zoo.io.paths import make_folder
from mrta_zoo.io.source import read_text, write_text
from mrta_zoo.policies.neural.policy_files import info_file, weights_file
from mrta_zoo.policies.pretrained import pretrained_names, pretrained_path
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.policies.registry import METHODS, POLISH
from mrta_zoo.scenario import QUANTITIES
from mrta_zoo.show.terminal.console import progress_bar
from mrta_zoo.wording import composed

MANIFEST = "manifest.json"
_LOCKS: list[FileLock] = []  # held until the process ends
Settings = Mapping[str, Any]
Key = TypeVar("Key")


@dataclass(frozen=True, slots=True, kw_only=True)
class Manifest:
    """Everything that the numbers of an experiment depend on, the machine excepted.

    Attributes:
        command: of `mrta-zoo`, that made it.
        settings: what it was told, as JSON values.
        cases: digest of the cases, see `digest_of_cases`.
        weights: digest of the weights of each trained method.
        version: of this package.
        format: always "mrta_zoo.experiment".
    """

    command: str
    settings: dict[str, Any]
    cases: str
    weights: dict[str, str]
    version: str = __version__
    format: Literal["mrta_zoo.experiment"] = "mrta_zoo.experiment"


def make_manifest(command: str, settings: Settings, cases: Iterable[Case], methods: Iterable[str]) -> Manifest:
    """The manifest of an experiment that is about to begin or to be resumed."""
    bases = dict.fromkeys(method.removesuffix(POLISH) for method in methods)
    weights = {method: digest_of_weights(method) for method in bases if method not in METHODS}
    return Manifest(command=command, settings=dict(settings), cases=digest_of_cases(cases), weights=weights)


def open_experiment(folder: Path, manifest: Manifest) -> None:
    """Make the folder, or make sure that what it holds is the same experiment, begun earlier. One process at a time.

    Raises:
        ConfigError: if it holds anything else, or cannot be made.
    """
    path = folder / MANIFEST
    try:
        _check_ours(folder)
        make_folder(folder)
        _LOCKS.append(lock_folder(folder))
        if not os.path.lexists(path):
            _check_ours(folder)
            write_text(_text(manifest), path, ConfigError)
            return
        text = composed(read_text(path, ConfigError, "what this command has written"))
        earlier = msgspec.json.decode(text, type=Manifest)
    except OSError as error:
        raise ConfigError(f"{folder} cannot be used: {(error.strerror or str(error)).lower()}") from None
    except msgspec.MsgspecError as error:
        raise ConfigError(f"{path}: {error}; expected what this command has written there") from None
    now = msgspec.json.decode(_text(manifest), type=Manifest)
    if difference := _difference(earlier, now):
        raise ConfigError(
            f"{folder} holds results of another run: {difference}; expected the same command on the same cases, or a "
            "new folder"
        )


def _text(manifest: Manifest) -> str:
    """What is written of a manifest: names are the same whichever way their accents are written."""
    return composed(json.dumps(asdict(manifest), indent=2, ensure_ascii=False)) + "\n"


def _check_ours(folder: Path) -> None:
    if os.path.exists(folder) and not os.path.isdir(folder):
        raise ConfigError(f"{folder} is a file; expected a folder, new, empty, or of this command")
    if os.path.lexists(folder / MANIFEST) or not os.path.isdir(folder):
        return
    if any(not name.startswith(".") for name in os.listdir(folder)):
        raise ConfigError(
            f"{folder} is not empty and holds no {MANIFEST}; expected a folder that is new, empty, or of this command"
        )


@contextmanager
def resumable() -> Iterator[None]:
    """For a command that keeps what it has measured: after Ctrl-C, say how to go on."""
    try:
        yield
    except KeyboardInterrupt:
        print("the same command goes on where it stopped", file=sys.stderr)
        raise


def _difference(earlier: Manifest, now: Manifest) -> str:
    """What sets two manifests apart, in words; empty if nothing does."""
    if earlier.command != now.command:
        return f"the command was {earlier.command}, now it is {now.command}"
    if earlier.version != now.version:
        return f"it was made by version {earlier.version}, this is {now.version}"
    for name in dict.fromkeys((*earlier.settings, *now.settings)):
        before, after = earlier.settings.get(name), now.settings.get(name)
        if before != after:
            return f"{name} was {_shown(before)}, now it is {_shown(after)}"
    if earlier.cases != now.cases:
        return "the cases have changed"
    for name in dict.fromkeys((*earlier.weights, *now.weights)):
        if earlier.weights.get(name) != now.weights.get(name):
            return f"the weights of {name} have changed"
    return ""


def _shown(value: object) -> str:
    if isinstance(value, list):
        return ",".join(map(str, value))
    return "not given" if value is None else str(value)


def measure(
    cases: Sequence[Case],
    solvers: Mapping[str, Solver],
    file: RowsFile[RowType],
    record: Callable[[Case, str, Solved], RowType],
    known: Callable[[RowType], tuple[str, str] | None],
    what: str = "",
) -> None:
    """Run every method on every case that the file does not know yet, and append each row as soon as it is known.

    Args:
        cases: what to plan.
        solvers: the methods by name, run one after the other.
        file: where the rows go.
        record: makes a row of a solved case.
        known: case and method of a row that counts as done; None for rows of something else.
        what: said in front of the progress bar.

    Raises:
        MrtaError: if a method fails on a case, or the file has a row twice or one of another case or method.
    """
    keys = [_key(*key) for row in file.rows if (key := known(row)) is not None]
    done = set(keys)
    if len(done) < len(keys):
        twice = next(key for index, key in enumerate(keys) if key in keys[:index])
        raise ConfigError(f"{file.path} has two rows for method {twice[1]} on case {twice[0]}; expected one")
    strange = done - {_key(case.name, method) for case in cases for method in solvers}
    if strange:
        case_name, method = min(strange)
        raise ConfigError(
            f"{file.path} has a row for method {method} on case {case_name}, which this command does not ask for; "
            "expected its own rows alone"
        )
    with progress_bar() as progress:
        bar = progress.add_task(what, total=len(cases) * len(solvers))
        for method, solver in solvers.items():
            missing = [case for case in cases if _key(case.name, method) not in done]
            progress.update(bar, advance=len(cases) - len(missing), description=f"{what}{method}")
            for case, solved in solve_cases(missing, method, solver):
                file.append(record(case, method, solved))
                progress.update(bar, advance=1)


def _key(case: str, method: str) -> tuple[str, str]:
    return composed(case), composed(method)


def digest_of_cases(cases: Iterable[Case]) -> str:
    """SHA-256 of names, scenarios and best known results, in order."""
    digest = hashlib.sha256()
    for case in cases:
        scenario = case.scenario
        tasks, robots = scenario.said("task"), scenario.said("robot")
        optional = [each.name for each in QUANTITIES if each.default == 0 and each.name in {**tasks, **robots}]
        head = [composed(case.name), scenario.num_tasks, scenario.num_robots, case.best_known, *optional]
        digest.update(json.dumps(head).encode())
        size = np.array(scenario.map_size)
        for array in (scenario.task_xy, *tasks.values(), scenario.robot_xy, *robots.values(), size):
            digest.update(array.astype("<f8").tobytes())
        if any(scenario.map_origin):  # as digests of before, which know of none
            digest.update(np.array(scenario.map_origin).astype("<f8").tobytes())
    return digest.hexdigest()


def digest_of_weights(method: str) -> str:
    """SHA-256 of a trained policy's two files.

    Args:
        method: the name of one that ships with the package, a ``.safetensors`` file, or the folder of a run.

    Raises:
        ConfigError: if they cannot be read.
    """
    path = pretrained_path(method) if method in pretrained_names() else weights_file(Path(method))
    digest = hashlib.sha256()
    for file in (path, info_file(path)):
        try:
            digest.update(file.read_bytes())
        except OSError as error:
            raise ConfigError(f"{file} cannot be read: {(error.strerror or str(error)).lower()}") from None
    return digest.hexdigest()
