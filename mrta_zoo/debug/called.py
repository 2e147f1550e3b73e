"""What tasks and robots are called where somebody steps through an episode: shown, and typed.

Where they have names, these count. Their numbers count, too, unless one of the names is a number: which of the two was
meant would be a guess then.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from rich.cells import cell_len, set_cell_size

from mrta_zoo.errors import ConfigError
from mrta_zoo.show.shortened import shortened as shorter
from mrta_zoo.wording import composed, listed

LISTED = 8
"""Names that a message lists at most."""
DIGITS = 9
"""Of a number, at most."""


def numbers_count(names: Sequence[str]) -> bool:
    """Whether numbers are understood besides these names."""
    return not any(name.isdecimal() for name in names)


def called(index: int, names: Sequence[str]) -> str:
    """Its name, or its number."""
    return names[index] if names else str(index)


def cells(index: int, names: Sequence[str]) -> tuple[str, ...]:
    """What a row of a table calls a task or robot, under `headings`."""
    return (*((str(index),) if numbers_count(names) else ()), *((names[index],) if names else ()))


def headings(who: str, names: Sequence[str]) -> tuple[str, ...]:
    """The columns of `cells`: the number, the name or both."""
    return (who, "name") if names and numbers_count(names) else (who,)


def find(text: str, who: str, names: Sequence[str]) -> int | None:
    """The task or robot that a text means by its name or its number, be it 2, "robot 2" or "robot_2"; None if neither.

    Args:
        text: what was typed.
        who: "task" or "robot".
        names: of all of them, empty if they have none.
    """
    if (name := composed(text)) in names:
        return names.index(name)
    number = re.fullmatch(rf"(?:{who}[ _])?([0-9]{{1,{DIGITS}}})", text)
    return int(number[1]) if number and numbers_count(names) else None


def found(text: str, who: str, names: Sequence[str]) -> int:
    """The task or robot that a text means.

    Args:
        text: what was typed.
        who: "task" or "robot", for the message.
        names: of all of them, empty if they have none.

    Raises:
        ConfigError: if it is neither a name nor a whole number that counts.
    """
    index = find(text, who, names)
    if index is not None:
        return index
    if not names:
        raise ConfigError(f"{who} is {text!r}; expected a whole number >= 0")
    number = ", or a number" if numbers_count(names) else ""
    known = listed(names[:LISTED]) + (", …" if len(names) > LISTED else "")
    raise ConfigError(f"there is no {who} {text!r}; expected a name{number}; the {who}s are {known}")


def shortened(name: str, most: int, among: Sequence[str] = ()) -> str:
    """A name in so many columns of a terminal, cut where it is like the others or else in the middle."""
    if cell_len(name) <= most:
        return name
    telling = shorter(name, lambda text: cell_len(text) <= most, among) if among else ""
    if telling:
        return telling
    tail = name
    while tail and (cell_len(tail) > (most - 1) // 2 or not cell_len(tail[0])):  # which would be an accent alone
        tail = tail[1:]
    return f"{set_cell_size(name, most - 1 - cell_len(tail)).rstrip()}…{tail.lstrip()}"


def without_comment(line: str, names: Sequence[str]) -> str:
    """A line of a script up to a ``#`` that is no part of a name."""
    hidden = line
    for name in sorted((name for name in names if "#" in name), key=len, reverse=True):
        hidden = hidden.replace(name, "\0" * len(name))
    return line[: hidden.index("#")] if "#" in hidden else line
