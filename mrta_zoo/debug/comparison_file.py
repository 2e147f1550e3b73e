"""Comparisons as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from mrta_zoo.debug.comparison import Comparison
from mrta_zoo.errors import ConfigError
from mrta_zoo.io.strict_json import write_document
from mrta_zoo.verify import Score


def write_comparison(found: Comparison, methods: Sequence[str], path: Path) -> None:
    """Write a comparison as JSON, without the episodes themselves.

    Raises:
        ConfigError: if the file cannot be written.
    """
    parting = found.parting
    document: dict[str, Any] = {
        "format": "mrta_zoo.comparison",
        "version": 1,
        "scenario": found.scenario,
        "tasks": found.tasks,
        "methods": list(methods),
        "outcomes": _outcomes(found.scores),
        "parting": parting and asdict(parting) | {"otherwise": _outcomes(parting.otherwise)},
        "disagreements": list(map(asdict, found.disagreements)),
        "turns": list(map(asdict, found.turns)),
        "fates": list(map(asdict, found.fates)),
    }
    scenario = found.traces[0].scenario
    names = {"task_names": list(scenario.task_names), "robot_names": list(scenario.robot_names)}
    document |= {field: each for field, each in names.items() if each}
    write_document(document, path, ConfigError)


def _outcomes(scores: Sequence[Score | None]) -> tuple[dict[str, Any] | None, ...]:
    figures = ("completed", "cost", "distance", "makespan")
    return tuple(None if score is None else {name: getattr(score, name) for name in figures} for score in scores)
