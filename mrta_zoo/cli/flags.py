"""How commands take flags: the fields of a dataclass, whose docstrings are the help."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import is_dataclass
from functools import wraps
from typing import Any, TypeVar, get_args, get_type_hints

import tyro

from mrta_zoo.cli.given_flags import check_flags
from mrta_zoo.cli.help_text import description_of, readable_help, unfold_fields
from mrta_zoo.errors import ConfigError
from mrta_zoo.wording import composed

Flags = TypeVar("Flags")

METHOD_FLAGS = ("--method", "--methods", "--policy", "--policies")
"""Spellings of the flag that names methods. Every command takes all of them, whichever one its help shows."""


def takes_flags(run: Callable[[Flags], None]) -> Callable[[Sequence[str]], None]:
    """Make ``NAME_command(command: Flags)`` take the arguments of ``mrta-zoo NAME`` instead of a dataclass of flags."""
    name = run.__name__.removesuffix("_command")

    @wraps(run)
    def of_arguments(argv: Sequence[str]) -> None:
        run(parse(get_type_hints(run)["command"], argv, name))

    return of_arguments


def parse(of: type[Flags], argv: Sequence[str], name: str, **options: Any) -> Flags:
    """The flags of a command. Exits after printing help, or if a value has the wrong type.

    Args:
        of: a dataclass with a field for each flag.
        argv: the arguments that follow the command's name.
        name: of the command.
        options: of `tyro.cli`.

    Raises:
        ConfigError: if a flag is unknown, given twice or empty.
    """
    known, positional = _flags_of(of)
    own = next((flag for flag in METHOD_FLAGS if flag in known), None)
    arguments = list(argv) if own is None else [_spelt(argument, own) for argument in argv]
    check_flags(arguments, known, positional)
    unfold_fields(of)
    config = (tyro.conf.OmitArgPrefixes,)
    with readable_help():
        flags: Flags = tyro.cli(
            of, args=arguments, prog=f"mrta-zoo {name}", description=description_of(of), config=config, **options
        )
    return flags


def _flags_of(of: Any) -> tuple[dict[str, str], list[str]]:
    """The flags by each of their spellings, and the names of the arguments that have no flag."""
    known: dict[str, str] = {}
    positional: list[str] = []
    for name, hint in get_type_hints(of, include_extras=True).items():
        kind, *details = get_args(hint) if hasattr(hint, "__metadata__") else (hint,)
        flag = f"--{name.replace('_', '-')}"
        if is_dataclass(kind):
            known |= _flags_of(kind)[0]
        elif tyro.conf.Positional in details:
            positional += [each.metavar for each in details if getattr(each, "metavar", None)] or [name.upper()]
        else:
            known |= {flag: flag} | ({f"--no-{flag[2:]}": flag} if kind is bool else {})
    return known, positional


def _spelt(argument: str, own: str) -> str:
    """The argument, with any of `METHOD_FLAGS` spelt as the command spells it."""
    flag, equals, value = argument.partition("=")
    return f"{own}{equals}{value}" if flag in METHOD_FLAGS else argument


def optional(metavar: str, help: str | None = None) -> Any:
    """A flag that need not be given. Its help text says what happens then, so that "(default: None)" is left out."""
    return tyro.conf.arg(metavar=metavar, help=help, help_behavior_hint="")


def names(text: str, flag: str = "methods", what: str = "names", example: str = "capam,nearest") -> list[str]:
    """The entries of a list that is separated by commas.

    Args:
        text: the flag's value.
        flag: its name, which is also the plural of what one entry is called.
        what: the entries are, for the message.
        example: a valid value, for the message.

    Raises:
        ConfigError: if there is no entry, or the same one twice.
    """
    found = [name.strip() for name in text.split(",") if name.strip()]
    if not found:
        raise ConfigError(f"{flag} is {text!r}; expected {what} separated by commas, such as {example}")
    spelt = [composed(name) for name in found]
    for name in found:
        if spelt.count(composed(name)) > 1:
            raise ConfigError(f"{flag.removesuffix('s')} {name} is named twice; expected each once")
    return found
