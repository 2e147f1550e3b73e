"""Locks on folders, so that only one process at a time writes to them."""

from __future__ import annotations

from pathlib import Path

from filelock import FileLock, Timeout

from mrta_zoo.errors import ConfigError


def lock_folder(folder: Path) -> FileLock:
    """Keep other processes out of a folder until the lock that is returned is released, or this process ends.

    Needs filelock, which the extras `torch` and `report` install.

    Args:
        folder: exists; this process may lock it several times.

    Raises:
        ConfigError: if another process has locked it.
        OSError: if it cannot be written to.
    """
    lock = FileLock(folder / ".lock", is_singleton=True)
    try:
        lock.acquire(timeout=0)
    except Timeout:
        raise ConfigError(f"{folder} is in use by another run; wait until that ends, or name a new folder") from None
    return lock
