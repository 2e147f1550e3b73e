"""Names and numbers of tasks and robots, on the screen and in commands.

Both are understood, unless a name is itself a number: then nobody could tell which of the two was meant.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from rich.cells import cell_len, set_cell_size

from mrta_zoo.errors import ConfigError
from mrta_zoo.show.shortened import shortened as shorter
from mrta_zoo.wording import composed, listed

LISTED = 8
"""The most names that a message lists."""
DIGITS = 9
"""The most digits of a number."""


def numbers_count(names: Sequence[str]) -> bool:
    """Whether numbers are understood as well as these names."""
    return not any(name.isdecimal() for name in names)


def label(index: int, names: Sequence[str]) -> str:
    """The name of a task or robot; its number if there are no names."""
    return names[index] if names else str(index)


def cells(index: int, names: Sequence[str]) -> tuple[str, ...]:
    """The cells of a table's row that name a task or robot, under `headings`."""
    return (*((str(index),) if numbers_count(names) else ()), *((names[index],) if names else ()))


def headings(who: str, names: Sequence[str]) -> tuple[str, ...]:
    """The headings over `cells`: of the number, the name or both."""
    return (who, "name") if names and numbers_count(names) else (who,)


def find(text: str, who: str, names: Sequence[str]) -> int | None:
    """The task or robot that a text names; None if it names none. A number may be 2, "robot 2" or "robot_2".

    Args:
        text: what was typed.
        who: "task" or "robot".
        names: the names of all of them; empty if they have none.
    """
    if (name := composed(text)) in names:
        return names.index(name)
    number = re.fullmatch(rf"(?:{who}[ _])?([0-9]{{1,{DIGITS}}})", text)
    return int(number[1]) if number and numbers_count(names) else None


def identify(text: str, who: str, names: Sequence[str]) -> int:
    """The task or robot that a text names, as `find`.

    Raises:
        ConfigError: if it names none.
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
    """A name cut to at most `most` columns of a terminal, where it is like the others or else in the middle."""
    if cell_len(name) <= most:
        return name
    telling = shorter(name, lambda text: cell_len(text) <= most, among) if among else ""
    if telling:
        return telling
    tail = name
    while tail and (cell_len(tail) > (most - 1) // 2 or not cell_len(tail[0])):  # which would be an accent alone
        tail = tail[1:]
    return f"{set_cell_size(name, most - 1 - cell_len(tail)).rstrip()}…{tail.lstrip()}"
