"""The replay page: one self-contained HTML file with data and drawing code, which needs no network."""

from __future__ import annotations

import os
from collections.abc import Sequence
from html import escape
from importlib.resources import files
from string import Template

import msgspec

from mrta_zoo.errors import ConfigError
from mrta_zoo.io.text_files import write_text
from mrta_zoo.show import palette
from mrta_zoo.show.replay.episode import EpisodeJson, PlaceJson, episode_of, place_of
from mrta_zoo.trace import Trace
from mrta_zoo.verify import COST

MOST_SIDES = 2


class DocumentJson(msgspec.Struct, frozen=True):
    """The data that is written into the page."""

    place: PlaceJson
    episodes: list[EpisodeJson]
    cost: str
    """The definition of the cost of an episode."""
    colours: dict[str, str | tuple[str, ...]]


def replay_page(traces: Sequence[Trace]) -> str:
    """The page, as HTML.

    Args:
        traces: one, or two of the same scenario, which are then shown side by side.

    Raises:
        ConfigError: if there are more, none, or two of different scenarios.
    """
    if not 1 <= len(traces) <= MOST_SIDES:
        raise ConfigError(f"there are {len(traces)} episodes to replay; expected one, or two to compare")
    scenario = traces[0].scenario
    if any(trace.scenario != scenario for trace in traces):
        names = " and ".join(repr(trace.scenario.name) for trace in traces)
        raise ConfigError(f"the episodes are of different scenarios, {names}; expected two of the same")
    episodes = [episode_of(trace) for trace in traces]
    makespan = max(episode.makespan for episode in episodes)
    document = DocumentJson(place_of(scenario, makespan), episodes, COST, _colours())
    return Template(_part("replay.html")).substitute(
        title=escape(scenario.name),
        style=_part("replay.css"),
        # In HTML nothing but "</script" and "<!--" ends or changes a script, and JSON can do without "<".
        data=msgspec.json.encode(document).decode().replace("<", "\\u003c"),
        given=_part("given.js"),
        lettering=_part("lettering.js"),
        map=_part("map.js"),
        charts=_part("charts.js"),
        replay=_part("replay.js"),
    )


def write_replay(traces: Sequence[Trace], path: str | os.PathLike[str]) -> None:
    """Write the page, whole or not at all; arguments and errors as for `replay_page`.

    Raises:
        ConfigError: also if the file cannot be written.
    """
    write_text(replay_page(traces), path, ConfigError)


def _part(name: str) -> str:
    return files("mrta_zoo.show.replay").joinpath(name).read_text(encoding="utf-8")


def _colours() -> dict[str, str | tuple[str, ...]]:
    return {
        "ink": palette.INK,
        "faint": palette.FAINT,
        "ground": palette.GROUND,
        "robots": palette.ROBOT_COLOURS,
        "urgency": palette.URGENCY,
        "missed": palette.MISSED,
    }
