"""Dataclasses as JSON files: the settings of a policy, and of a training run."""

from __future__ import annotations

import json
import os
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

import msgspec

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.atomic import replacing
from mrta_zoo.io.text_files import read_text

T = TypeVar("T")


def write_json(path: Path, value: Any) -> None:
    """Write a dataclass as indented JSON, through `replacing`."""
    with replacing(path) as partial:
        partial.write_text(json.dumps(msgspec.to_builtins(value), indent=2) + "\n", encoding="utf-8")


def read_json(path: Path, of: type[T]) -> T:
    """Read a dataclass back from JSON, strictly: unknown fields are errors, too.

    Raises:
        ConfigError: if the file is missing or malformed.
    """
    if not os.path.lexists(path):
        raise ConfigError(f"{path}: no such file; expected the JSON that belongs to the weights")
    try:
        value = msgspec.json.decode(read_text(path, ConfigError, "the JSON of a policy or a training run"))
        if isinstance(value, dict):
            _refuse_unknown(value, of, path)
        return msgspec.convert(value, of)
    except (msgspec.MsgspecError, RecursionError) as error:
        raise ConfigError(f"{path}: {error}") from None


def _refuse_unknown(value: dict[str, Any], of: type, path: Path) -> None:
    """msgspec ignores what a dataclass has no field for; a misspelt field must not pass silently."""
    hints = get_type_hints(of)
    known = {each.name for each in fields(of)}
    for name, inner in value.items():
        if name not in known:
            raise ConfigError(f"{path}: unknown field {name!r}; expected some of {', '.join(sorted(known))}")
        if is_dataclass(hints[name]) and isinstance(inner, dict):
            _refuse_unknown(inner, hints[name], path)
