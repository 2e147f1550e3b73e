"""The command ``mrta-zoo train``: its flags, and which run they begin or go on with."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Annotated

import torch
import tyro

from mrta_zoo.bounds import MAX_THREADS, check_threads
from mrta_zoo.cli import flags
from mrta_zoo.errors import ConfigError
from mrta_zoo.io.lock import lock_folder
from mrta_zoo.policies.cpu_threads import cpu_threads
from mrta_zoo.train import checkpoint
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.imitation.plans import make_plans
from mrta_zoo.train.presets import PRESETS
from mrta_zoo.train.reinforce import RunOptions
from mrta_zoo.train.run import train


@dataclass(frozen=True, slots=True, kw_only=True)
class TrainCommand:
    """Train a policy by REINFORCE with one network for all robots, or one for each (--sharing independent), or one for
    each kind of robots (--sharing by-capacity).

    Choose a preset, and change what you like with the flags below; their defaults are the preset's.

    Example: mrta-zoo train --preset smoke --out runs/smoke

    Each validation shows the mean share of tasks completed, and the mean cost per task (Eq. 1 of the paper: the sum of
    finish / deadline over the tasks missed).

    The folder then holds policy.safetensors and policy.json (the best policy by validation; usable as
    `mrta-zoo eval --methods runs/smoke`), config.json, history.csv, checkpoints, and TensorBoard events
    (`tensorboard --logdir runs`). Stopped at any moment, even killed, the run goes on with --resume to the same
    result.
    """

    preset: str = "fast"
    """Where the other flags' defaults come from: capam-plus (the shipped policy), capam, am, capam-p1, capam-p2 (the
    paper's networks as shipped; all five for a GPU), paper (Table I of the paper, for a GPU), fast (the paper's network
    with nothing to imitate; half an hour or so on one CPU thread), smoke (a minute or so)."""
    out: Path
    """Folder of the run."""
    resume: bool = False
    """Go on with the run in --out; its configuration is kept, so that no other flag is needed."""
    prepare: bool = False
    """Only write the configuration and make the plans to imitate, if any. Go on with --resume, perhaps on another
    machine: plans take CPU cores, training a GPU."""
    workers: int = 1
    """Processes that make the plans to imitate and, on a GPU, draw scenarios ahead of time."""
    compiled: bool = False
    """Compile the decoder's layers: a minute at first, for quicker steps on a GPU."""
    threads: int = 1
    """CPU threads; 0 leaves the choice to torch. On a quiet machine two can train faster than one, on a busy one they
    can be far slower. Results are the same only for the same number."""
    config: Annotated[TrainConfig, tyro.conf.arg(name="")] = field(default_factory=TrainConfig)


def train_command(argv: Sequence[str]) -> None:
    """Run `mrta-zoo train` with these arguments.

    Raises:
        ConfigError: if an option makes no sense or the folder holds no run, or already one.
    """
    command = parse(argv)
    check_threads(command.threads, least=0)
    if not 1 <= command.workers <= MAX_THREADS:
        raise ConfigError(f"workers is {command.workers}; expected a whole number from 1 to {MAX_THREADS}")
    with cpu_threads(command.threads or torch.get_num_threads()):
        _run(command)


def _run(command: TrainCommand) -> None:
    options = RunOptions(workers=command.workers, compiled=command.compiled)
    if command.resume:
        _check_kept(command)
    else:
        run, seconds = checkpoint.start(command.out, command.config, options), 0.0
    lock = lock_folder(command.out)
    try:
        if command.resume:  # under the lock: what another process is still writing would be read half old
            run, seconds = checkpoint.resume(command.out, options)
        if run.imitates:
            run.set_plans(make_plans(run.config, command.out / "plans", command.workers))
        if command.prepare:
            return
        train(run, command.out, seconds)
    except KeyboardInterrupt:
        prepare = " --prepare" if command.prepare else ""
        print(f"go on with: mrta-zoo train --out {command.out} --resume{prepare}", file=sys.stderr)
        raise
    finally:
        lock.release()


def _check_kept(command: TrainCommand) -> None:
    """Raises `ConfigError` if a run that is to be resumed is not there, or was told otherwise."""
    kept = checkpoint.saved_config(command.out)
    changed = [f.name for f in fields(TrainConfig) if getattr(command.config, f.name) != getattr(kept, f.name)]
    if changed:
        raise ConfigError(
            f"--resume keeps the run's configuration; {changed[0]} is {getattr(kept, changed[0])} in "
            f"{command.out}, not {getattr(command.config, changed[0])}; to train on otherwise, begin a new "
            f"run from its weights: --initial {command.out}, another --out, and no --resume"
        )


def parse(argv: Sequence[str]) -> TrainCommand:
    """Flags to a command; the preset (or, to be resumed, the saved run) supplies the defaults."""
    preset = _peek(argv, "--preset") or "fast"
    if preset not in PRESETS:
        raise ConfigError(f"there is no preset {preset!r}; expected one of {', '.join(PRESETS)}")
    out = _peek(argv, "--out")
    config = PRESETS[preset]
    if "--resume" in argv and out and not {"--help", "-h"} & set(argv) and _peek(argv, "--preset") is None:
        config = checkpoint.saved_config(Path(out))
    default = TrainCommand(preset=preset, out=Path(out) if out else tyro.MISSING, config=config)
    return flags.parse(TrainCommand, argv, "train", default=default)


def _peek(argv: Sequence[str], flag: str) -> str | None:
    """The value of a flag, before the real parsing, whose defaults depend on it."""
    for index, argument in enumerate(argv):
        if argument == flag and index + 1 < len(argv):
            return argv[index + 1]
        if argument.startswith(flag + "="):
            return argument[len(flag) + 1 :]
    return None
