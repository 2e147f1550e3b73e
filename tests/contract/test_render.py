"""Rendering: what the text says, that the picture shows the mission, and what is needed for it."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from factories import play, small_scenario

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.mission import Mission
from mrta_zoo.render import describe
from mrta_zoo.render.whereabouts import whereabouts

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
        "two by two   time 0.0   2 tasks: 1 active, 1 assigned, 0 completed, 0 missed",
        "robot           x         y  taken  doing",
        "robot_0      0.00      0.00      1  on its way to task 0, until 13.0",
        "robot_1      0.00      0.00      0  chooses now",
    ]
    env.step(1)
    assert env.render().splitlines() == [
        "two by two   time 13.0   2 tasks: 0 active, 0 assigned, 2 completed, 0 missed   mission over",
        "robot           x         y  taken  doing",
        "robot_0     10.00      0.00      1  is retired",
        "robot_1      0.00      2.00      1  is retired",
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


def test_human_prints_by_itself(capsys):
    env = mrta_v0.env(scenario=SCENARIO, render_mode="human")
    env.reset()
    env.step(0)
    assert env.render() is None
    printed = capsys.readouterr().out
    assert printed.count("two by two   time 0.0") == 3  # at the reset, after the step, when asked
    assert printed.endswith(describe(env.unwrapped.mission) + "\n")


@pytest.mark.parametrize("make", [mrta_v0.env, mrta_v0.parallel_env])
def test_without_a_mode_it_warns(make):
    env = make(scenario=SCENARIO)
    env.reset()
    with pytest.warns(UserWarning, match="without specifying any render mode"):
        assert env.render() is None


def test_picture():
    env = mrta_v0.env(scenario=small_scenario(0), render_mode="rgb_array")
    env.reset()
    start = env.render()
    assert start.dtype == np.uint8
    assert start.shape == (720, 1040, 3)
    assert np.array_equal(env.render(), start)  # nothing has happened
    green = np.array([0x3F, 0xA3, 0x5B])
    column = 704  # the legend, which shows every colour, begins here
    assert not (start[:, :column] == green).all(-1).any()
    play(env)
    end = env.render()
    done = int((env.unwrapped.mission.status == 2).sum())
    assert done > 0
    assert (end[:, :column] == green).all(-1).sum() > 40  # the dots of completed tasks, some under robots


@pytest.mark.parametrize(("tasks", "robots", "size"), [(1, 1, (10, 10)), (300, 60, (200, 20)), (5, 11, (1, 30))])
def test_picture_at_other_sizes(tasks, robots, size):
    rng = np.random.default_rng(0)
    scenario = Scenario(
        task_xy=rng.random((tasks, 2)) * size, deadline=rng.uniform(50, 99, tasks), workload=rng.random(tasks),
        robot_xy=rng.random((robots, 2)) * size, capacity=np.ones(robots), map_size=size,
    )  # fmt: skip
    env = mrta_v0.parallel_env(scenario=scenario, render_mode="rgb_array")
    env.reset()
    assert env.render().shape == (720, 1040, 3)


def test_without_matplotlib_the_error_names_the_extra():
    code = """
import sys
sys.modules["matplotlib"] = None
from mrta_zoo import mrta_v0
from mrta_zoo.errors import MissingExtraError
env = mrta_v0.env(render_mode="rgb_array")
env.reset(seed=0)
try:
    env.render()
except MissingExtraError as error:
    assert "mrta_zoo[plot]" in str(error)
else:
    raise SystemExit("no error")
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
