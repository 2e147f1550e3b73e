"""Atomic writing: files are replaced whole or not at all, wherever the system allows it."""

from __future__ import annotations

import errno
import os
import secrets
import shutil
import stat
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import FileIO
from pathlib import Path

_NOT_REPLACEABLE = (errno.EBUSY, errno.EXDEV, errno.EPERM, errno.EACCES, errno.EROFS)
"""The system's errors where a file cannot be replaced, though it may be written to."""

_IN_PLACE = threading.Lock()  # held while writing in place: two writers would mix their output


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Write to the path that it yields; at the end the file there takes the place of `path`.

    Readers see the old file or the new one, never half of it, even if the process is killed or others write the same
    file. If anything is raised, the old file stays untouched. Links are followed: the file that they lead to is
    replaced, and the new one gets its owner and permissions.

    Two kinds of files cannot be replaced. A file that is a mount point, has a second name, belongs to somebody else or
    is in a read-only folder is written in place, by one writer at a time. Its old contents are restored if anything is
    raised; but readers may see a half-written file meanwhile, and one remains if the process is killed. A device or
    pipe, such as ``/dev/stdout``, is simply written to: its own path is yielded.

    >>> with replacing("plan.json") as partial:
    ...     partial.write_text("{}")

    Raises:
        OSError: if the file cannot be put there.
        ValueError: if no file can have such a name.
    """
    target = destination(path)
    if is_special(target):
        yield target
        return
    partial = _new_partial(target)
    if partial is None:
        with _in_place(target):
            yield target
        return
    try:
        yield partial
        _put(partial, target)
    finally:
        partial.unlink(missing_ok=True)


def destination(path: str | os.PathLike[str]) -> Path:
    """The file that writing to `path` changes: the one that links lead to, which need not exist.

    Raises:
        OSError: if it is a folder, no file can be there, or the file there may not be written to.
        ValueError: if no file can have such a name.
    """
    if is_special(path):
        return Path(path)
    target = Path(os.path.realpath(path))
    try:
        mode = os.stat(target).st_mode
    except FileNotFoundError:
        return target
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
    return target


def is_special(path: str | os.PathLike[str]) -> bool:
    """Whether there is a device, a pipe or the like at `path`."""
    return os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path)


def _new_partial(target: Path) -> Path | None:
    """A new empty file with a unique name, beside the target or, if that fails, in the folder for temporary files.

    None if that fails, too, as in a container that may write to nothing but the target.
    """
    there = os.path.exists(target)
    mode = 0o600 if there else 0o666  # an old file may be private; a new one gets the user's default permissions
    name = f".{secrets.token_hex(8)}.tmp"
    partial = target.with_name(name)
    try:
        os.close(os.open(partial, os.O_CREAT | os.O_EXCL | os.O_WRONLY, mode))
    except OSError as error:
        if not there or error.errno not in _NOT_REPLACEABLE:
            raise
        try:
            partial = Path(tempfile.gettempdir()) / name
            os.close(os.open(partial, os.O_CREAT | os.O_EXCL | os.O_WRONLY, mode))
        except OSError:
            return None
    return partial


def _put(partial: Path, target: Path) -> None:
    """Move the finished file to its place."""
    if not os.path.exists(target):
        os.replace(partial, target)
        return
    if partial.parent == target.parent and _make_alike(partial, target):
        try:
            os.replace(partial, target)
            return
        except OSError as error:
            if error.errno not in _NOT_REPLACEABLE:
                raise
    data = partial.read_bytes()
    with _in_place(target) as file:
        _fill(file, data)


def _make_alike(partial: Path, target: Path) -> bool:
    """Give a file another one's owner and permissions; False if it still could not replace it unnoticed."""
    there = os.stat(target)
    if there.st_nlink > 1:
        return False
    if hasattr(os, "chown"):
        with suppress(OSError):
            os.chown(partial, there.st_uid, there.st_gid)
        mine = os.stat(partial)
        if (mine.st_uid, mine.st_gid) != (there.st_uid, there.st_gid):
            return False
    with suppress(OSError):  # some file systems lack some of it
        shutil.copystat(target, partial)
    os.chmod(partial, stat.S_IMODE(there.st_mode))
    os.utime(partial)
    return True


@contextmanager
def _in_place(target: Path) -> Iterator[FileIO]:
    """Write in place, one writer at a time; on failure restore the old contents."""
    with _IN_PLACE, FileIO(target, "r+") as file:
        with suppress(ImportError, OSError):  # Windows, and file systems without locks
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX)  # against other processes, until it is closed
        before = file.readall()
        try:
            yield file
        except BaseException:
            _fill(file, before)
            raise


def _fill(file: FileIO, data: bytes) -> None:
    file.seek(0)
    rest = memoryview(data)
    while rest:
        rest = rest[file.write(rest) :]
    file.truncate()
