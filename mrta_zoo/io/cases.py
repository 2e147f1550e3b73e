"""Folders of benchmark cases, with the results that other methods reached on them."""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.files import read_scenario
from mrta_zoo.io.formats import FORMATS, format_of
from mrta_zoo.io.paths import check_no_url, suffix_of
from mrta_zoo.io.table import read_table
from mrta_zoo.io.text_files import StrPath, check_name, count, shown
from mrta_zoo.scenario import Scenario
from mrta_zoo.wording import composed

REFERENCE_FILE = "reference.csv"
ALIKE = 0.8
"""How similar, from 0 to 1, two names must be for one to pass as a misspelling of the other."""
LISTED = 3
"""The most names that are listed; others are only counted."""


@dataclass(frozen=True, slots=True)
class Case:
    """A scenario of a benchmark and the results known for it.

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


def read_cases(folder: StrPath, tell: Callable[[str], None] | None = None) -> list[Case]:
    """All cases of a folder in natural order of their names (``a2`` before ``a10``).

    Cases are TAPTC task files ``group*/*.txt`` (agent files in ``agent/``), and ``*.json`` and ``*.csv``
    scenarios in the folder itself, in lower or upper case. JSON and CSV files of this package that are not
    scenarios, such as plans and their schedules, are skipped. If there is a ``reference.csv`` with columns
    ``case,tasks,robots`` and one for each method, its whole numbers of completed tasks become the references; rows of
    other cases are skipped, and a cell may be empty.

    Args:
        folder: where they are.
        tell: called with a sentence about rows of the reference table that seem to be for cases of the folder, but
            match none; by default `warnings.warn`.

    Raises:
        ScenarioError: if there is no such folder, it holds no case, two cases share a name, or a file is
            malformed.
    """
    root = Path(folder)
    # os.path answers False where pathlib raises: without permission, or for a name that no file can have.
    if not os.path.isdir(root):
        check_no_url(folder, ScenarioError)
        problem = "is not a folder" if os.path.exists(root) else "does not exist"
        raise ScenarioError(f"{root} {problem}; expected a folder of cases")
    try:
        paths = _files_of_cases(root)
    except OSError as error:
        raise ScenarioError(
            f"{root} cannot be listed: {(error.strerror or str(error)).lower()}; expected a folder of cases"
        ) from None
    tables = [path for path in paths if path.name.lower() == REFERENCE_FILE]
    scenarios = _read_scenarios(path for path in paths if path not in tables)
    if not scenarios:
        raise ScenarioError(f"{root} holds no cases; expected group*/*.txt (TAPTC), *.json or *.csv files")
    if len(tables) > 1:
        raise ScenarioError(f"{tables[1]}: the folder also has {tables[0].name}; expected one reference table")
    references = read_reference(tables[0], scenarios) if tables else {}
    if strangers := _strangers(references, scenarios):
        sentence = f"{tables[0]}: {strangers}"
        tell(sentence) if tell else warnings.warn(sentence, stacklevel=2)
    cases = []
    for name in sorted(scenarios, key=_natural):
        reference = references.get(name, {})
        best_known = max(reference.values(), default=None)
        cases.append(Case(name, scenarios[name], best_known, reference))
    return cases


def _read_scenarios(paths: Iterable[Path]) -> dict[str, Scenario]:
    """The scenarios in these files by name; files of this package that hold none are skipped."""
    sources: dict[str, Path] = {}
    scenarios: dict[str, Scenario] = {}
    for path in paths:
        try:
            scenario = read_scenario(path)
        except ScenarioError:
            if format_of(path).is_other(path):
                continue
            raise
        if scenario.name in sources:
            raise ScenarioError(
                f"{path}: the case is called {shown(scenario.name)}, as in {sources[scenario.name]}; "
                "expected a different name for each case"
            )
        sources[scenario.name] = path
        scenarios[scenario.name] = scenario
    return scenarios


def _files_of_cases(root: Path) -> list[Path]:
    """Files that may hold a case or the reference table, without hidden ones."""
    entries = sorted(root.iterdir())
    groups = [entry for entry in entries if entry.name.lower().startswith("group") and os.path.isdir(entry)]
    in_groups = [path for group in groups for path in sorted(group.iterdir())]
    found: list[Path] = []
    for suffix, form in sorted(FORMATS.items(), key=lambda row: not row[1].grouped):
        found += [path for path in (in_groups if form.grouped else entries) if suffix_of(path) == suffix]
    found = [path for path in found if not path.name.startswith(".")]
    # Broken links are left to the reader, which reports them; a pipe would keep it waiting.
    return [path for path in found if os.path.isfile(path) or not os.path.exists(path)]


def _strangers(rows: Mapping[str, object], cases: Mapping[str, object]) -> str:
    """A sentence about rows of the reference table that match no case; empty if the table is of a larger folder."""
    strange, without = [name for name in rows if name not in cases], [name for name in cases if name not in rows]
    if not strange or (not without and len(strange) > len(cases)):
        return ""
    meant = {close[0]: name for name in without if (close := get_close_matches(name, strange, 1, ALIKE))}
    strange.sort(key=lambda name: name not in meant)
    rowless = f", and there is no row for {_listed(without)}" if without else ""
    hints = [f"; is {shown(name)} meant for {shown(meant[name])}?" for name in strange[:LISTED] if name in meant]
    return f"no case of the folder is called {_listed(strange)}{rowless}{''.join(hints)}"


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - LISTED} more" if len(names) > LISTED else ""
    return ", ".join(map(shown, names[:LISTED])) + more


def read_reference(path: StrPath, scenarios: Mapping[str, Scenario]) -> dict[str, dict[str, int]]:
    """Tasks completed by each method, by case, from a reference table, which may have rows of other scenarios, too.

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
        name = composed(name)
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
    return references


def _natural(name: str) -> tuple[list[tuple[str, int, str]], str]:
    """A sort key: runs of digits count as numbers, and ties are settled by their text."""
    pieces = re.findall(r"([^0-9]*)([0-9]*)", name)
    return [(text, len(digits.lstrip("0")), digits.lstrip("0")) for text, digits in pieces], name
