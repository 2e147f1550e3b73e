"""JSON scenarios and plans: exact round trips, optional fields, and the published schemas."""

import json
import os
from dataclasses import replace
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import mrta_zoo.io
from mrta_zoo import Plan, Scenario
from mrta_zoo.errors import PlanError, ScenarioError
from mrta_zoo.generators import TaptcGenerator, UniformGenerator
from mrta_zoo.io import read_plan, read_scenario, write_plan, write_scenario
from mrta_zoo.io.json_format import ScenarioJson
from mrta_zoo.io.plan_format import PlanJson
from mrta_zoo.io.strict_json import schema_text
from mrta_zoo.verify import Score, Visit

SCHEMAS = Path(mrta_zoo.io.__file__).parent
SMALL = {
    "format": "mrta_zoo.scenario",
    "version": 1,
    "map": {"width": 10, "height": 20},
    "tasks": [{"x": 1, "y": 2.5, "deadline": 30, "workload": 0}],
    "robots": [{"x": 3, "y": 20, "capacity": 2}],
}


def schema(name: str) -> dict[str, object]:
    loaded: dict[str, object] = json.loads((SCHEMAS / f"{name}.schema.json").read_text())
    return loaded


@pytest.mark.parametrize("seed", range(10))
def test_round_trip_is_exact(tmp_path: Path, seed: int) -> None:
    rng = np.random.default_rng(seed)
    generator = TaptcGenerator() if seed % 2 else UniformGenerator(speed=(0.1, 3))
    scenario = generator(rng, name=f'cas "{seed}" é')
    write_scenario(scenario, tmp_path / "one.json")
    assert read_scenario(tmp_path / "one.json") == scenario
    jsonschema.validate(json.loads((tmp_path / "one.json").read_text()), schema("scenario"))


def test_optional_fields(tmp_path: Path) -> None:
    path = tmp_path / "small.json"
    path.write_bytes(b"\xef\xbb\xbf" + json.dumps(SMALL).encode())
    scenario = read_scenario(path)
    assert scenario.name == "small"
    assert scenario.speed.tolist() == [1]
    assert scenario.map_size == (10, 20)
    assert scenario.robot_xy.tolist() == [[3, 20]]


@pytest.mark.parametrize(
    ("name", "content"),
    [("robots.csv", "kind,x,y,capacity\nrobot,3,20,2\n"), ("robots.txt", "1 10 20\n0 3 20 2")],
)
def test_robots_from_an_agent_file(tmp_path: Path, name: str, content: str) -> None:
    (tmp_path / "all.json").write_text(json.dumps({**SMALL, "name": "small"}))
    (tmp_path / "tasks.json").write_text(json.dumps({**SMALL, "name": "small", "robots": []}))
    (tmp_path / name).write_text(content)
    assert read_scenario(tmp_path / "tasks.json", tmp_path / name) == read_scenario(tmp_path / "all.json")
    with pytest.raises(ScenarioError, match="expected robots in one of the two files only"):
        read_scenario(tmp_path / "all.json", tmp_path / name)
    with pytest.raises(ScenarioError, match=r"tasks\.json has 0 robots.*--agents"):
        read_scenario(tmp_path / "tasks.json")


def test_a_plan_carries_its_bound(tmp_path: Path) -> None:
    for bound in (None, 0, 14):
        plan = Plan(((1,), (0, 2)), "small", "hand", bound)
        write_plan(plan, tmp_path / "plan.json")
        assert read_plan(tmp_path / "plan.json") == plan
        document = json.loads((tmp_path / "plan.json").read_text())
        assert document.get("bound") == bound
        jsonschema.validate(document, schema("plan"))


@pytest.mark.parametrize(("name", "document"), [("scenario", ScenarioJson), ("plan", PlanJson)])
def test_shipped_schema_is_current(name: str, document: type[ScenarioJson] | type[PlanJson]) -> None:
    """If it is not, write `schema_text(document)` to the file."""
    assert (SCHEMAS / f"{name}.schema.json").read_text() == schema_text(document)


def test_schema_rejects_what_the_reader_rejects(tmp_path: Path) -> None:
    path = tmp_path / "one.json"
    task, robot = {"x": 1, "y": 1, "deadline": 5, "workload": 1}, {"x": 1, "y": 1, "capacity": 1}
    wrong = [
        {"version": 2}, {"format": "x"}, {"tasks": []}, {"extra": 1}, {"map": {"width": 0, "height": 1}},
        {"tasks": [{**task, "deadline": 0}]}, {"tasks": [{**task, "workload": -1}]}, {"tasks": [{"x": 1}]},
        {"robots": [{**robot, "capacity": 0}]}, {"robots": [{**robot, "speed": -1}]}, {"name": 3},
    ]  # fmt: skip
    jsonschema.validate(SMALL, schema("scenario"))
    for change in wrong:
        path.write_text(json.dumps({**SMALL, **change}))
        with pytest.raises(ScenarioError, match="expected"):
            read_scenario(path)
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate({**SMALL, **change}, schema("scenario"))


PLAN = Plan.of([[3, 0], [], [2]], scenario="r11", method="nearest")


def test_plan_round_trip(tmp_path: Path) -> None:
    path = tmp_path / "plan.json"
    write_plan(PLAN, path)
    assert read_plan(path) == PLAN
    jsonschema.validate(json.loads(path.read_text()), schema("plan"))


def test_plan_with_schedule_and_score(tmp_path: Path) -> None:
    path = tmp_path / "plan.json"
    stop = Visit(task=3, arrival=1.5, finish=2.0, deadline=9.0, completed=True)
    score = Score(4, 3, 0.75, cost=1.25, distance=10.5, makespan=12.0, schedule=((stop, stop), (), (stop,)))
    write_plan(PLAN, path, score)
    document = json.loads(path.read_text())
    jsonschema.validate(document, schema("plan"))
    assert read_plan(path) == PLAN
    assert document["score"]["completion"] == 0.75
    assert document["schedule"][2] == [{"task": 3, "arrival": 1.5, "finish": 2.0, "deadline": 9.0, "completed": True}]
    path.write_text(path.read_text().replace("1.25", "-1.0"))
    with pytest.raises(PlanError, match=r"cost is -1\.0; expected a number >= 0"):
        read_plan(path)


def test_plan_with_an_infinite_score_is_not_written(tmp_path: Path) -> None:
    score = Score(1, 0, 0.0, cost=float("inf"), distance=0.0, makespan=0.0, schedule=())
    with pytest.raises(PlanError, match="score holds a number that is not finite"):
        write_plan(PLAN, tmp_path / "plan.json", score)
    assert not list(tmp_path.iterdir())


def test_failed_write_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "plan.json"
    write_plan(PLAN, path)

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(PlanError, match=r"plan\.json cannot be written: no space left"):
        write_plan(replace(PLAN, method="other"), path)
    assert read_plan(path) == PLAN
    assert [file.name for file in tmp_path.iterdir()] == ["plan.json"]


def test_write_follows_the_usual_permissions(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    write_plan(PLAN, tmp_path / "plan.json")
    assert (tmp_path / "plan.json").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_write_to_a_device_does_not_replace_it() -> None:
    write_plan(PLAN, "/dev/null")
    assert not Path("/dev/null").is_file()


@pytest.mark.parametrize("name", ["missing/plan.json", ".", "plan\0.json"])
def test_write_where_no_file_can_be(tmp_path: Path, name: str) -> None:
    with pytest.raises(PlanError, match="cannot be written"):
        write_plan(PLAN, tmp_path / name)


def test_unknown_suffix_is_refused(tmp_path: Path) -> None:
    scenario = Scenario([[1, 1]], [5], [1], [[0, 0]], [1])  # type: ignore[arg-type]
    with pytest.raises(ScenarioError, match=r"suffix '\.yaml'; expected \.json, \.csv or \.txt"):
        write_scenario(scenario, tmp_path / "one.yaml")


@pytest.mark.parametrize(
    "text", ['"x": "\\ud800"', '"\\ud800": 1, "x": 1'], ids=["where a number should be", "as a key"]
)
def test_text_that_cannot_be_written_is_told(tmp_path: Path, text: str) -> None:
    path = tmp_path / "lone.json"
    path.write_text(json.dumps(SMALL).replace('"x": 1', text))
    with pytest.raises(ScenarioError, match="expected text without lone surrogates"):
        read_scenario(path)
