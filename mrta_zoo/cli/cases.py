"""Which cases a command runs on."""

from __future__ import annotations

import os
from dataclasses import replace

from mrta_zoo.cli.flags import names
from mrta_zoo.errors import ScenarioError
from mrta_zoo.io import Case, read_cases
from mrta_zoo.show.terminal.console import warn
from mrta_zoo.suite import SUITES
from mrta_zoo.wording import composed

ALIASES = {"builtin": "suite-100"}


def read_one(source: str) -> list[Case]:
    """The cases of a folder, or of a built-in suite.

    Raises:
        ScenarioError: if the folder cannot be read.
    """
    suite = suite_named(source)
    return read_cases(source, warn) if suite is None else [Case(each.name, each) for each in SUITES[suite]()]


def read_all(cases: str) -> list[Case]:
    """The cases of one or more folders and built-in suites.

    Raises:
        ConfigError: if there is one twice, or none.
        ScenarioError: if a folder cannot be read, or two hold cases of the same name.
    """
    found: dict[str, Case] = {}
    for source in names(_canonical(cases), "cases", "folders", "taptc/n100,taptc/n200"):
        for case in read_one(source):
            name = case.name
            if name in found:  # as in folders that were generated
                name = f"{_own_name(source)}/{name}"
            if name in found:
                raise ScenarioError(
                    f"{source} holds a case called {name!r}, as another folder does; expected different names"
                )
            found[name] = replace(case, name=name)
    return list(found.values())


def shown_cases(cases: str) -> str:
    """The folders' own names: where they lie is nobody's business, and the digest says what is in them."""
    return ",".join(_own_name(each) for each in names(_canonical(cases)))


def suite_named(source: str) -> str | None:
    """The built-in suite that a flag means; None if it means a folder."""
    name = ALIASES.get(source, source)
    return name if name in SUITES else None


def _canonical(cases: str) -> str:
    return ",".join(suite_named(each.strip()) or each for each in cases.split(","))


def _own_name(source: str) -> str:
    return composed(os.path.basename(os.path.abspath(source)))
