"""Names of tasks and robots in each kind of file."""

from pathlib import Path

import numpy as np
import pytest

from mrta_zoo.errors import ScenarioError
from mrta_zoo.io import read_scenario, write_scenario, write_taptc
from mrta_zoo.scenario import Scenario

NAMED = Scenario(
    task_xy=[[1, 2], [3, 4]],
    deadline=[50, 60],
    workload=[5, 6],
    robot_xy=[[7, 8]],
    capacity=[2],
    name="cas",
    task_names=("valve-A", "17"),
    robot_names=("Ann",),
)


@pytest.mark.parametrize("suffix", [".json", ".csv", ".txt"])
def test_names_are_kept(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / "group1" / f"cas{suffix}"
    path.parent.mkdir()
    (tmp_path / "agent").mkdir()
    write_scenario(NAMED, path)
    assert read_scenario(path) == NAMED


@pytest.mark.parametrize("field", ["id", "name"])
def test_json_takes_texts_and_numbers_as_names(tmp_path: Path, field: str) -> None:
    path = tmp_path / "cas.json"
    path.write_text(
        '{"format": "mrta_zoo.scenario", "version": 1, "map": {"width": 9, "height": 9}, "tasks": ['
        f'{{"{field}": "pump", "x": 1, "y": 1, "deadline": 9, "workload": 1}}, '
        f'{{"{field}": 17, "x": 1, "y": 1, "deadline": 9, "workload": 1}}], '
        f'"robots": [{{"{field}": "Ann", "x": 1, "y": 1, "capacity": 1}}]}}'
    )
    scenario = read_scenario(path)
    assert (scenario.task_names, scenario.robot_names) == (("pump", "17"), ("Ann",))


def test_ids_of_a_table_are_numbers_where_they_can_be(tmp_path: Path) -> None:
    path = tmp_path / "cas.csv"
    path.write_text(
        "kind,id,x,y,deadline,workload,capacity\ntask,1,5,5,50,1,\ntask,0,6,6,60,1,\nrobot,R2,1,1,,,1\nrobot,D2,2,2,,,1\n"
    )
    scenario = read_scenario(path)
    assert scenario.task_names == ()
    assert scenario.deadline.tolist() == [60, 50]
    assert scenario.robot_names == ("R2", "D2")
    assert scenario.robot_xy.tolist() == [[1, 1], [2, 2]]


def test_ids_of_taptc_that_are_no_numbering_are_names(tmp_path: Path) -> None:
    (tmp_path / "cas.txt").write_text("1 2 100 50\n1 3 4 20 100\n2 5 6 20 200\n")
    (tmp_path / "bots.txt").write_text("1 100 50\nD2 9 10 2\n")
    scenario = read_scenario(tmp_path / "cas.txt", tmp_path / "bots.txt")
    assert (scenario.task_names, scenario.robot_names) == (("1", "2"), ("D2",))
    assert scenario.deadline.tolist() == [100, 200]


@pytest.mark.parametrize(
    ("names", "message"),
    [(("valve A", "17"), "without blanks"), (("1", "0"), "in another order")],
)
def test_names_that_taptc_cannot_hold(tmp_path: Path, names: tuple[str, ...], message: str) -> None:
    scenario = Scenario(NAMED.task_xy, NAMED.deadline, NAMED.workload, NAMED.robot_xy, NAMED.capacity, task_names=names)
    with pytest.raises(ScenarioError, match=message):
        write_taptc(scenario, tmp_path / "cas.txt", tmp_path / "bots.txt")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("shift", [(-50, -60), (512_000, 5_403_000)])
@pytest.mark.parametrize("suffix", [".json", ".csv", ".txt"])
def test_the_map_may_lie_anywhere(tmp_path: Path, suffix: str, shift: tuple[int, int]) -> None:
    moved = Scenario(
        NAMED.task_xy + np.array(shift),
        NAMED.deadline,
        NAMED.workload,
        NAMED.robot_xy + np.array(shift),
        NAMED.capacity,
        map_size=(20, 10),
        name="cas",
    )
    assert moved.map_origin == (shift[0] + 1, shift[1] + 2)  # the least whole x and y: task 0 is at 1, 2
    path = tmp_path / "group1" / f"cas{suffix}"
    path.parent.mkdir()
    (tmp_path / "agent").mkdir()
    write_scenario(moved, path)
    assert read_scenario(path) == moved


def test_a_map_is_put_around_places_where_a_table_has_none(tmp_path: Path) -> None:
    path = tmp_path / "cas.csv"

    def read(dx: float) -> Scenario:
        path.write_text(f"kind,x,y,deadline,workload,capacity\ntask,{dx + 7.5},3,9,1,\nrobot,{dx + 2.5},1,,,1\n")
        return read_scenario(path)

    assert (read(0).map_size, read(0).map_origin) == ((8, 8), (0, 0))
    assert (read(-20).map_size, read(-20).map_origin) == ((6, 6), (-18, 1))  # x from -17.5 to -12.5
    assert (read(600).map_size, read(600).map_origin) == ((6, 6), (602, 1))
    assert (read(2).map_size, read(2).map_origin) == ((10, 10), (0, 0))  # 10 is no more than twice 6


def test_names_that_turn_round_what_follows_are_refused() -> None:
    with pytest.raises(
        ScenarioError, match=r"task 1 has the name 'b\\u202e'; expected text without control characters"
    ):
        Scenario(
            NAMED.task_xy, NAMED.deadline, NAMED.workload, NAMED.robot_xy, NAMED.capacity, task_names=("a", "b\u202e")
        )


def scenario_json(tasks: str, robots: str = '{"x": 1, "y": 1, "capacity": 1}') -> str:
    """A scenario file without a map; every task is due at 9."""
    return f'{{"format": "mrta_zoo.scenario", "version": 1, "tasks": [{tasks}], "robots": [{robots}]}}'.replace(
        "DUE", '"x": 1, "y": 1, "deadline": 9, "workload"'
    )


@pytest.mark.parametrize("ids", [("01", "00"), ("000", "001"), ("01", "1"), ("2", "1")])
def test_texts_that_are_no_numbering_are_names_in_every_format(tmp_path: Path, ids: tuple[str, str]) -> None:
    """ "01" is no number 1: its zero would be lost."""
    json, table, taptc = (tmp_path / f"cas.{suffix}" for suffix in ("json", "csv", "txt"))
    json.write_text(scenario_json(", ".join(f'{{"id": "{each}", DUE: {n}}}' for n, each in enumerate(ids))))
    rows = "".join(f"task,{each},1,1,9,{n},\n" for n, each in enumerate(ids))
    table.write_text(f"kind,id,x,y,deadline,workload,capacity\n{rows}robot,,1,1,,,1\n")
    taptc.write_text("1 2 9 9\n" + "".join(f"{each} 1 1 {n} 9\n" for n, each in enumerate(ids)))
    (tmp_path / "bots.txt").write_text("1 9 9\n0 1 1 1\n")
    for scenario in (read_scenario(json), read_scenario(table), read_scenario(taptc, tmp_path / "bots.txt")):
        assert scenario.task_names == ids
        assert scenario.workload.tolist() == [0, 1]
        write_taptc(scenario, tmp_path / "again.txt", tmp_path / "bots2.txt")
        assert read_scenario(tmp_path / "again.txt", tmp_path / "bots2.txt").task_names == ids


def test_ids_number_tasks_in_every_format(tmp_path: Path) -> None:
    json, table = tmp_path / "cas.json", tmp_path / "cas.csv"
    json.write_text(scenario_json('{"id": 1, DUE: 7}, {"id": "0", DUE: 5}'))
    table.write_text("Kind,ID,x,y,Deadline,workload,capacity\ntask,1,1,1,9,7,\ntask,0,1,1,9,5,\nrobot,,1,1,,,1\n")
    for scenario in (read_scenario(json), read_scenario(table)):
        assert scenario.task_names == ()
        assert scenario.workload.tolist() == [5, 7]
        assert scenario.map_size == (1, 1)  # no map is named: the smallest that holds all


def test_accents_may_be_written_in_two_ways(tmp_path: Path) -> None:
    path = tmp_path / "cas.json"
    path.write_text(scenario_json('{"name": "Cafe\\u0301", DUE: 1}'))
    assert read_scenario(path).task_names == ("Caf\u00e9",)
    path.write_text(scenario_json('{"name": "Cafe\\u0301", DUE: 1}, {"name": "Caf\\u00e9", DUE: 1}'))
    with pytest.raises(ScenarioError, match=r"tasks\[1\]: task name 'Café' was already used in tasks\[0\]"):
        read_scenario(path)


@pytest.mark.parametrize("name", ["\\u202eA", "  ", "a\\tb"])
def test_names_that_nobody_could_read_are_refused_where_they_stand(tmp_path: Path, name: str) -> None:
    path = tmp_path / "cas.json"
    path.write_text(scenario_json(f'{{"name": "{name}", DUE: 1}}'))
    with pytest.raises(ScenarioError, match=r"cas\.json: tasks\[0\]: the task's name is '.*'; expected text without"):
        read_scenario(path)
