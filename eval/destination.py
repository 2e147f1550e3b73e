"""Whether a file can be written, asked before the work that it is for."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from mrta_zoo.errors import ConfigError


def check_destination(path: Path) -> None:
    """Make sure, as far as can be told without writing, that a file can be written to `path`.

    Raises:
        ConfigError: if it is a folder, its folder does not exist, or writing is not permitted.
    """
    # os.path answers False where pathlib raises: without permission, or for a name that no file can have.
    folder = path.parent
    if os.path.isdir(path):
        raise ConfigError(f"{path} is a folder; expected the name of a file to write")
    if not os.path.isdir(folder):
        problem = "is not a folder" if os.path.exists(folder) else "does not exist"
        raise ConfigError(f"{path} cannot be written: {folder} {problem}")
    # A file is replaced by renaming, for which the folder counts; devices are written to as they are.
    place = path if os.path.exists(path) and not os.path.isfile(path) else folder
    if not os.access(place, os.W_OK):
        raise ConfigError(f"{path} cannot be written: no permission to write to {place}")


def check_distinct(outputs: Mapping[str, Path | None], inputs: Mapping[str, Path | None]) -> None:
    """Make sure that no output overwrites an input or another output.

    Args:
        outputs: files to be written, by their flags; None for those that are not.
        inputs: files that are read, by what they are.

    Raises:
        ConfigError: if one does.
    """
    taken = {what: path for what, path in inputs.items() if path is not None}
    for flag, path in outputs.items():
        if path is None:
            continue
        for what, other in taken.items():
            if _same_file(path, other):
                raise ConfigError(f"{flag} is {path}, which is {what}; expected a file of its own")
        taken[f"also {flag}"] = path


def _same_file(one: Path, other: Path) -> bool:
    if os.path.exists(one) and os.path.exists(other):
        # Devices and pipes, such as /dev/null, may be written to by anyone.
        return os.path.samefile(one, other) and os.path.isfile(one)
    return os.path.realpath(one) == os.path.realpath(other)
