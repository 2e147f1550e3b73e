"""Methods as the command line names them: those of the registry, the user's policies, and files of plans and traces."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from mrta_zoo.errors import PlanError
from mrta_zoo.io import read_plan, read_trace
from mrta_zoo.io.json_format import json_kind
from mrta_zoo.io.paths import suffix_of
from mrta_zoo.plan import Plan
from mrta_zoo.policies.neural.policy_files import info_file, weights_file
from mrta_zoo.policies.pretrained import pretrained_names
from mrta_zoo.policies.registry import METHODS, POLISH
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.terminal.console import warn
from mrta_zoo.trace import Trace
from mrta_zoo.verify import verify
from mrta_zoo.wording import composed

PLAN, TRACE = "mrta_zoo.plan", "mrta_zoo.trace"
TRAINED_HELP = (
    f"a policy's .safetensors file, or the folder of a training run. NAME{POLISH} improves a method's plan by local "
    "search"
)
METHOD_HELP = (
    "; ".join(f"{name}: {method.summary}" for name, method in METHODS.items())
    + f"; {', '.join(pretrained_names())}: trained, ship with the package; {TRAINED_HELP}."
)


def files_of_methods(methods: Iterable[str]) -> dict[str, Path]:
    """The files that methods are read from, which may not exist, by what they are.

    Args:
        methods: as the command line names them.
    """
    files = {}
    for name in methods:
        if is_episode(name):
            files[f"the file {name}"] = Path(name)
        else:
            weights = weights_file(Path(name.removesuffix(POLISH)))
            files |= {f"the weights of {name}": weights, f"what belongs to the weights of {name}": info_file(weights)}
    return files


def is_episode(name: str | Path) -> bool:
    """Whether this is the name of a plan or a trace instead of a method. The file need not exist."""
    return suffix_of(name) == ".json" and not os.path.isdir(name)


def read_any_plan(path: Path, scenario: Scenario) -> Plan:
    """The plan in a plan file or a trace. Warns if it was made for a scenario of another name.

    Raises:
        MrtaError: if the file is missing or malformed, or the plan does not fit the scenario.
    """
    with _named(path):
        episode = _read(path)
        plan = episode.plan() if isinstance(episode, Trace) else episode
        _check_name(path, plan, scenario)
        verify(scenario, plan)
    return plan


def read_any_trace(path: Path, scenario: Scenario, mask_rule: MaskRule | None) -> Trace:
    """The trace in a file, or the one of the plan in it. Warns if the plan was made for a scenario of another name.

    Raises:
        MrtaError: if the file is missing or malformed, or the plan does not fit the scenario.
    """
    episode = _read(path)
    if isinstance(episode, Trace):
        return episode
    _check_name(path, episode, scenario)
    with _named(path):
        return Trace.of_plan(scenario, episode, mask_rule)


def _read(path: Path) -> Plan | Trace:
    return read_trace(path) if json_kind(path) == TRACE else read_plan(path)


@contextmanager
def _named(path: Path) -> Iterator[None]:
    """Within it, errors about a plan begin with the name of its file."""
    try:
        yield
    except PlanError as error:
        where = "" if str(error).startswith(str(path)) else f"{path}: "
        raise PlanError(f"{where}{error}") from None


def _check_name(path: Path, plan: Plan, scenario: Scenario) -> None:
    """Warn if a plan was made for a scenario of another name. It is no error: files may have been renamed."""
    if plan.scenario and scenario.name and composed(plan.scenario) != composed(scenario.name):
        warn(f"{path} is a plan for {plan.scenario}; the scenario is {scenario.name}")
