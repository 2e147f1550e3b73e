"""Traces as files: exact round trips, the schema, and sentences about whatever is wrong."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from sentences import check_sentence, names
from strategies import seeded_chooser, seeded_scenarios
from valid_files import PLAN, TRACE

import mrta_zoo.io
from mrta_zoo.bounds import MAX_SEED
from mrta_zoo.errors import MrtaError
from mrta_zoo.io import read_cases, read_trace, write_scenario, write_trace
from mrta_zoo.io.strict_json import schema_text
from mrta_zoo.io.trace_format import TraceJson
from mrta_zoo.mission import Mission
from mrta_zoo.rules import MaskRule
from mrta_zoo.scenario import Scenario
from mrta_zoo.trace import Choice, Trace, apply_choice

SCHEMA = Path(mrta_zoo.io.__file__).parent / "trace.schema.json"


def played(scenario: Scenario, rule: MaskRule, seed: int) -> Trace:
    """A random episode with everything a trace can hold; now and then a robot stays."""
    rng, choose = np.random.default_rng(seed), seeded_chooser(seed)
    mission, choices = Mission(scenario, rule), []
    while not mission.done:
        task = choose(mission.mask(mission.actor))
        given = {task: float(rng.uniform(0, 1))} if rng.random() < 0.5 else None
        choice = Choice(None if rng.random() < 0.1 else task, given, task if rng.random() < 0.5 else None)
        apply_choice(mission, choice, len(choices))
        choices.append(choice)
    return Trace(scenario, tuple(choices), rule, "any é", "greedy", MAX_SEED, 3, int(rng.integers(len(choices) + 1)))


@pytest.mark.parametrize("rule", ["feasible", "active", "unvisited"])
def test_round_trip_is_exact(tmp_path: Path, rule: MaskRule) -> None:
    schema = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text()))
    for seed, scenario in enumerate(seeded_scenarios(5, 25)):
        trace = played(scenario, rule, seed)
        write_trace(trace, tmp_path / "one.json")
        assert read_trace(tmp_path / "one.json") == trace
        schema.validate(json.loads((tmp_path / "one.json").read_text()))


def test_shipped_schema_is_current() -> None:
    """If it is not, write `schema_text(TraceJson)` to the file."""
    assert SCHEMA.read_text() == schema_text(TraceJson)


def test_what_is_derivable_may_be_left_out(tmp_path: Path) -> None:
    (tmp_path / "full.json").write_text(TRACE)
    bare = TRACE.replace('"time": 0, "robot": 0, ', "").replace('"time": 10, "robot": 0, ', "")
    (tmp_path / "bare.json").write_text(bare.replace('"map"', '"name": "full", "map"'))
    assert read_trace(tmp_path / "bare.json") == read_trace(tmp_path / "full.json")


def test_a_folder_of_cases_may_hold_traces(tmp_path: Path) -> None:
    (tmp_path / "trace.json").write_text(TRACE)
    (scenario,) = seeded_scenarios(1, 1)
    write_scenario(scenario, tmp_path / "case.json")
    assert [case.scenario for case in read_cases(tmp_path)] == [scenario]


BAD_TRACES = [
    ("", "is empty; expected"),
    (PLAN, "format is 'mrta_zoo.plan'; expected 'mrta_zoo.trace'"),
    (TRACE.replace('"version": 1', '"version": 2'), "version is 2; expected 1"),
    (TRACE.replace('"feasible"', '"any"'), "mask_rule is 'any'; expected one of active, feasible, unvisited"),
    (TRACE.replace('"deadline": 20', '"deadline": 0'), "tasks[0].deadline is 0; expected a number > 0"),
    (TRACE.replace('"y": 4', '"y": 51'), "tasks[0]: y is 51.0; expected a number from 0 to 50, inside"),
    (TRACE.replace('[{"x": 0, "y": 0, "capacity": 2}]', "[]"), "robots is a list of 0; expected a list of length >= 1"),
    (TRACE.replace('"task": null, ', ""), "decisions[1] has no field 'task'; expected task, time, robot"),
    (TRACE.replace('"task": 0', '"task": -1'), "decisions[0].task is -1; expected a whole number >= 0"),
    # Task 0 takes 5 + 5 time units; then task 1 takes 6 + 1.
    (TRACE.replace('"time": 10', '"time": 9'), "decisions[1].time is 9.0; expected 10.0, by the rules"),
    (TRACE.replace('"robot": 0', '"robot": 1'), "decisions[0].robot is 1; expected 0, by the rules"),
    (TRACE.replace('"task": 0', '"task": 2'), "decision 0: robot 0 chose task 2; tasks are numbered 0 to 1"),
    (TRACE.replace('"task": null', '"task": 0'), "decision 1: robot 0 may not choose task 0 at time 10: taken"),
    (TRACE.replace('"task": 0', '"task": null'), "decision 1 comes after the end of the mission; expected 1 decision"),
    (TRACE.replace('"advice": 1', '"advice": 2'), "decision 1 names task 2; tasks are numbered 0 to 1"),
    (TRACE.replace("[1, 0.25]", "[7, 0.25]"), "decision 0 names task 7; tasks are numbered 0 to 1"),
    (TRACE.replace("0.25", "1.25"), "decisions[0].probabilities[1][1] is 1.25; expected a number <= 1"),
    (TRACE.replace("0.25", "0.35"), "decisions[0]: the probabilities add up to 1.1; expected at most 1"),
    (TRACE.replace("[1, 0.25]", "[0, 0.25]"), "decisions[0].probabilities names a task twice; expected each once"),
    (TRACE.replace('"version": 1', '"version": 1, "bookmark": 3'), "the bookmark is 3; expected a number from 0 to 2"),
    (TRACE.replace('"version": 1', '"version": 1, "decode": "\\u0007"'), "decode is '\\x07'; expected text without"),
]


@pytest.mark.parametrize(("content", "message"), BAD_TRACES, ids=names(BAD_TRACES))
def test_bad_trace(tmp_path: Path, content: str, message: str) -> None:
    path = tmp_path / "trace.json"
    path.write_text(content)
    with pytest.raises(MrtaError) as caught:
        read_trace(path)
    check_sentence(caught.value, "trace.json", message)
