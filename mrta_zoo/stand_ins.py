"""What lies where a file should be: a pointer of Git LFS, a web page, or nothing."""

from __future__ import annotations

import os

HEAD = 1024
"""Bytes at the beginning of a file that tell."""


def stand_in(data: bytes) -> str:
    """What these bytes are instead of a file's, as the rest of a sentence that begins with its name; "" if nothing.

    >>> stand_in(b"version https://git-lfs.github.com/spec/v1")
    'is a pointer of Git LFS; expected the file itself, which `git lfs pull` fetches'
    """
    head = data[:HEAD].removeprefix(b"\xef\xbb\xbf").lstrip().lower()
    if head.startswith(b"version https://git-lfs.github.com/spec/"):
        return "is a pointer of Git LFS; expected the file itself, which `git lfs pull` fetches"
    if head.startswith((b"<!doctype html", b"<html")):
        return "is a web page; expected the file itself, to which the page may lead"
    return "" if head.strip(b"\0") else "is empty; expected the file itself"


def stand_in_at(path: str | os.PathLike[str]) -> str:
    """As `stand_in`, of a file; also "" if it cannot be read."""
    try:
        with open(path, "rb") as file:
            return stand_in(file.read(HEAD))
    except (OSError, ValueError):
        return ""
