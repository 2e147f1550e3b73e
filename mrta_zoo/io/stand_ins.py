"""Stand-ins for files: pointers of Git LFS, web pages, and empty files."""

from __future__ import annotations

import os

HEAD = 1024
"""Bytes at the beginning of a file that are looked at."""


def stand_in(data: bytes) -> str:
    """What these bytes are instead of the file, as the rest of a sentence that begins with its name; "" if they are it.

    >>> stand_in(b"version https://git-lfs.github.com/spec/v1")
    'is a pointer of Git LFS; expected the file itself, which `git lfs pull` fetches'
    """
    head = data[:HEAD].removeprefix(b"\xef\xbb\xbf").lstrip().lower()
    if head.startswith(b"version https://git-lfs.github.com/spec/"):
        return "is a pointer of Git LFS; expected the file itself, which `git lfs pull` fetches"
    if head.startswith((b"<!doctype html", b"<html")):
        return "is a web page; expected the file itself, to which the page may lead"
    return "" if head.strip(b"\0") else "is empty; expected the file itself"


def why_unreadable(path: str | os.PathLike[str], otherwise: object) -> str:
    """The end of a sentence on a file that cannot be read: ": it is a pointer of Git LFS; …", or " (otherwise)".

    Args:
        path: the file.
        otherwise: the reason to give if the file is no stand-in.
    """
    try:
        with open(path, "rb") as file:
            instead = stand_in(file.read(HEAD))
    except (OSError, ValueError):
        instead = ""
    return f": it {instead}" if instead else f" ({otherwise})"
