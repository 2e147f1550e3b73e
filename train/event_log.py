"""A run's TensorBoard log. If it cannot be written, the run goes on without it."""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any


class EventLog:
    """Writes scalars for TensorBoard. A failure, such as a full disk, is reported once and ends the log.

    Not `SummaryWriter`, whose thread ends with a traceback in that case.

    Args:
        folder: of the log; made if it does not exist.
        purge_step: from this step on, TensorBoard no longer shows what earlier files of the folder hold.
        tell: called with a sentence that says why the log ends.
    """

    def __init__(self, folder: Path, purge_step: int, tell: Callable[[str], None]) -> None:
        self._folder, self._tell = folder, tell
        self._records: Any = None
        self._try(lambda: self._open(purge_step))

    def add(self, step: int, scalars: Mapping[str, float]) -> None:
        """Add a point to each of these curves."""
        if self._records is not None:
            self._try(lambda: self._write_scalars(step, scalars))

    def flush(self) -> None:
        """Write to disk all that was added."""
        if self._records is not None:
            self._try(self._records.flush)

    def __enter__(self) -> EventLog:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        if self._records is not None:
            self._try(self._records.close)

    def _open(self, purge_step: int) -> None:
        from tensorboard.compat.proto.event_pb2 import SessionLog
        from torch.utils.tensorboard import RecordWriter

        self._folder.mkdir(parents=True, exist_ok=True)
        name = f"events.out.tfevents.{int(time.time()):010}.{socket.gethostname()}.{os.getpid()}.{time.monotonic_ns()}"
        self._records = RecordWriter((self._folder / name).open("xb"))
        self._write(step=purge_step, file_version="brain.Event:2")
        self._write(step=purge_step, session_log=SessionLog(status=SessionLog.START))
        self._records.flush()

    def _write_scalars(self, step: int, scalars: Mapping[str, float]) -> None:
        from torch.utils.tensorboard.summary import scalar

        for name, value in scalars.items():
            self._write(step=step, summary=scalar(name, value))

    def _write(self, **what: Any) -> None:
        from tensorboard.compat.proto.event_pb2 import Event

        self._records.write(Event(wall_time=time.time(), **what).SerializeToString())

    def _try(self, act: Callable[[], object]) -> None:
        try:
            act()
        except Exception as error:  # a full disk, no TensorBoard, or whatever a broken one raises
            if self._records is not None:
                with suppress(OSError):
                    self._records.close()
            self._records = None
            why = getattr(error, "strerror", None) or str(error) or type(error).__name__
            self._tell(f"{self._folder}: there is no log for TensorBoard from here on ({why}); training goes on")
