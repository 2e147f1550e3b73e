"""Lists of names in sentences."""

from __future__ import annotations

from collections.abc import Iterable


def listed(names: Iterable[str]) -> str:
    """a, b, "c, d": names after each other, in quotes if they would not be told from several, or from their neighbours.

    Quotes within quotes are doubled, as in CSV.
    """
    return ", ".join(map(_quoted, names))


def _quoted(name: str) -> str:
    plain = name == name.strip() and "," not in name and not name.startswith('"')
    return name if plain else '"' + name.replace('"', '""') + '"'
