"""Scenario files in any known format, told apart by suffix: JSON, CSV, or else TAPTC text."""

from __future__ import annotations

from pathlib import Path

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io.formats import AGENT_FILE, FORMATS, format_of
from mrta_zoo.io.parts import Part, assemble
from mrta_zoo.io.paths import check_no_url, suffix_of
from mrta_zoo.io.text_files import StrPath, shown
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
    form = format_of(path)
    part = form.read(path)
    if agents is None and form.find_agents is not None:
        agents = form.find_agents(path)
    return assemble(part, None if agents is None else _agents(agents))


def agent_file(path: StrPath, agents: StrPath | None = None) -> Path | None:
    """The file that `read_scenario` reads the robots from; None if it is the scenario's own, or cannot be found."""
    if agents is not None:
        return Path(agents)
    find_agents = format_of(path).find_agents
    if find_agents is None:
        return None
    try:
        return find_agents(path)
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
    if suffix not in FORMATS:
        *others, last = FORMATS
        raise ScenarioError(f"{path} has the suffix {shown(suffix)}; expected {', '.join(others)} or {last}")
    FORMATS[suffix].write(scenario, path, path.parent / "agent")


def _agents(path: StrPath) -> Part:
    read = format_of(path).read_agents
    if read is None:
        raise ScenarioError(f"{path} has the suffix {shown(suffix_of(path))}; expected {AGENT_FILE}")
    return read(path)
