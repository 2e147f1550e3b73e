"""Which cases an experiment runs on."""

from __future__ import annotations

import os
from dataclasses import replace

from mrta_zoo.cli.flags import names
from mrta_zoo.errors import ScenarioError
from mrta_zoo.io import Case, read_cases
from mrta_zoo.show.terminal.console import warn
from mrta_zoo.suite import builtin_suite, double_suite
from mrta_zoo.wording import composed

BUILTIN = "builtin"


def read_all(cases: str) -> list[Case]:
    """The cases of one or more folders, or the built-in ones.

    Raises:
        ConfigError: if there is a folder twice, or none.
        ScenarioError: if a folder cannot be read, or two hold cases of the same name.
    """
    if cases == BUILTIN:
        return [Case(scenario.name, scenario) for scenario in (*builtin_suite(), *double_suite())]
    found: dict[str, Case] = {}
    for folder in names(cases, "folders", "folders", "taptc/n100,taptc/n200"):
        for case in read_cases(folder, warn):
            name = case.name
            if name in found:  # as in folders that were generated
                name = f"{_own_name(folder)}/{name}"
            if name in found:
                raise ScenarioError(
                    f"{folder} holds a case called {name!r}, as another folder does; expected different names"
                )
            found[name] = replace(case, name=name)
    return list(found.values())


def shown_cases(cases: str) -> str:
    """The folders' own names: where they lie is nobody's business, and the digest says what is in them."""
    return ",".join(_own_name(each) for each in names(cases))


def _own_name(folder: str) -> str:
    return composed(os.path.basename(os.path.abspath(folder)))
