"""Text for people: numbers of things, lists of names, and how names are spelt."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable


def counted(count: int, singular: str, plural: str = "", form: str = "") -> str:
    """1 case, 2 cases.

    Args:
        count: how many, >= 0.
        singular: what they are.
        plural: that of more or less than one, if it is not just an s longer.
        form: of the number, as after the colon in a format string.
    """
    return f"{count:{form}} {singular if count == 1 else plural or singular + 's'}"


def listed(names: Iterable[str]) -> str:
    """a, b, "c, d": names after each other, in quotes if they would not be told from several, or from their neighbours.

    Quotes within quotes are doubled, as in CSV.
    """
    return ", ".join(map(_quoted, names))


def composed(text: str) -> str:
    """Text with accents in one character each (NFC), as names are compared: some systems write files' names in two."""
    return unicodedata.normalize("NFC", text)


def is_utf8(text: str) -> bool:
    """Whether it can be written as UTF-8, which the name of a file need not be."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _quoted(name: str) -> str:
    plain = name == name.strip() and "," not in name and not name.startswith('"')
    return name if plain else '"' + name.replace('"', '""') + '"'
