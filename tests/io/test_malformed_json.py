"""Malformed JSON scenarios and plans: one sentence with file, place, value and what was expected."""

from pathlib import Path

import pytest
from sentences import check_sentence, names
from valid_files import PLAN, SCENARIO, TASKS

from mrta_zoo.errors import PlanError, ScenarioError
from mrta_zoo.io import read_plan, read_scenario

BAD_JSON = [
    ("", "is empty; expected"),
    ("{}", "has no field 'format'; expected format 'mrta_zoo.scenario'"),
    ("[1, 2]", "holds a list of 2; expected an object with format, version"),
    ("3", "holds 3; expected an object"),
    (TASKS, "line 1, column 3: extra data at '3 100 50'; expected JSON"),
    (SCENARIO[:-1], "line 10, column 1: expecting ',' delimiter at the end of the line; expected JSON"),
    (SCENARIO.replace("20}\n", "20},\n"), "; expected JSON"),  # the place depends on the version of Python
    (SCENARIO.replace("255", "x255"), "line 6, column 34: expecting value at 'x255, "),
    (SCENARIO.replace("255", "0xFF"), "line 6, column 35: expecting ',' delimiter at 'xFF, "),
    (SCENARIO.replace("255", "2_5"), "line 6, column 35: expecting ',' delimiter at '_5, "),
    (SCENARIO.replace("255", "NaN"), "line 6: NaN is no JSON number; expected a finite number"),
    (SCENARIO.replace("255", "-Infinity"), "line 6: -Infinity is no JSON number; expected a finite number"),
    (SCENARIO.replace("255", "1e999"), "line 6: '1e999' is too large; expected a finite number"),
    (SCENARIO.replace("255", "9" * 5000), "is too large; expected a finite number"),
    (SCENARIO.replace('4, "deadline"', '4, "y": 4, "deadline"'), "field 'y' appears twice in an object"),
    (SCENARIO.replace("mrta_zoo.scenario", "mrta_zoo.plan"), "format is 'mrta_zoo.plan'; expected"),
    (SCENARIO.replace('"mrta_zoo.scenario"', "[]"), "format is a list of 0; expected 'mrta_zoo.scenario'"),
    (SCENARIO.replace('"version": 1', '"version": 2'), "version is 2; expected 1"),
    (SCENARIO.replace('"version": 1', '"version": true'), "version is true; expected 1"),
    (SCENARIO.replace('"version": 1', '"version": "1"'), "version is '1'; expected 1"),
    (SCENARIO.replace('"version": 1,', ""), "has no field 'version'; expected version 1"),
    (SCENARIO.replace('"version": 1', '"version": 1, "depot": 3'), "has an unknown field 'depot'; expected"),
    (SCENARIO.replace('"version": 1', '"version": 1, "name": 3'), "name is 3; expected text"),
    (SCENARIO.replace('"version": 1', '"version": 1, "name": "\\ud800"'), "name is '\\ud800'; expected text"),
    (SCENARIO.replace('"height": 50', '"height": 0'), "map.height is 0; expected a number > 0"),
    (SCENARIO.replace('"height": 50', '"height": "50"'), "map.height is '50'; expected a number"),
    (SCENARIO.replace(', "height": 50', ""), "map has no field 'height'; expected width, height"),
    (SCENARIO.replace('{"width": 100, "height": 50}', "3"), "map is 3; expected an object or null"),
    (SCENARIO.replace("255", '"255"'), "tasks[0].deadline is '255'; expected a number"),
    (SCENARIO.replace("255", "true"), "tasks[0].deadline is true; expected a number"),
    (SCENARIO.replace("255", "null"), "tasks[0].deadline is null; expected a number"),
    (SCENARIO.replace("255", "1e300"), "tasks[0]: deadline is 1e+300; expected a number > 0, from 1e-12 to 1e+12"),
    (SCENARIO.replace('"speed": 1', '"speed": 1e-13'), "robots[0]: speed is 1e-13; expected a number > 0, from"),
    (SCENARIO.replace('"height": 50', '"height": 5e12'), "map: height is 5000000000000.0; expected a number > 0, from"),
    (SCENARIO.replace('"version": 1', '"version": 1, "name": "\\u001b[31m"'), "name is '\\x1b[31m'; expected text"),
    (SCENARIO.replace("255", "0"), "tasks[0].deadline is 0; expected a number > 0"),
    (SCENARIO.replace("255", "[[[]]]"), "tasks[0].deadline is a list of 1; expected a number"),
    (SCENARIO.replace('"y": 4', '"y": 50.5'), "tasks[1]: y is 50.5; expected a number from 0 to 50"),
    (SCENARIO.replace('"y": 4', '"y": -49'), "tasks[1]: y is -49.0; expected a number from 0 to 50"),
    (SCENARIO.replace('"height": 50', '"height": 50, "x": 0'), "map has only one of x and y; expected both"),
    (SCENARIO.replace('"y": 4', '"z": 4'), "tasks[1] has an unknown field 'z'; expected only x, y, deadline"),
    (SCENARIO.replace('"y": 4, ', ""), "tasks[1] has no field 'y'; expected x, y, deadline, workload"),
    (SCENARIO.replace('"capacity": 1', '"capacity": -1'), "robots[0].capacity is -1; expected a number > 0"),
    (SCENARIO.replace('"speed": 1', '"speed": 0'), "robots[0].speed is 0; expected a number > 0"),
    (SCENARIO.replace('"robots": [{', '"robots": [7, {'), "robots[0] is 7; expected an object"),
    (SCENARIO.replace('"robots"', '"tasks"'), "field 'tasks' appears twice in an object; expected it once"),
    (SCENARIO[: SCENARIO.index(',\n  "robots"')] + "}", "has 0 robots; expected at least one"),
    ("[" * 100_000, "is nested too deeply; expected a mrta_zoo.scenario file"),
    ('{"format":' * 100_000, "is nested too deeply; expected a mrta_zoo.scenario file"),
    (SCENARIO.encode("utf-16"), "looks like UTF-16; expected UTF-8 text"),
    (b'{"\xff": 1}', "line 1: byte 0xff is not UTF-8; expected UTF-8 text"),
]  # fmt: skip


@pytest.mark.parametrize(("content", "message"), BAD_JSON, ids=names(BAD_JSON))
def test_bad_json(tmp_path: Path, content: str | bytes, message: str) -> None:
    path = tmp_path / "cas.json"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ScenarioError) as caught:
        read_scenario(path)
    check_sentence(caught.value, "cas.json", message, "expected")


BAD_PLANS = [
    ("", "is empty; expected"),
    (SCENARIO, "format is 'mrta_zoo.scenario'; expected 'mrta_zoo.plan'"),
    (PLAN.replace("[[0, 2], [1]]", "7"), "routes is 7; expected a list"),
    (PLAN.replace("[1]", "1"), "routes[1] is 1; expected a list"),
    (PLAN.replace("2]", "-2]"), "routes[0][1] is -2; expected a whole number >= 0"),
    (PLAN.replace("2]", "2.5]"), "routes[0][1] is 2.5; expected a whole number"),
    (PLAN.replace("2]", '"2"]'), "routes[0][1] is '2'; expected a whole number"),
    (PLAN.replace("2]", "true]"), "routes[0][1] is true; expected a whole number"),
    (PLAN.replace("2]", "2"), "line 5, column 1: expecting ',' delimiter at '}'; expected JSON"),
    (PLAN.replace('"version": 1', '"version": 1, "score": {}'), "score has no field 'completed'; expected"),
    (
        PLAN.replace('"version": 1', '"version": 1, "schedule": [[{"task": 1}]]'),
        "schedule[0][0] has no field",
    ),
    (
        PLAN.replace('"version": 1', '"version": 1, "route": []'),
        "has an unknown field 'route'; expected only",
    ),
]


@pytest.mark.parametrize(("content", "message"), BAD_PLANS, ids=names(BAD_PLANS))
def test_bad_plan(tmp_path: Path, content: str, message: str) -> None:
    path = tmp_path / "plan.json"
    path.write_text(content)
    with pytest.raises(PlanError) as caught:
        read_plan(path)
    check_sentence(caught.value, "plan.json", message, "expected")
