"""What the flags of all commands have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

import tyro

from mrta_zoo.errors import ConfigError
from mrta_zoo.wording import composed

CommandClass = TypeVar("CommandClass")


METHOD_FLAGS = ("--method", "--methods", "--policy")
"""How users may spell the flag that says what plans or decides, whichever of them a command calls it."""


def parse(of: type[CommandClass], argv: Sequence[str], name: str) -> CommandClass:
    """The command with its flags. Exits with a message and code 2 if they cannot be understood."""
    known = {f"--{field}" for field in of.__annotations__}
    own = next((flag for flag in METHOD_FLAGS if flag in known), None)
    args = list(argv) if own is None else [_spelt(argument, own) for argument in argv]
    return tyro.cli(of, args=args, prog=f"mrta-zoo {name}", config=(tyro.conf.OmitArgPrefixes,))


def _spelt(argument: str, own: str) -> str:
    """The argument, with any of `METHOD_FLAGS` spelt as the command spells it."""
    flag, equals, value = argument.partition("=")
    return f"{own}{equals}{value}" if flag in METHOD_FLAGS else argument


def optional(metavar: str) -> Any:
    """A flag whose default is to be absent; the text says what happens then, and "(default: None)" would not."""
    return tyro.conf.arg(metavar=metavar, help_behavior_hint="")


def names(text: str, flag: str = "methods", what: str = "names", example: str = "capam,nearest") -> list[str]:
    """What a flag lists, separated by commas.

    Args:
        text: as it was given.
        flag: its name, and what one of its entries is called, with an s.
        what: it lists, for the message.
        example: of a right value.

    Raises:
        ConfigError: if it lists nothing, or something twice.
    """
    found = [name.strip() for name in text.split(",") if name.strip()]
    if not found:
        raise ConfigError(f"{flag} is {text!r}; expected {what} separated by commas, such as {example}")
    spelt = [composed(name) for name in found]
    for name in found:
        if spelt.count(composed(name)) > 1:
            raise ConfigError(f"{flag.removesuffix('s')} {name} is named twice; expected each once")
    return found
