"""Rendering as text, and where robots are between the places where they decide."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from factories import named_scenario

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.mission import Mission
from mrta_zoo.show.render import describe
from mrta_zoo.show.render.whereabouts import whereabouts

# robot_0 needs 10 / 1 + 6 / 2 = 13 for task 0, robot_1 2 / 2 = 1 for task 1 and then nothing is left for it.
SCENARIO = Scenario(
    task_xy=[[10, 0], [0, 2]], deadline=[20, 20], workload=[6, 0],
    robot_xy=[[0, 0], [0, 0]], capacity=[2, 1], speed=[1, 2], map_size=(10, 10), name="two by two",
)  # fmt: skip


def test_text():
    env = mrta_v0.env(scenario=SCENARIO, render_mode="ansi")
    env.reset()
    env.step(0)
    assert env.render().splitlines() == [
        "two by two   time 0.00   2 tasks: 1 active, 1 assigned, 0 completed, 0 missed",
        "due next: task 1 at 20.00",
        "robot           x         y  taken  last tasks      doing",
        "robot_0      0.00      0.00      1  -               on its way to task 0, until 13.00, deadline 20.00",
        "robot_1      0.00      0.00      0  -               chooses now",
    ]
    env.step(1)
    assert env.render().splitlines() == [
        "two by two   time 13.00   2 tasks: 0 active, 0 assigned, 2 completed, 0 missed   mission over",
        "robot           x         y  taken  last tasks      doing",
        "robot_0     10.00      0.00      1  0               is retired",
        "robot_1      0.00      2.00      1  1               is retired",
    ]


def test_whereabouts():
    mission = Mission(SCENARIO)
    mission.assign(0)
    places = {}
    for time in (0.0, 4.0, 10.0, 12.0):  # 10 time units of way, 3 of work
        mission.time = time
        here = whereabouts(mission, 0)
        places[time] = (here.x, here.y, here.doing)
    assert places == {
        0.0: (0.0, 0.0, "travelling"),
        4.0: (4.0, 0.0, "travelling"),
        10.0: (10.0, 0.0, "working"),
        12.0: (10.0, 0.0, "working"),
    }


def test_whereabouts_on_a_later_leg():
    # At speed 2 the robot is at task 0 from 2 / 2 = 1 on, done at 1 + 3 / 1 = 4, and at task 1 at 4 + 6 / 2 = 7.
    scenario = Scenario(
        task_xy=[[2, 0], [2, 6]], deadline=[20, 20], workload=[3, 1],
        robot_xy=[[0, 0]], capacity=[1], speed=[2], map_size=(10, 10),
    )  # fmt: skip
    mission = Mission(scenario)
    mission.assign(0)
    assert mission.time == 4.0
    mission.take(0, 1)
    mission.time = 6.0
    here = whereabouts(mission, 0)
    assert (here.x, here.y, here.doing) == (2.0, 4.0, "travelling")  # 2 time units at speed 2 from (2, 0)


@pytest.mark.parametrize("make", [mrta_v0.env, mrta_v0.parallel_env])
def test_without_a_mode_it_warns(make):
    env = make(scenario=SCENARIO)
    env.reset()
    with pytest.warns(UserWarning, match="without specifying any render mode"):
        assert env.render() is None


def test_text_of_many():
    # Five tasks at one robot's place, each a mere visit; then seven due, of which six are listed.
    scenario = Scenario(
        task_xy=np.zeros((12, 2)), deadline=np.arange(1, 13), workload=np.zeros(12),
        robot_xy=[[0, 0]], capacity=[1], map_size=(10, 10),
    )  # fmt: skip
    mission = Mission(scenario)
    for task in (4, 3, 2, 1, 0):
        mission.assign(task)
    _, due, _, robot = describe(mission).splitlines()
    assert due == "due next: " + ", ".join(f"task {task} at {task + 1}.00" for task in range(5, 11)) + ", …"
    assert robot.split()[3:] == ["5", "…", "2", "1", "0", "chooses", "now"]


def test_names_in_text():
    env = mrta_v0.env(scenario=named_scenario(), render_mode="ansi")
    env.reset()
    for action in (0, 2, 1):  # Ann's, that of Bob & Co, Ann's at 15
        env.step(action)
    assert env.render().splitlines() == [
        "named   time 45.0   5 tasks: 0 active, 0 assigned, 3 completed, 2 missed   mission over",
        "robot            x         y  taken  last tasks            doing",
        "Ann          30.00      0.00      2  valve-A, pump #3 <b>  is retired",
        "Bob & Co    100.00     30.00      1  =SUM(A1)              is retired",
    ]


def test_text_is_aligned_by_columns_of_the_terminal():
    scenario = replace(named_scenario(), robot_names=("弁弁弁", "Al"), task_names=())
    env = mrta_v0.env(scenario=scenario, render_mode="ansi")
    env.reset()
    rows = env.render().splitlines()[-2:]
    assert rows[0].startswith("弁弁弁      0.00 ")
    assert rows[1].startswith("Al        100.00 ")
