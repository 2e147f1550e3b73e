"""Flags as they were given: refuses what tyro lets pass in silence, or complains about without a hint."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from difflib import SequenceMatcher

from mrta_zoo.errors import ConfigError

MOST_NAMED = 16
"""The most flags that a message names. Those most like the given one come first."""
_FLAG = re.compile(r"--[^=]+|-[a-zA-Z](?==|$)")  # what begins with one minus may be a negative number, or -inf


def check_flags(arguments: Sequence[str], known: Mapping[str, str], positional: Sequence[str] = ()) -> None:
    """Make sure that flags are known, given once and not empty, unless help is asked for.

    Args:
        arguments: of the command. What follows ``--`` is not checked.
        known: the flags by each of their spellings; ``--no-x`` is a spelling of ``--x``.
        positional: names of the arguments that have no flag.

    Raises:
        ConfigError: if a flag is unknown, given twice or empty.
    """
    if {"-h", "--help"} & set(arguments):
        return
    seen: set[str] = set()
    flag = ""
    for argument in arguments:
        if argument == "--":
            return
        if match := _FLAG.match(argument):
            given = match[0].replace("_", "-")
            if given not in known:
                bare = f", or {' and '.join(positional)} without a flag" if positional else ""
                raise ConfigError(f"there is no flag {match[0]}; expected {_likeliest(given, known)}{bare}")
            flag = known[given]
            if flag in seen:
                raise ConfigError(f"{flag} is given twice; expected it once")
            seen.add(flag)
        value = argument[match.end() :].removeprefix("=") if match and "=" in argument else argument
        if value in ("", "None"):  # tyro would take both for no flag at all
            raise ConfigError(f"{flag or 'an argument'} is {value or 'empty'}; expected a value")
        if not match:
            flag = ""  # it has its value


def _likeliest(given: str, known: Mapping[str, str]) -> str:
    flags = sorted(set(known.values()), key=lambda flag: -SequenceMatcher(None, given, flag).ratio())
    if len(flags) == 1:
        return flags[0]
    return f"one of {', '.join(flags[:MOST_NAMED])}{', …' * (len(flags) > MOST_NAMED)}"
