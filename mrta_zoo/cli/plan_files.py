"""Plans and traces that the command line is given in place of a method."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mrta_zoo.errors import PlanError
from mrta_zoo.io import read_plan, read_trace
from mrta_zoo.io.json_format import json_kind
from mrta_zoo.io.paths import suffix_of
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.terminal.console import warn
from mrta_zoo.trace import Trace
from mrta_zoo.verify import verify
from mrta_zoo.wording import composed

PLAN, TRACE = "mrta_zoo.plan", "mrta_zoo.trace"


def is_episode(name: str | Path) -> bool:
    """Whether what is given in place of a method is a plan or a trace, which need not be there."""
    return suffix_of(name) == ".json" and not os.path.isdir(name)


def read_any_plan(path: Path, scenario: Scenario) -> Plan | None:
    """The plan in a plan file or a trace; None if it is a file of another kind, or none.

    Says so on standard error if it bears the name of another scenario.

    Raises:
        MrtaError: if it is malformed, or does not fit the scenario.
    """
    if not is_episode(path):
        return None
    with named(path):
        episode = read_episode(path)
        plan = episode.plan() if isinstance(episode, Trace) else episode
        check_name(path, plan, scenario)
        verify(scenario, plan)
    return plan


def read_episode(path: Path) -> Plan | Trace:
    """What a plan file or a trace holds.

    Raises:
        MrtaError: if it is missing or malformed.
    """
    return read_trace(path) if json_kind(path) == TRACE else read_plan(path)


@contextmanager
def named(path: Path) -> Iterator[None]:
    """What is wrong with a plan meanwhile is told with the name of its file."""
    try:
        yield
    except PlanError as error:
        where = "" if str(error).startswith(str(path)) else f"{path}: "
        raise PlanError(f"{where}{error}") from None


def check_name(path: Path, plan: Plan, scenario: Scenario) -> None:
    """Say so on standard error if a plan bears the name of another scenario; files may have been renamed."""
    if plan.scenario and scenario.name and composed(plan.scenario) != composed(scenario.name):
        warn(f"{path} is a plan for {plan.scenario}; the scenario is {scenario.name}")
