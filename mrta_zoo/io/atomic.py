"""Files that are replaced whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Write to the path that it yields; at the end the file there takes the place of `path`.

    Readers see the old file or the new one, never half of it, also if the process is killed. If anything is raised,
    what was there stays untouched. A device or pipe, such as ``/dev/stdout``, must not be replaced: its own path is
    yielded.

    >>> with replacing("plan.json") as partial:
    ...     partial.write_text("{}")

    Raises:
        OSError: if the file cannot be put there.
        ValueError: if no file can have such a name.
    """
    path = Path(path)
    if path.exists() and not path.is_file() and not path.is_dir():
        yield path
        return
    partial = path.with_name(f".{path.name}.{os.getpid()}.tmp") if path.name else path
    try:
        yield partial
        os.replace(partial, path)
    except BaseException:
        partial.unlink(missing_ok=True)
        raise
