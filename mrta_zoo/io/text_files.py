"""Text files: reading and writing them, the numbers and names in them, and how error messages show these."""

from __future__ import annotations

import math
import os
import re

from mrta_zoo.errors import MrtaError
from mrta_zoo.io.atomic import replacing
from mrta_zoo.io.paths import check_no_url
from mrta_zoo.io.stand_ins import stand_in
from mrta_zoo.wording import is_utf8

StrPath = str | os.PathLike[str]

MAX_BYTES = 64 * 2**20
"""More than any scenario of a sensible size; it keeps a device file from being read forever."""

# What `float` accepts is wider: "1_0", "infinity", "nan", digits of other scripts.
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_COUNT = re.compile(r"[0-9]+")
_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f]")


def read_text(path: StrPath, error: type[MrtaError], expected: str = "a scenario, a plan or a table") -> str:
    """The file's text, UTF-8 with or without byte order mark, line ends as ``\\n``.

    Args:
        path: the file.
        error: what to raise.
        expected: what the file should hold, for messages.

    Raises:
        error: if there is no such file, it cannot be read, is too large, or holds no text.
    """
    try:
        with open(path, "rb") as file:
            data = file.read(MAX_BYTES + 1)
    except FileNotFoundError:
        check_no_url(path, error)
        raise error(f"{path}: there is no such file") from None
    except IsADirectoryError:
        raise error(f"{path} is a folder; expected a file") from None
    except PermissionError:
        raise error(f"{path}: no permission to read this file") from None
    except (OSError, ValueError) as problem:  # ValueError: a null character in the path
        raise error(f"{_printable(path)} cannot be read: {_reason(problem)}") from None
    if len(data) > MAX_BYTES:
        raise error(f"{path} is larger than {MAX_BYTES // 2**20} MiB; expected {expected}")
    if not data.strip():
        raise error(f"{path} is empty; expected {expected}")
    if instead := stand_in(data):
        raise error(f"{path} {instead}")
    text = decode(data, str(path), error)
    if not text.strip():
        raise error(f"{path} is empty; expected {expected}")
    return text


def decode(data: bytes, source: str, error: type[MrtaError]) -> str:
    """Text in UTF-8 with or without byte order mark, line ends as ``\\n``.

    Args:
        data: the bytes.
        source: where they are from, for messages.
        error: what to raise.

    Raises:
        error: if they are not such text.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as problem:
        if data.startswith((b"\xff\xfe", b"\xfe\xff")):
            raise error(f"{source} looks like UTF-16; expected UTF-8 text") from None
        line = data.count(b"\n", 0, problem.start) + 1
        raise error(
            f"{source}, line {line}: byte 0x{data[problem.start]:02x} is not UTF-8; expected UTF-8 text"
        ) from None
    if "\0" in text:
        start = data[:64]
        if not any(start[::2]) or not any(start[1::2]):  # without byte order mark
            raise error(f"{source} looks like UTF-16; expected UTF-8 text")
        line = text.count("\n", 0, text.index("\0")) + 1
        raise error(f"{source}, line {line}: holds the byte 0x00, as binary files do; expected text")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def write_text(text: str, path: StrPath, error: type[MrtaError]) -> None:
    """Write the whole file or, on any failure, leave what was there untouched.

    Raises:
        error: if the file cannot be written.
    """
    check_no_url(path, error)
    try:
        with replacing(path) as partial:
            partial.write_text(text, encoding="utf-8", newline="")
    except (OSError, ValueError) as problem:
        raise error(f"{_printable(path)} cannot be written: {_reason(problem)}") from None


def number(text: str, where: str, what: str, least: float, error: type[MrtaError], strict: bool = False) -> float:
    """The number written as `text`, which must be finite and >= `least` (> if `strict`); `least` may be -infinity.

    Raises:
        error: if it is not; the message starts with `where` and calls the value `what`.
    """
    value = float(text) if _NUMBER.fullmatch(text) else math.nan
    if not math.isfinite(value) or value < least or (strict and value == least):
        bound = "" if least == -math.inf else f" {'>' if strict else '>='} {least:g}"
        raise error(f"{where}: {what} is {shown(text)}; expected a finite number{bound}")
    return value + 0.0


def count(text: str, where: str, what: str, error: type[MrtaError]) -> int:
    """The whole number >= 0 written as `text`, in decimal digits.

    Raises:
        error: if it is not one, or has more than 18 digits.
    """
    if not _COUNT.fullmatch(text) or len(text) > 18:
        raise error(f"{where}: {what} is {shown(text)}; expected a whole number >= 0")
    return int(text)


def check_name(name: str, where: str, what: str, error: type[MrtaError]) -> None:
    """Refuse a name that cannot be written to a file, or would control the terminal it is printed on.

    Raises:
        error: if the name is not UTF-8, as a file name may not be, or holds control characters.
    """
    if not is_utf8(name):
        raise error(f"{where}: {what} is {shown(name)}; expected text in UTF-8")
    if _CONTROL.search(name):
        raise error(f"{where}: {what} is {shown(name)}; expected text without control characters")


def shown(value: object, most: int = 40) -> str:
    """How messages show a value: quoted, on one line, and not too long."""
    if isinstance(value, dict):
        return "an object"
    if isinstance(value, list):
        return f"a list of {len(value)}"
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    if not isinstance(value, str):
        return repr(value)
    return repr(value) if len(value) <= most else f"{value[:most]!r}..."


def _printable(path: StrPath) -> str:
    return os.fspath(path).replace("\0", "\\0")


def _reason(problem: Exception) -> str:
    return (getattr(problem, "strerror", None) or str(problem)).lower()
