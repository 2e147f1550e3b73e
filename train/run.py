"""Training to the end, with a progress bar, TensorBoard and checkpoints."""

from __future__ import annotations

import time
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from mrta_zoo.digits import share
from mrta_zoo.errors import ConfigError
from mrta_zoo.io.outputs import write_elsewhere
from mrta_zoo.policies.neural.weights import save_policy
from mrta_zoo.show.terminal.console import fitting, messages_console, say
from mrta_zoo.train import checkpoint
from mrta_zoo.train.event_log import EventLog
from mrta_zoo.train.reinforce import Reinforce, Update
from mrta_zoo.wording import counted

CURVES = ("train/loss", "train/gradient_norm", "train/learning_rate", "train/episodes_per_second")
"""The curves of updates in TensorBoard."""


def train(run: Reinforce, folder: Path, seconds: float = 0.0, console: Console | None = None) -> None:
    """Train to the end, showing progress and leaving checkpoints in `folder`.

    Args:
        run: the run, fresh or resumed.
        folder: where checkpoints, policy and TensorBoard events go.
        seconds: time already spent on it.
        console: where to show progress; standard error by default.
    """
    console, config = console or messages_console(), run.config
    say(console, f"{folder}: {_what_it_does(run)}")
    begun = time.perf_counter() - seconds
    first = run.update
    per_update = config.scenarios * config.samples
    with (
        # Updates that an earlier session logged after its last checkpoint come again.
        EventLog(folder / "tensorboard", first + 1 if run.history else 0, lambda why: say(console, why)) as board,
        Progress(*fitting(_columns(), console), console=console, disable=not console.is_terminal) as progress,
    ):
        bar = progress.add_task("", total=config.total_updates, completed=first, rate=0.0, completion="-")
        session = time.perf_counter()
        for event in run.run():
            now = time.perf_counter()
            if isinstance(event, Update):
                rate = (event.update - first) * per_update / (now - session)
                progress.update(bar, completed=event.update, rate=rate)
                values = (event.loss, event.gradient_norm, event.learning_rate, rate)
                board.add(event.update, dict(zip(CURVES, values, strict=True)))
                continue
            board.add(event.update, {"validation/completion": event.completion, "validation/cost": event.cost})
            board.flush()  # before the checkpoint, after which they do not come again
            _save(folder, run, now - begun)
            shown = f"{share(event.completion, 2)} %"
            progress.update(bar, completion=shown)
            note = "  (baseline replaced)" if event.baseline_replaced else ""
            say(
                progress.console,
                f"update {event.update:>6}  episodes {event.episodes:>9,}  validation completion {shown}  "
                f"cost {event.cost:.4f}  {now - begun:.0f} s{note}",
            )
    best = run.best
    say(
        console,
        f"Best validation completion {share(best.completion, 2)} % at update {best.update}; "
        f"the policy is in {folder / 'policy.safetensors'}",
    )


def _columns() -> tuple[ProgressColumn, ...]:
    return (
        TextColumn("update {task.completed}/{task.total}"),
        BarColumn(bar_width=None),
        TextColumn("{task.fields[rate]:.0f} episodes/s"),
        TextColumn("completion {task.fields[completion]}"),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )


def _what_it_does(run: Reinforce) -> str:
    """What a run is about to do, in one line."""
    config, total, imitated = run.config, run.config.total_updates, ""
    parameters = sum(parameter.numel() for parameter in run.network.parameters())
    if config.imitation_updates:
        imitated = f"{config.imitation_updates} of {counted(config.imitation_batch, 'plan')}, then "
    begins = f"goes on after update {run.update} of {total}" if run.update else counted(total, "update")
    return (
        f"{begins}, {imitated}of {config.scenarios} x {config.samples} episodes on {run.device}, "
        f"{parameters:,} parameters; validation on {counted(config.validation_scenarios, 'scenario', form=',')}"
    )


def _save(folder: Path, run: Reinforce, seconds: float) -> None:
    """Write a checkpoint or, if that fails, at least the weights somewhere else.

    Raises:
        ConfigError: if it cannot be written.
    """
    try:
        checkpoint.save(folder, run, seconds)
    except ConfigError as error:
        info = checkpoint.policy_info(run, seconds)
        place = write_elsewhere(folder / "policy.safetensors", lambda path: save_policy(path, run.network, info))
        instead = f"; the policy as it is now is in {place}" if place else ""
        raise ConfigError(f"{error}{instead}") from None
