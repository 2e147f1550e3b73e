"""What the flags of all commands have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

import tyro

from mrta_zoo.errors import ConfigError

CommandClass = TypeVar("CommandClass")


def parse(of: type[CommandClass], argv: Sequence[str], name: str) -> CommandClass:
    """The command with its flags. Exits with a message and code 2 if they cannot be understood."""
    return tyro.cli(of, args=list(argv), prog=f"mrta-zoo {name}", config=(tyro.conf.OmitArgPrefixes,))


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
    for name in found:
        if found.count(name) > 1:
            raise ConfigError(f"{flag.removesuffix('s')} {name} is named twice; expected each once")
    return found
