"""Names of tasks and robots: which are valid, and how they are normalised."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

from mrta_zoo.errors import ScenarioError
from mrta_zoo.wording import composed, counted

# Control characters, and those that reverse the direction of the text after them, in browsers, too.
_UNPRINTABLE = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")


def usable_name(name: object) -> str:
    """The name of a task or robot as text without blanks around it, accents composed; "" if it cannot be one."""
    if not isinstance(name, (str, int, np.integer)) or isinstance(name, bool):
        return ""
    text = composed(str(name).strip())
    return "" if _UNPRINTABLE.search(text) else text


def as_names(names: Iterable[object], who: str, count: int) -> tuple[str, ...]:
    """Names of `count` tasks or robots as text, made from text or whole numbers; none if they are just 0, 1, 2, ….

    Raises:
        ScenarioError: if there are more or fewer, or one is not text, is empty, appears twice or holds control
            characters.
    """
    expected = f"a different text for each of the {count} {who}s, or nothing"
    if isinstance(names, (str, bytes)) or not isinstance(names, Iterable):
        raise ScenarioError(f"{who}_names is {names!r}; expected {expected}")
    given = tuple(names)
    if not given:
        return ()
    if len(given) != count:
        raise ScenarioError(f"{who}_names has {counted(len(given), 'name')}; expected {expected}")
    seen: dict[str, int] = {}
    for index, name in enumerate(given):
        text = usable_name(name)
        if not text:
            raise ScenarioError(f"{who} {index} has the name {name!r}; expected text without control characters")
        if text in seen:
            raise ScenarioError(f"{who} {index} has the name {text!r}, as {who} {seen[text]}; expected {expected}")
        seen[text] = index
    return () if all(name == str(index) for name, index in seen.items()) else tuple(seen)
