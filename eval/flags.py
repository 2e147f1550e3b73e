"""What the flags of all commands have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

import tyro

CommandClass = TypeVar("CommandClass")


def parse(of: type[CommandClass], argv: Sequence[str], name: str) -> CommandClass:
    """The command with its flags. Exits with a message and code 2 if they cannot be understood."""
    return tyro.cli(of, args=list(argv), prog=f"mrta-zoo {name}", config=(tyro.conf.OmitArgPrefixes,))


def optional(metavar: str) -> Any:
    """A flag whose default is to be absent; the text says what happens then, and "(default: None)" would not."""
    return tyro.conf.arg(metavar=metavar, help_behavior_hint="")
