"""What TensorBoard shows of a run, whatever has happened to it."""

from __future__ import annotations

import shlex
import shutil
import sys
from pathlib import Path
from typing import Any

import pytest

from mrta_zoo.cli.train import train_command
from mrta_zoo.train import checkpoint
from mrta_zoo.train.reinforce import Reinforce

ARGUMENTS = shlex.split(
    "--preset smoke --tasks 10 --reference-tasks 10 --updates 8 --epoch 2 --scenarios 4 --validation-scenarios 8 "
    "--embedding 32 --heads 4 --threads 1"
)


def shown(run: Path, tag: str) -> list[int]:
    """The updates at which there is a point."""
    for index, path in enumerate(sorted((run / "tensorboard").iterdir(), key=lambda path: path.stat().st_mtime_ns)):
        path.rename(path.with_name(f"events.out.tfevents.{index}"))  # by names of the same second it knows no order
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    events = EventAccumulator(str(run / "tensorboard"), {"scalars": 0})
    events.Reload()
    return [event.step for event in events.Scalars(tag)]


def test_every_validation_and_update_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Interrupted before the first update, after a validation, and between two of them, and resumed when finished."""
    run = tmp_path / "run"
    first = [*ARGUMENTS, "--out", str(run)]
    again = ["--out", str(run), "--resume", "--threads", "1"]
    save = checkpoint.save

    def interrupted_after(update: int) -> None:
        def save_and_stop(folder: Path, of: Reinforce, seconds: float) -> None:
            save(folder, of, seconds)
            if of.update >= update:
                raise KeyboardInterrupt

        monkeypatch.setattr(checkpoint, "save", save_and_stop)

    interrupted_after(0)
    with pytest.raises(KeyboardInterrupt):
        train_command(first)
    assert shown(run, "validation/completion") == [0]
    interrupted_after(4)
    with pytest.raises(KeyboardInterrupt):
        train_command(again)
    assert shown(run, "validation/completion") == [0, 2, 4]
    shutil.rmtree(run / "checkpoints" / "00000004")  # it was killed before it had written this one
    monkeypatch.undo()
    for _ in range(2):
        train_command(again)
        assert shown(run, "validation/completion") == [0, 2, 4, 6, 8]
        assert shown(run, "train/loss") == [1, 2, 3, 4, 5, 6, 7, 8]


def test_before_the_first_checkpoint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def killed(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(checkpoint, "save", killed)
    with pytest.raises(KeyboardInterrupt):
        train_command([*ARGUMENTS, "--out", str(tmp_path)])
    monkeypatch.undo()
    train_command(["--out", str(tmp_path), "--resume", "--threads", "1"])
    assert shown(tmp_path, "validation/completion") == [0, 2, 4, 6, 8]


def test_what_is_saved_is_shown_even_after_a_kill(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[list[int]] = []
    save = checkpoint.save

    def save_and_look(folder: Path, run: Reinforce, seconds: float) -> None:
        save(folder, run, seconds)
        copy = tmp_path / f"as of {run.update}"
        shutil.copytree(folder / "tensorboard", copy / "tensorboard")
        seen.append(shown(copy, "validation/completion"))

    monkeypatch.setattr(checkpoint, "save", save_and_look)
    train_command([*ARGUMENTS, "--out", str(tmp_path / "run")])
    assert seen == [[0], [0, 2], [0, 2, 4], [0, 2, 4, 6], [0, 2, 4, 6, 8]]


@pytest.mark.parametrize("moment", ["write", "flush", "close"])
def test_training_goes_on_though_nothing_can_be_shown(
    tmp_path: Path, moment: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(writer: Any, *_: object) -> None:
        writer._writer.close()
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(f"torch.utils.tensorboard.RecordWriter.{moment}", full)
    train_command([*ARGUMENTS, "--out", str(tmp_path)])
    assert checkpoint.resume(tmp_path)[0].history[-1].update == 8
    told = capsys.readouterr().err
    log = tmp_path / "tensorboard"
    assert told.count(f"{log}: there is no log for TensorBoard from here on (No space left on device)") == 1
    assert "Traceback" not in told


def test_training_does_without_tensorboard(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in [name for name in sys.modules if name.startswith("torch.utils.tensorboard")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "tensorboard", None)
    train_command([*ARGUMENTS, "--out", str(tmp_path)])
    assert (tmp_path / "policy.safetensors").exists()
    assert capsys.readouterr().err.count("there is no log for TensorBoard from here on") == 1


def test_a_folder_that_goes_away_costs_no_weights(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run, step = tmp_path / "run", Reinforce.step

    def step_and_remove(self: Reinforce) -> object:
        shutil.rmtree(run, ignore_errors=True)
        return step(self)

    monkeypatch.setattr(Reinforce, "step", step_and_remove)
    train_command([*ARGUMENTS, "--out", str(run)])
    assert (run / "policy.safetensors").exists()
    assert checkpoint.resume(run)[0].update == 8
