"""Traces as JSON, read strictly: a scenario file with decisions. The schema is ``trace.schema.json``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from mrta_zoo.errors import PlanError
from mrta_zoo.io.json_format import Index, MapJson, NonNegative, RobotJson, TaskJson, json_part, scenario_fields
from mrta_zoo.io.parts import assemble
from mrta_zoo.io.strict_json import read_document, write_document
from mrta_zoo.io.text_files import StrPath
from mrta_zoo.rules import MaskRule
from mrta_zoo.trace import Choice, Trace

Probability = Annotated[float, Meta(ge=0, le=1)]


class DecisionJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One decision: the task taken, null if the robot stays for good. Time and robot are for people; they are checked.

    Probabilities are pairs of a task and its probability; advice is what the policy would have taken where
    somebody else decided.
    """

    task: Index | None
    time: NonNegative | None = None
    robot: Index | None = None
    probabilities: tuple[tuple[Index, Probability], ...] | None = None
    advice: Index | None = None


class TraceJson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A trace file: the scenario, as in a scenario file, and every decision of an episode in order."""

    format: Literal["mrta_zoo.trace"]
    version: Literal[1]
    map: MapJson
    tasks: Annotated[tuple[TaskJson, ...], Meta(min_length=1)]
    robots: Annotated[tuple[RobotJson, ...], Meta(min_length=1)]
    decisions: tuple[DecisionJson, ...]
    mask_rule: MaskRule
    name: str = ""
    method: str = ""
    decode: str = ""
    seed: Index | None = None
    bound: Index | None = None  # completed tasks, as in a plan file
    bookmark: Index | None = None


def read_trace(path: StrPath) -> Trace:
    """The trace in a JSON trace file. Every decision is made again, so that each is known to be legal.

    Raises:
        PlanError: if the file is missing or malformed, a robot could not choose what it says, or a robot or time in it
            contradicts the rules.
        ScenarioError: if the scenario in it breaks a rule of the problem.
    """
    data = read_document(path, TraceJson, PlanError)
    scenario = assemble(json_part(path, data.map, data.tasks, data.robots, data.name or Path(path).stem), None)
    try:
        trace = Trace(
            scenario,
            tuple(_choice(index, decision) for index, decision in enumerate(data.decisions)),
            data.mask_rule,
            data.method,
            data.decode,
            data.seed,
            data.bound,
            data.bookmark,
        )
        for said, derived in zip(data.decisions, trace.decisions(), strict=True):
            for what, value, expected in (
                ("robot", said.robot, derived.robot),
                ("time", said.time, derived.time),
            ):
                if value is not None and value != expected:
                    raise PlanError(
                        f"decisions[{derived.index}].{what} is {value!r}; expected {expected!r}, by the rules"
                    )
    except PlanError as error:
        raise PlanError(f"{path}: {error}") from None
    return trace


def write_trace(trace: Trace, path: StrPath) -> None:
    """Write a trace, exactly, one line per decision.

    Raises:
        PlanError: if the file cannot be written.
    """
    document: dict[str, Any] = {"format": "mrta_zoo.trace", "version": 1, "method": trace.method}
    for field in ("decode", "seed", "bound", "bookmark"):
        if (value := getattr(trace, field)) not in (None, ""):
            document[field] = value
    document |= {"mask_rule": trace.mask_rule, **scenario_fields(trace.scenario)}
    document["decisions"] = [
        _decision(decision.time, decision.robot, decision.choice) for decision in trace.decisions()
    ]
    write_document(document, path, PlanError)


def _choice(index: int, decision: DecisionJson) -> Choice:
    pairs = decision.probabilities
    probabilities = None if pairs is None else dict(pairs)
    if pairs is not None and probabilities is not None and len(probabilities) < len(pairs):
        raise PlanError(f"decisions[{index}].probabilities names a task twice; expected each once")
    try:
        return Choice(decision.task, probabilities, decision.advice)
    except PlanError as error:
        raise PlanError(f"decisions[{index}]: {error}") from None


def _decision(time: float, robot: int, choice: Choice) -> dict[str, Any]:
    row: dict[str, Any] = {"time": time, "robot": robot, "task": choice.task}
    if choice.advice is not None:
        row["advice"] = choice.advice
    if choice.probabilities is not None:
        row["probabilities"] = [[task, probability] for task, probability in choice.probabilities.items()]
    return row
