"""JSON documents as files, read strictly: one sentence says what is wrong with a file, and where."""

from __future__ import annotations

import json
import math
import re
from bisect import bisect_left
from collections.abc import Sequence
from typing import Any, TypeVar, get_args, get_type_hints

import msgspec

from mrta_zoo.errors import MrtaError
from mrta_zoo.io.text_files import StrPath, check_name, read_text, shown, write_text

Document = TypeVar("Document", bound=msgspec.Struct)


def read_document(path: StrPath, kind: type[Document], error: type[MrtaError]) -> Document:
    """The document that a JSON file holds.

    Args:
        path: the file.
        kind: the form of the document, with fields `format` and `version` of one allowed value each.
        error: what to raise.

    Raises:
        error: if the file is missing or malformed.
    """
    name = _format_of(kind)
    text = read_text(path, error)
    try:
        document = _loads(text)
    except json.JSONDecodeError as problem:
        rest = text[problem.pos :].split("\n")[0]
        raise error(
            f"{path}, line {problem.lineno}, column {problem.colno}: {problem.msg.lower()} "
            f"at {shown(rest) if rest else 'the end of the line'}; expected JSON"
        ) from None
    except ValueError as problem:
        raise error(f"{path}, line {_line_of_failure(text)}: {problem}") from None
    except RecursionError:
        raise error(f"{path} is nested too deeply; expected a {name} file") from None
    if not isinstance(document, dict):
        raise error(f"{path} holds {shown(document)}; expected an object with {', '.join(kind.__struct_fields__)}")
    # Before all else, so that a file of another kind is recognised as such.
    for field, expected in (("format", name), ("version", 1)):
        if field not in document:
            raise error(f"{path} has no field {field!r}; expected {field} {shown(expected)}")
        if type(document[field]) is not type(expected) or document[field] != expected:
            raise error(f"{path}: {field} is {shown(document[field])}; expected {shown(expected)}")
    _check_names(document, path, error)
    try:
        return msgspec.convert(document, type=kind)
    except msgspec.ValidationError as problem:
        raise error(_sentence(path, str(problem), document, kind)) from None
    except UnicodeEncodeError as problem:  # text where a number or another key should be
        raise error(f"{path} holds the text {shown(problem.object)}; expected text without lone surrogates") from None


def _check_names(document: dict[str, Any], path: StrPath, error: type[MrtaError]) -> None:
    """Names are printed and written again, so some characters cannot be allowed."""
    for field in ("name", "scenario", "method", "decode"):
        value = document.get(field)
        if isinstance(value, str):
            check_name(value, str(path), field, error)


def _loads(text: str) -> Any:
    """Parse JSON, without what Python's reader would let pass; raises a ValueError that says what that is."""
    return json.loads(text, parse_float=_float, parse_int=_int, parse_constant=_constant, object_pairs_hook=_object)


def _line_of_failure(text: str) -> int:
    """The line that `_loads` refuses: the first whose end it does not get to, or on which a refused object ends."""
    ends = [index for index, character in enumerate(text) if character == "\n"] + [len(text)]

    def refuses(end: int) -> bool:
        try:
            _loads(text[:end])
        except json.JSONDecodeError:  # the text breaks off here, and all before it is right
            return False
        except ValueError:
            return True
        return False

    return bisect_left(ends, True, key=refuses) + 1


def _int(token: str) -> int | float:
    # No index or seed is longer, and Python refuses to read very long ones.
    return int(token) if len(token) <= 19 else _float(token)


def _float(token: str) -> float:
    value = float(token)
    if not math.isfinite(value):
        raise ValueError(f"{shown(token)} is too large; expected a finite number")
    return value


def _constant(token: str) -> float:
    raise ValueError(f"{token} is not a JSON number; expected a finite number")


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"field {shown(twice)} appears twice in an object; expected it once")
    return members


_PLAIN = {"float": "a number", "int": "a whole number", "str": "text", "bool": "true or false", "array": "a list"}
_PLAIN |= {"object": "an object", " | ": " or ", ".0": "", "`": ""}


def _sentence(path: StrPath, problem: str, document: Any, kind: type[msgspec.Struct]) -> str:
    """msgspec's complaint about a document as a sentence that also shows the value."""
    complaint, _, place = problem.partition(" - at `$")
    place = place.strip(".`")
    steps = re.findall(r"\w+", place)
    value = document
    for step in steps:
        value = value[int(step) if isinstance(value, list) else step]
    where = f"{path}: {place}" if place else str(path)
    if complaint.startswith("Object"):  # contains unknown field `…`, or missing required field `…`
        number, only = ("an unknown", "only ") if "unknown" in complaint else ("no", "")
        field, fields = complaint.partition("`")[2][:-1], ", ".join(_schema_at(kind, steps)["properties"])
        return f"{where} has {number} field {shown(field)}; expected {only}{fields}"
    if complaint.startswith("Invalid enum value"):
        return f"{where} is {shown(value)}; expected one of {', '.join(_schema_at(kind, steps)['enum'])}"
    if not complaint.startswith("Expected"):
        return f"{where} is {shown(value)}; {complaint}"
    expected = complaint.removeprefix("Expected ").partition(", got")[0]
    for word, plain in _PLAIN.items():
        expected = expected.replace(word, plain)
    return f"{where} is {shown(value)}; expected {expected}"


def _schema_at(kind: type[msgspec.Struct], steps: Sequence[str]) -> dict[str, Any]:
    """The JSON Schema of the value at a place in a document."""
    (schema,), parts = msgspec.json.schema_components([kind])

    def resolved(schema: dict[str, Any]) -> dict[str, Any]:
        first = schema.get("anyOf", [schema])[0]  # the other one is null
        found: dict[str, Any] = parts[first["$ref"].rpartition("/")[2]] if "$ref" in first else first
        return found

    schema = resolved(schema)
    for step in steps:
        schema = resolved(schema["items"] if step.isdigit() else schema["properties"][step])
    return schema


def _format_of(kind: type[msgspec.Struct]) -> str:
    """The value that `format` must have."""
    name: str = get_args(get_type_hints(kind)["format"])[0]
    return name


def schema_text(document: type[msgspec.Struct]) -> str:
    """The JSON Schema of a kind of file, as stored beside this module."""
    schema = {"$schema": "https://json-schema.org/draft/2020-12/schema", **msgspec.json.schema(document)}
    return json.dumps(schema, indent=2) + "\n"


def write_document(document: dict[str, Any], path: StrPath, error: type[MrtaError]) -> None:
    """Write JSON that people can read, too: each element of a top-level list is on its own line.

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
