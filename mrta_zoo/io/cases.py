"""Folders of benchmark cases, with the results that others have reached on them."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.files import read_scenario
from mrta_zoo.io.json_format import is_other_json
from mrta_zoo.io.source import StrPath, check_name, count, shown
from mrta_zoo.io.table import read_table
from mrta_zoo.scenario import Scenario

REFERENCE_FILE = "reference.csv"


@dataclass(frozen=True, slots=True)
class Case:
    """A scenario of a benchmark and what is known of it.

    Attributes:
        name: the scenario's name, unique in the folder.
        scenario: the scenario.
        best_known: the most tasks that any method in the reference table completed, None if there is none.
        reference: tasks completed by each method of the reference table.
    """

    name: str
    scenario: Scenario
    best_known: int | None = None
    reference: Mapping[str, int] = field(default_factory=dict, hash=False)


def read_cases(folder: StrPath) -> list[Case]:
    """All cases of a folder in natural order of their names (``a2`` before ``a10``).

    Cases are TAPTC task files ``group*/*.txt`` (agent files in ``agent/``), and ``*.json`` and ``*.csv``
    scenarios in the folder itself. JSON files of this package that are no scenarios, such as plans, are passed
    over. If there is a ``reference.csv`` with columns ``case,tasks,robots`` and one for each method, its whole
    numbers of completed tasks become the references; rows of other cases are passed over, and a cell may be empty.

    Raises:
        ScenarioError: if there is no such folder, it holds no case, two cases share a name, or a file is
            malformed.
    """
    root = Path(folder)
    # os.path answers False where pathlib raises: without permission, or for a name that no file can have.
    if not os.path.isdir(root):
        problem = "is not a folder" if os.path.exists(root) else "does not exist"
        raise ScenarioError(f"{root} {problem}; expected a folder of cases")
    try:
        os.listdir(root)  # glob would find nothing in a folder that may not be read
        paths = [path for pattern in ("group*/*.txt", "*.json", "*.csv") for path in sorted(root.glob(pattern))]
    except OSError as error:
        raise ScenarioError(
            f"{root} cannot be listed: {(error.strerror or str(error)).lower()}; expected a folder of cases"
        ) from None
    sources: dict[str, Path] = {}
    scenarios: dict[str, Scenario] = {}
    for path in paths:
        if path.name == REFERENCE_FILE or path.name.startswith(".") or is_other_json(path):
            continue
        scenario = read_scenario(path)
        if scenario.name in sources:
            raise ScenarioError(
                f"{path}: the case is called {shown(scenario.name)}, as in {sources[scenario.name]}; "
                "expected a different name for each case"
            )
        sources[scenario.name] = path
        scenarios[scenario.name] = scenario
    if not scenarios:
        raise ScenarioError(f"{root} holds no cases; expected group*/*.txt (TAPTC), *.json or *.csv files")
    reference_path = root / REFERENCE_FILE
    references = read_reference(reference_path, scenarios) if os.path.lexists(reference_path) else {}
    cases = []
    for name in sorted(scenarios, key=_natural):
        reference = references.get(name, {})
        best_known = max(reference.values(), default=None)
        cases.append(Case(name, scenarios[name], best_known, reference))
    return cases


def read_reference(path: StrPath, scenarios: Mapping[str, Scenario]) -> dict[str, dict[str, int]]:
    """Tasks completed by each method, by case, from a reference table; only of the given scenarios.

    Raises:
        ScenarioError: if the table is malformed or contradicts a scenario's numbers of tasks or robots.
    """
    (where, header), *rows = read_table(path, ScenarioError)
    methods = header[3:]
    if header[:3] != ["case", "tasks", "robots"] or not methods:
        raise ScenarioError(
            f"{where}: header is {shown(','.join(header))}; expected case,tasks,robots and a column for each method"
        )
    for method in methods:
        check_name(method, where, "method", ScenarioError)
        if not method or header.count(method) > 1:
            raise ScenarioError(f"{where}: method {shown(method)} is empty or appears twice; expected each once")
    references: dict[str, dict[str, int]] = {}
    for where, (name, *numbers) in rows:
        check_name(name, where, "case", ScenarioError)
        if name in references:
            raise ScenarioError(f"{where}: case {shown(name)} appears twice; expected it once")
        tasks, robots = (
            count(text, where, what, ScenarioError) for text, what in zip(numbers[:2], ("tasks", "robots"), strict=True)
        )
        completed = {
            method: count(text, where, method, ScenarioError)
            for method, text in zip(methods, numbers[2:], strict=True)
            if text
        }
        for method, value in completed.items():
            if value > tasks:
                raise ScenarioError(f"{where}: {method} is {value}; expected at most {tasks}, the case's tasks")
        if scenario := scenarios.get(name):
            for what, said, is_so in (
                ("tasks", tasks, scenario.num_tasks),
                ("robots", robots, scenario.num_robots),
            ):
                if said != is_so:
                    raise ScenarioError(f"{where}: {what} is {said}; expected {is_so} as in the case {name}")
        references[name] = completed
    return {name: completed for name, completed in references.items() if name in scenarios}


def _natural(name: str) -> tuple[list[tuple[str, int, str]], str]:
    """Sorts runs of digits by the number they write; by their text where that is equal."""
    pieces = re.findall(r"([^0-9]*)([0-9]*)", name)
    return [(text, len(digits.lstrip("0")), digits.lstrip("0")) for text, digits in pieces], name
