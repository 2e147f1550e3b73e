"""Destinations of results: checks before the work that they can be written there."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.atomic import destination


def check_destination(path: Path) -> None:
    """Make sure, as far as can be told without writing, that a file can be written to `path`.

    Raises:
        ConfigError: if it is a folder, its folder does not exist, writing is not permitted, or standard output goes
            there.
    """
    try:
        target = destination(path)
    except IsADirectoryError:
        raise ConfigError(f"{path} is a folder; expected the name of a file to write") from None
    except NotADirectoryError:
        raise ConfigError(f"{path} cannot be written: {path.parent} is not a folder") from None
    except (OSError, ValueError) as error:
        reason = (getattr(error, "strerror", None) or str(error)).lower()
        raise ConfigError(f"{path} cannot be written: {reason}") from None
    if os.path.exists(target):  # the file itself counts: where it cannot be replaced, it is written in place
        place = target
    else:
        place = target.parent
        if not os.path.isdir(place):
            problem = "is not a folder" if os.path.exists(place) else "does not exist"
            named = path.parent if target == Path(os.path.abspath(path)) else place
            raise ConfigError(f"{path} cannot be written: {named} {problem}")
    if not os.access(place, os.W_OK):
        raise ConfigError(f"{path} cannot be written: no permission to write to {place}")
    if _takes_standard_output(target):
        raise ConfigError(f"{path} is where standard output goes; expected a file of its own")


def check_outputs(outputs: Mapping[str, Path | None], inputs: Mapping[str, Path | None]) -> None:
    """Make sure, as far as can be told, that all outputs can be written and none overwrites an input or another output.

    Args:
        outputs: files to be written, by their flags; None for those that are not.
        inputs: files that are read, by what they are.

    Raises:
        ConfigError: if an output cannot be written, or would overwrite an input or another output.
    """
    taken = {what: path for what, path in inputs.items() if path is not None}
    wanted = {flag: path for flag, path in outputs.items() if path is not None}
    for path in wanted.values():
        check_destination(path)
    for flag, path in wanted.items():
        for what, other in taken.items():
            if _same_file(path, other):
                raise ConfigError(f"{flag} is {path}, which is {what}; expected a file of its own")
        taken[f"also {flag}"] = path


def _same_file(one: Path, other: Path) -> bool:
    if os.path.exists(one) and os.path.exists(other):
        # Devices and pipes, such as /dev/null, may be written to by anyone.
        return os.path.samefile(one, other) and os.path.isfile(one)
    return os.path.realpath(one) == os.path.realpath(other)


def _takes_standard_output(path: Path) -> bool:
    try:
        return os.path.isfile(path) and os.path.samestat(os.stat(path), os.fstat(sys.stdout.fileno()))
    except (AttributeError, OSError, ValueError):  # it is closed, or not a file of the system
        return False
