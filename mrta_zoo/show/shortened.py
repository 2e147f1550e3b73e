"""Shortened names, which keep what tells them from the others that are shown with them."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import pairwise
from unicodedata import combining

SHORTEST = 5
"""The fewest characters, with the ellipsis, that a name keeps if nothing in it tells it from the others."""
NUMBER = re.compile(r"\d+(?:[.,:]\d+)*")
WORD = re.compile(r"\d+(?:[.,:]\d+)*|[^\W\d]+")


def shortened(name: str, fits: Callable[[str], bool], among: Sequence[str] = ()) -> str:
    """The name if it fits; else what tells it from the others, after as much of its beginning as fits; else "".

    If that is the whole name, or too long, its two ends are kept. A number alone is never cut.

    Args:
        name: the name.
        fits: whether there is room for a text; if so, there is for shorter ones.
        among: all names that are shown together.
    """
    if fits(name) or name.isdecimal():
        return name if fits(name) else ""
    parts = [part for part in telling(tuple(among)).get(name, ()) if part != (0, len(name))]
    for low, high in parts:
        head, part, tail = name[:low], name[low:high], name[high:]

        def form(kept: int, head: str = head, part: str = part, tail: str = tail) -> str:
            return _begun(head, kept) + part + _ended(tail, kept - len(head))

        kept = bisect_left(range(len(name)), True, key=lambda kept: not fits(form(kept))) - 1
        if kept >= 0:
            return form(kept)
    if parts and parts[-1][1] - parts[-1][0] < SHORTEST:  # without it, one name would be as good as another
        return ""
    too_many = bisect_left(range(len(name)), True, SHORTEST - 1, key=lambda kept: not fits(_ends(name, kept)))
    return _ends(name, too_many - 1) if too_many >= SHORTEST else ""


@lru_cache(maxsize=16)
def telling(names: tuple[str, ...]) -> dict[str, tuple[tuple[int, int], ...]]:
    """The shortest part of each name that no other has in its place: in whole words, and in whole numbers."""
    before, after = _alike(names), _alike(tuple(name[::-1] for name in names))
    found: dict[str, tuple[tuple[int, int], ...]] = {}
    for name in before:
        # The first letter that the next name in order lacks, and the last that the next one in order of ends lacks.
        first, last = before[name], len(name) - 1 - after[name[::-1]]
        part = max(0, min(first, last)), min(len(name), max(first, last) + 1)
        found[name] = (_whole(name, *part, WORD), _whole(name, *part, NUMBER))
    return found


def _alike(names: tuple[str, ...]) -> dict[str, int]:
    """The most letters that the beginning of each name has in common with that of another."""
    ordered = sorted(set(names))
    common = [0, *(next((place for place, (a, b) in enumerate(zip(*pair, strict=False)) if a != b), len(pair[0]))
                   for pair in pairwise(ordered)), 0]  # fmt: skip
    return {name: max(common[index], common[index + 1]) for index, name in enumerate(ordered)}


def _whole(name: str, low: int, high: int, unit: re.Pattern[str]) -> tuple[int, int]:
    """A part of a name, extended to whole words or numbers, without blanks around it."""
    low, high = high - len(name[low:high].lstrip()), low + len(name[low:high].rstrip())
    spans = [match.span() for match in unit.finditer(name)]
    begins = (start for start, stop in spans if start <= low < stop)
    ends = (stop for start, stop in spans if start < high <= stop)
    return next(begins, low), next(ends, high)


def _begun(head: str, kept: int) -> str:
    return head if kept >= len(head) else f"{head[:kept].rstrip()}…"


def _ended(tail: str, kept: int) -> str:
    return tail if not tail or kept >= len(tail) else f"…{_without_accents(tail[len(tail) - max(kept, 0) :]).lstrip()}"


def _ends(name: str, kept: int) -> str:
    return f"{name[: (kept + 1) // 2].rstrip()}…{_without_accents(name[len(name) - kept // 2 :]).lstrip()}"


def _without_accents(text: str) -> str:
    """Text without leading accents, which belong to a letter before it."""
    while text and combining(text[0]):
        text = text[1:]
    return text
