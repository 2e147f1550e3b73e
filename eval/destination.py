"""Whether a file can be written, asked before the work that it is for."""

from __future__ import annotations

import os
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
