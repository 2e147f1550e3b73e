"""What the flags of all commands have in common."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import is_dataclass
from typing import Any, TypeVar, get_args, get_type_hints

import tyro

from mrta_zoo.cli.given_flags import check_flags
from mrta_zoo.cli.help_text import description_of, readable_help, unfold_fields
from mrta_zoo.errors import ConfigError, MrtaError
from mrta_zoo.wording import composed

Parsed = TypeVar("Parsed")

METHOD_FLAGS = ("--method", "--methods", "--policy", "--policies")
"""How users may spell the flag that says what plans or decides, whichever of them a command calls it."""


def parse(of: Callable[..., Parsed], argv: Sequence[str], name: str, **options: Any) -> Parsed:
    """What a command of mrta-zoo makes of its flags; as `parse_flags`."""
    return parse_flags(of, argv, f"mrta-zoo {name}", **options)


def parse_flags(of: Callable[..., Parsed], argv: Sequence[str], program: str, **options: Any) -> Parsed:
    """What a dataclass or a function makes of flags. Exits with a message for help, and for values of another kind.

    Args:
        of: its parameters are the flags.
        argv: the arguments.
        program: what help calls it.
        options: of `tyro.cli`.

    Raises:
        ConfigError: if a flag is not known, given twice, or empty.
    """
    known, positional = _flags_of(of)
    own = next((flag for flag in METHOD_FLAGS if flag in known), None)
    arguments = list(argv) if own is None else [_spelt(argument, own) for argument in argv]
    check_flags(arguments, known, positional)
    unfold_fields(of)
    config = (tyro.conf.OmitArgPrefixes,)
    with readable_help():
        parsed: Parsed = tyro.cli(
            of, args=arguments, prog=program, description=description_of(of), config=config, **options
        )
    return parsed


def run(of: Callable[..., Parsed], module: str) -> Parsed:
    """What it makes of the flags of ``python -m MODULE``, which ends with a sentence and code 2 after an error."""
    try:
        return parse_flags(of, sys.argv[1:], f"python -m {module}")
    except MrtaError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)


def _flags_of(of: Callable[..., object]) -> tuple[dict[str, str], list[str]]:
    """Flags by how they may be spelt, and the names of what stands without one."""
    known: dict[str, str] = {}
    positional: list[str] = []
    for name, hint in get_type_hints(of, include_extras=True).items():
        kind, *details = get_args(hint) if hasattr(hint, "__metadata__") else (hint,)
        flag = f"--{name.replace('_', '-')}"
        if is_dataclass(kind):
            known |= _flags_of(kind)[0]  # type: ignore[arg-type]  # it is a class
        elif tyro.conf.Positional in details:
            positional += [each.metavar for each in details if getattr(each, "metavar", None)] or [name.upper()]
        elif name != "return":
            known |= {flag: flag} | ({f"--no-{flag[2:]}": flag} if kind is bool else {})
    return known, positional


def _spelt(argument: str, own: str) -> str:
    """The argument, with any of `METHOD_FLAGS` spelt as the command spells it."""
    flag, equals, value = argument.partition("=")
    return f"{own}{equals}{value}" if flag in METHOD_FLAGS else argument


def optional(metavar: str, help: str | None = None) -> Any:
    """A flag whose default is to be absent; the text says what happens then, and "(default: None)" would not."""
    return tyro.conf.arg(metavar=metavar, help=help, help_behavior_hint="")


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
