"""Paths given by users: their suffixes, their spelling on other systems, and URLs given by mistake."""

from __future__ import annotations

import os
import re
from contextlib import suppress
from pathlib import Path

from mrta_zoo.errors import MrtaError
from mrta_zoo.wording import composed

_URL = re.compile(r"[a-z][a-z0-9+.-]+:/", re.IGNORECASE)  # a drive has only one letter


def suffix_of(path: str | os.PathLike[str]) -> str:
    """The suffix in lower case, such as ".csv"; "" if there is none."""
    return Path(path).suffix.lower()


def as_spelt(path: Path) -> Path:
    """`path` or, if nothing is there, the first entry of its folder that differs only in case or encoding of accents.

    Other systems spell file names like that.
    """
    if os.path.lexists(path):
        return path
    with suppress(OSError, ValueError):  # ValueError: a null character in the path
        for name in sorted(os.listdir(path.parent)):
            if composed(name).lower() == composed(path.name).lower():
                return path.with_name(name)
    return path


def make_folder(path: Path) -> None:
    """Make a folder and those above it, unless they exist; if `path` is a link, the folder that it leads to.

    Raises:
        OSError: if it cannot be made.
    """
    Path(os.path.realpath(path)).mkdir(parents=True, exist_ok=True)


def check_no_url(path: str | os.PathLike[str], error: type[MrtaError]) -> None:
    """Refuse a URL, which `pathlib` would take for a path with a slash too many.

    Raises:
        error: if it is one.
    """
    text = os.fspath(path)
    if _URL.match(text):
        url = text if "://" in text else text.replace(":/", "://", 1)
        raise error(f"{url} is a URL; expected the path of a file or folder on this computer") from None
