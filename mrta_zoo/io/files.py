"""Scenario files in any known format, told apart by suffix: JSON, CSV, or else TAPTC text."""

from __future__ import annotations

from pathlib import Path

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.csv_format import read_csv_part, write_csv
from mrta_zoo.io.json_format import read_json_part, write_json
from mrta_zoo.io.parts import Part, assemble
from mrta_zoo.io.paths import check_no_url, suffix_of
from mrta_zoo.io.source import StrPath, shown
from mrta_zoo.io.taptc import find_agent_file, read_agent_part, read_task_part, write_taptc
from mrta_zoo.scenario import Scenario


def read_scenario(path: StrPath, agents: StrPath | None = None) -> Scenario:
    """Read a scenario from a ``.json`` or ``.csv`` file or, with any other suffix, a TAPTC task file.

    Args:
        path: the scenario, or its tasks only.
        agents: the robots, in a ``.csv`` or TAPTC agent file. Without it JSON and CSV must hold the robots
            too, and the agent file of a TAPTC task file is looked for where the published cases have it.

    Raises:
        ScenarioError: one sentence that names the file and the line or field that is wrong.
    """
    suffix = suffix_of(path)
    if suffix == ".json":
        return assemble(read_json_part(path), _agents(agents))
    if suffix == ".csv":
        return assemble(read_csv_part(path), _agents(agents))
    return assemble(read_task_part(path), _agents(agents if agents is not None else find_agent_file(path)))


def agent_file(path: StrPath, agents: StrPath | None = None) -> Path | None:
    """The file that `read_scenario` reads the robots from; None if it is the scenario's own, or cannot be found."""
    if agents is not None:
        return Path(agents)
    if suffix_of(path) in (".json", ".csv"):
        return None
    try:
        return find_agent_file(path)
    except ScenarioError:  # the reader has more to say: maybe there is no task file either
        return None


def write_scenario(scenario: Scenario, path: StrPath) -> None:
    """Write a scenario exactly, as the suffix says: ``.json``, ``.csv`` or, for TAPTC, ``.txt``.

    A TAPTC task file gets its agent file in the folder ``agent`` beside it, under the same name. CSV and
    TAPTC hold no scenario name: when read, the scenario is named after the file. Files are written through
    `atomic.replacing`.

    Raises:
        ScenarioError: if the format cannot express the scenario or the file cannot be written.
    """
    check_no_url(path, ScenarioError)
    path = Path(path)
    suffix = suffix_of(path)
    if suffix == ".json":
        write_json(scenario, path)
    elif suffix == ".csv":
        write_csv(scenario, path)
    elif suffix == ".txt":
        agent_folder = path.parent / "agent"
        try:
            agent_folder.mkdir(exist_ok=True)
        except OSError as problem:
            raise ScenarioError(f"{agent_folder} cannot be made: {problem.strerror}; expected a folder") from None
        write_taptc(scenario, path, agent_folder / path.name)
    else:
        raise ScenarioError(f"{path} has the suffix {shown(suffix)}; expected .json, .csv or .txt (TAPTC)")


def _agents(path: StrPath | None) -> Part | None:
    if path is None:
        return None
    suffix = suffix_of(path)
    if suffix == ".json":
        raise ScenarioError(f"{path} has the suffix '.json'; expected a .csv or TAPTC agent file")
    return read_csv_part(path) if suffix == ".csv" else read_agent_part(path)
