"""The formats of scenario files. To add one, add its name to `FormatName` and its row to `FORMATS`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.csv_format import is_other_csv, read_csv_part, write_csv
from mrta_zoo.io.json_format import is_other_json, read_json_part, write_json
from mrta_zoo.io.parts import Part
from mrta_zoo.io.paths import suffix_of
from mrta_zoo.io.taptc import find_agent_file, read_agent_part, read_task_part, write_taptc
from mrta_zoo.io.text_files import StrPath
from mrta_zoo.scenario import Scenario

FormatName = Literal["taptc", "json", "csv"]


@dataclass(frozen=True, slots=True)
class Format:
    """How scenarios are stored.

    Attributes:
        name: of the format.
        read: what a file says.
        write: writes a scenario to a file and, if its robots need a file of their own, that to a folder.
        read_agents: what a file of robots alone says; None if the format has none.
        find_agents: finds the file with the robots that belong to a file of tasks; None if one file holds both.
        is_other: whether a file of this suffix is one of this package's that is no scenario.
        grouped: whether the files of a folder of cases lie in its folders ``group*``, not in itself.
    """

    name: FormatName
    read: Callable[[StrPath], Part]
    write: Callable[[Scenario, Path, Path], None]
    read_agents: Callable[[StrPath], Part] | None = None
    find_agents: Callable[[StrPath], Path] | None = None
    is_other: Callable[[Path], bool] = lambda path: False
    grouped: bool = False


def _write_taptc(scenario: Scenario, path: Path, agents: Path) -> None:
    try:
        agents.mkdir(exist_ok=True)
    except OSError as problem:
        raise ScenarioError(f"{agents} cannot be made: {problem.strerror}; expected a folder") from None
    write_taptc(scenario, path, agents / path.name)


FORMATS: dict[str, Format] = {
    ".json": Format(
        "json", read_json_part, lambda scenario, path, agents: write_json(scenario, path), is_other=is_other_json
    ),
    ".csv": Format(
        "csv", read_csv_part, lambda scenario, path, agents: write_csv(scenario, path), read_csv_part,
        is_other=is_other_csv,
    ),
    ".txt": Format("taptc", read_task_part, _write_taptc, read_agent_part, find_agent_file, grouped=True),
}  # fmt: skip
"""Every format, by the suffix of its files."""

OTHERWISE = FORMATS[".txt"]
"""The format of files with any other suffix."""

SCENARIO_FILE = "a TAPTC task file, or a scenario in " + " or ".join(
    suffix for suffix, each in FORMATS.items() if each is not OTHERWISE
)
"""What helps say that a scenario may be in."""

AGENT_FILE = "a TAPTC agent file, or " + " or ".join(
    suffix for suffix, each in FORMATS.items() if each is not OTHERWISE and each.read_agents
)
"""What helps say that robots alone may be in."""


def format_of(path: StrPath) -> Format:
    """The format of a scenario file, by its suffix."""
    return FORMATS.get(suffix_of(path), OTHERWISE)
