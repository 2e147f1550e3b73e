"""JSON documents as files, read strictly: whatever is wrong with one, a sentence says where and what."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping
from typing import Any, TypeVar, get_args, get_type_hints

import msgspec

from mrta_zoo.errors import MrtaError
from mrta_zoo.io.source import StrPath, check_name, read_text, shown, write_text

Document = TypeVar("Document", bound=msgspec.Struct)
Parts = Mapping[str, type[msgspec.Struct]]


class _TokenError(Exception):
    """Something in the text that JSON or Python's reader of it would let pass."""

    def __init__(self, token: str, complaint: str) -> None:
        self.token, self.complaint = token, complaint


def read_document(path: StrPath, kind: type[Document], parts: Parts, error: type[MrtaError]) -> Document:
    """The document that a JSON file holds.

    Args:
        path: the file.
        kind: the form of the whole, with fields `format` and `version` of one allowed value each.
        parts: the form of its parts, by the top-level field they stand in.
        error: what to raise.

    Raises:
        error: if the file is missing or malformed.
    """
    name = _format_of(kind)
    text = read_text(path, error)
    try:
        document = json.loads(
            text, parse_float=_float, parse_int=_int, parse_constant=_constant, object_pairs_hook=_object
        )
    except json.JSONDecodeError as problem:
        rest = text[problem.pos :].split("\n")[0]
        raise error(
            f"{path}, line {problem.lineno}, column {problem.colno}: {problem.msg.lower()} "
            f"at {shown(rest) if rest else 'the end of the line'}; expected JSON"
        ) from None
    except _TokenError as problem:
        raise error(f"{path}, line {_line_of(problem.token, text)}: {problem.complaint}") from None
    except RecursionError:
        raise error(f"{path} is nested too deeply; expected a {name} file") from None
    if not isinstance(document, dict):
        raise error(f"{path} holds {shown(document)}; expected an object with {_fields(kind)}")
    # Before all else, so that the wrong kind of file is called that.
    for field, expected in (("format", name), ("version", 1)):
        if field not in document:
            raise error(f"{path} has no field {field!r}; expected {field} {shown(expected)}")
        if type(document[field]) is not type(expected) or document[field] != expected:
            raise error(f"{path}: {field} is {shown(document[field])}; expected {shown(expected)}")
    _check_names(document, path, error)
    try:
        return msgspec.convert(document, type=kind)
    except msgspec.ValidationError as problem:
        raise error(_sentence(path, str(problem), document, kind, parts)) from None
    except UnicodeEncodeError as problem:  # of text where a number or another key should be
        raise error(f"{path} holds the text {shown(problem.object)}; expected text without lone surrogates") from None


def _check_names(document: dict[str, Any], path: StrPath, error: type[MrtaError]) -> None:
    """Names are printed and written again, which some characters would upset."""
    for field in ("name", "scenario", "method", "decode"):
        value = document.get(field)
        if isinstance(value, str):
            check_name(value, str(path), field, error)


def _int(token: str) -> int | float:
    # No index or seed is longer, and Python refuses to read very long ones.
    return int(token) if len(token) <= 19 else _float(token)


def _float(token: str) -> float:
    value = float(token)
    if not math.isfinite(value):
        raise _TokenError(token, f"{shown(token)} is too large; expected a finite number")
    return value


def _constant(token: str) -> float:
    raise _TokenError(token, f"{token} is no JSON number; expected a finite number")


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise _TokenError(twice, f"field {shown(twice)} appears twice in an object; expected it once")
    return members


def _line_of(token: str, text: str) -> int:
    """Line where a number, literal or field name first occurs as a whole token."""
    for match in re.finditer(r'"((?:[^"\\]|\\.)*)"|[^\s,:\[\]{}"]+', text):
        if token in (match[0], match[1]):
            return text.count("\n", 0, match.start()) + 1
    return 1


_PLACE = re.compile(r" - at `\$\.?([^`]*)`$")
_EXPECTED = re.compile(r"Expected `([^`]*)`((?: of length)? [<>]=? [0-9.]+)?")
_PLAIN = {
    "float": "a number",
    "int": "a whole number",
    "str": "text",
    "bool": "true or false",
    "array": "a list",
    "object": "an object",
}


def _sentence(path: StrPath, message: str, document: Any, kind: type[msgspec.Struct], parts: Parts) -> str:
    """msgspec's complaint about a document as a sentence that also shows the value."""
    found = _PLACE.search(message)
    complaint, place = (message[: found.start()], found[1]) if found else (message, "")
    value = document
    for name, index in re.findall(r"(\w+)(?!\w*\])|\[(\d+)\]", place):
        value = value[int(index)] if index else value[name]
    where = f"{path}: {place}" if place else str(path)
    if field := re.search(r"(unknown|required) field `(.*)`", complaint, re.DOTALL):
        fields = _fields(parts[re.split(r"\W", place)[0]] if place else kind)
        if field[1] == "required":
            return f"{where} has no field {shown(field[2])}; expected {fields}"
        return f"{where} has an unknown field {shown(field[2])}; expected only {fields}"
    if complaint.startswith("Invalid enum value"):
        way = re.split(r"\W+", place)
        allowed = get_type_hints(kind if len(way) == 1 else parts[way[0]])[way[-1]]
        return f"{where} is {shown(value)}; expected one of {', '.join(get_args(allowed))}"
    expected = _EXPECTED.match(complaint)
    if not expected:
        return f"{where} is {shown(value)}; {complaint}"
    names = " or ".join(_PLAIN.get(name, name) for name in expected[1].split(" | "))
    return f"{where} is {shown(value)}; expected {names}{(expected[2] or '').removesuffix('.0')}"


def _format_of(kind: type[msgspec.Struct]) -> str:
    """The value that `format` must have."""
    name: str = get_args(get_type_hints(kind)["format"])[0]
    return name


def _fields(kind: type[msgspec.Struct]) -> str:
    return ", ".join(kind.__struct_fields__)


def write_document(document: dict[str, Any], path: StrPath, error: type[MrtaError]) -> None:
    """Write JSON with one element of each top-level list a line, to be read by people too.

    Raises:
        error: if the file cannot be written, or a value cannot be read back.
    """
    _check_names(document, path, error)
    lines = []
    try:
        for field, value in document.items():
            if isinstance(value, list) and value:
                rows = ",\n".join("    " + json.dumps(row, allow_nan=False) for row in value)
                lines.append(f"  {json.dumps(field)}: [\n{rows}\n  ]")
            else:
                lines.append(f"  {json.dumps(field)}: {json.dumps(value, allow_nan=False)}")
    except ValueError:
        raise error(f"{path} cannot be written: {field} holds a number that is not finite") from None
    write_text("{\n" + ",\n".join(lines) + "\n}\n", path, error)
