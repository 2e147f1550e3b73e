"""Wording: counts of things, lists of names, and the spelling of names."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable


def counted(count: int, singular: str, plural: str = "", form: str = "") -> str:
    """1 case, 2 cases.

    Args:
        count: how many, >= 0.
        singular: what they are.
        plural: its plural, if that is not the singular with an s.
        form: format of the number, as after the colon in a format string.
    """
    return f"{count:{form}} {singular if count == 1 else plural or singular + 's'}"


def listed(names: Iterable[str]) -> str:
    """a, b, "c, d": a list of names, in quotes where one might look like several or run into its neighbours.

    Quotes within quotes are doubled, as in CSV.
    """
    return ", ".join(map(_quoted, names))


def composed(text: str) -> str:
    """Text in the form in which names are compared (NFC): some systems write accented letters as two characters."""
    return unicodedata.normalize("NFC", text)


def is_utf8(text: str) -> bool:
    """Whether a text can be written as UTF-8, which is not so for every file name."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _quoted(name: str) -> str:
    plain = name == name.strip() and "," not in name and not name.startswith('"')
    return name if plain else '"' + name.replace('"', '""') + '"'
