"""Plans and traces that the command line is given in place of a method."""

from __future__ import annotations

from pathlib import Path

from mrta_zoo.eval.console import warn
from mrta_zoo.io import read_plan, read_trace
from mrta_zoo.io.json_format import json_kind
from mrta_zoo.paths import composed, suffix_of
from mrta_zoo.plan import Plan
from mrta_zoo.scenario import Scenario


def read_any_plan(path: Path, scenario: Scenario) -> Plan | None:
    """The plan in a plan file or a trace; None if it is a file of another kind, or none.

    Says so on standard error if it bears the name of another scenario.

    Raises:
        MrtaError: if it is malformed.
    """
    if suffix_of(path) != ".json":
        return None
    plan = read_trace(path).plan() if json_kind(path) == "mrta_zoo.trace" else read_plan(path)
    check_name(path, plan, scenario)
    return plan


def check_name(path: Path, plan: Plan, scenario: Scenario) -> None:
    """Say so on standard error if a plan bears the name of another scenario; files may have been renamed."""
    if plan.scenario and scenario.name and composed(plan.scenario) != composed(scenario.name):
        warn(f"{path} is a plan for {plan.scenario}; the scenario is {scenario.name}")
