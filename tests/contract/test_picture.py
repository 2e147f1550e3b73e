"""Rendering as a picture, in a window and as a video."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pygame
import pytest
from factories import play, small_scenario
from pettingzoo.utils.wrappers import RecordVideo

from mrta_zoo import Scenario, mrta_v0
from mrta_zoo.errors import ConfigError
from mrta_zoo.mission import Mission
from mrta_zoo.show.palette import GROUND, blend, robot_colour
from mrta_zoo.show.render.canvas import as_array, fitted, text_width
from mrta_zoo.show.render.picture import draw
from mrta_zoo.show.render.window import Window

SIZE = (720, 1040, 3)
# A map of 636 x 636 pixels with its lower left corner at (40, 688): 6.36 pixels to the distance unit.
LEFT, BOTTOM, PIXELS = 40.0, 688.0, 6.36


def pixel(picture: np.ndarray, x: float, y: float) -> list[int]:
    """The colour at a place of a 100 x 100 map."""
    return picture[round(BOTTOM - PIXELS * y), round(LEFT + PIXELS * x)].tolist()


def rgb(colour: str) -> list[int]:
    return list(bytes.fromhex(colour[1:]))


@pytest.fixture
def mission() -> Mission:
    """At time 30 robot 1, which has done task 1, acts; robot 0 is half way along the 60 units to task 0."""
    scenario = Scenario(
        task_xy=[[80, 20], [50, 80], [20, 60], [90, 90]], deadline=[100, 100, 100, 25], workload=[0, 10, 0, 0],
        robot_xy=[[20, 20], [50, 60]], capacity=[1, 1], map_size=(100, 100),
    )  # fmt: skip
    mission = Mission(scenario)
    mission.assign(0)
    mission.assign(1)  # 20 units of way, 10 of work
    assert (mission.time, mission.actor) == (30.0, 1)
    return mission


def test_robots_are_where_they_are_at_this_moment(mission):
    picture = as_array(draw(mission))
    beside = 6 / PIXELS  # beside the number on the disc
    assert pixel(picture, 50 - beside, 20) == rgb(robot_colour(0))
    assert pixel(picture, 50 - beside, 80) == rgb(robot_colour(1))


def test_tasks_show_their_status(mission):
    picture = as_array(draw(mission))
    assert pixel(picture, 80, 20) == [255, 255, 255]  # assigned: a ring
    assert pixel(picture, 80 + 6.3 / PIXELS, 20) == rgb(robot_colour(0))  # in its robot's colour
    assert pixel(picture, 20, 60) not in ([255, 255, 255], [245, 246, 248])  # active: time left is a colour
    assert max(pixel(picture, 90, 90)) < 90  # missed: a black cross, smoothed
    mission.assign(2)
    assert mission.done
    beside = 6 / PIXELS
    assert pixel(as_array(draw(mission)), 80 - beside, 20) == rgb(robot_colour(0))  # the robot is there now


def test_time_left_is_a_colour():
    assert blend(("#000000", "#ff0000", "#ffffff"), 0.25) == "#800000"
    assert blend(("#000000", "#ffffff"), 7.0) == "#ffffff"


def test_a_mission_in_progress_changes_the_picture():
    env = mrta_v0.env(scenario=small_scenario(0), render_mode="rgb_array")
    env.reset()
    start = env.render()
    assert (start.dtype, start.shape) == (np.uint8, SIZE)
    assert np.array_equal(env.render(), start)  # nothing has happened
    play(env)
    assert not np.array_equal(env.render(), start)


@pytest.mark.parametrize(("tasks", "robots", "size"), [(1, 1, (10, 10)), (300, 120, (200, 20)), (5, 11, (1e-3, 30))])
def test_other_sizes(tasks, robots, size):
    rng = np.random.default_rng(0)
    scenario = Scenario(
        task_xy=rng.random((tasks, 2)) * size, deadline=rng.uniform(50, 99, tasks), workload=rng.random(tasks),
        robot_xy=rng.random((robots, 2)) * size, capacity=np.ones(robots), map_size=size,
    )  # fmt: skip
    env = mrta_v0.parallel_env(scenario=scenario, render_mode="rgb_array")
    env.reset()
    assert env.render().shape == SIZE


def test_human_opens_a_window_and_closes_it(monkeypatch):
    waited = []
    monkeypatch.setattr(pygame.time, "Clock", lambda: type("Clock", (), {"tick": lambda _, fps: waited.append(fps)})())
    env = mrta_v0.env(scenario=small_scenario(0), render_mode="human")
    env.reset()
    assert pygame.display.get_caption()[0] == "mrta_zoo"
    shown = as_array(pygame.display.get_surface())
    assert np.array_equal(shown, as_array(draw(env.unwrapped.mission)))
    env.step(int(env.observe(env.agent_selection)["action_mask"].argmax()))
    assert not np.array_equal(as_array(pygame.display.get_surface()), shown)
    assert env.render() is None
    assert waited == [env.metadata["render_fps"]] * 3  # at the reset, after the step, when asked
    for copied in (copy.deepcopy(env), pickle.loads(pickle.dumps(env))):
        assert copied.unwrapped.mission.time == env.unwrapped.mission.time
    env.close()
    assert not pygame.display.get_init()
    env.close()  # a second time does no harm
    env.render()  # and another window may be opened
    assert pygame.display.get_init()
    env.close()


def test_a_window_closed_by_its_user_stays_closed():
    window, picture = Window("test", fps=1000), pygame.Surface((40, 40))
    window.show(picture)
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    window.show(picture)
    assert not pygame.display.get_init()
    window.show(picture)
    assert not pygame.display.get_init()


def test_a_window_that_another_closed_opens_again(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    one, other = Window("one", fps=1000), Window("other", fps=1000)
    for window in (one, other):
        window.show(pygame.Surface((30, 20)))
    one.close()
    other.show(pygame.Surface((30, 20)))
    assert pygame.display.get_caption()[0] == "other"
    other.close()


@pytest.mark.parametrize("driver", ["x11", None])
def test_without_a_display_there_is_a_sentence(monkeypatch, driver):
    for name in ("SDL_VIDEODRIVER", "SDL_VIDEO_DRIVER", "DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    if driver:
        monkeypatch.setenv("SDL_VIDEODRIVER", driver)
        monkeypatch.setenv("DISPLAY", ":77")  # nobody is there
    env = mrta_v0.env(scenario=small_scenario(0), render_mode="human")
    with pytest.raises(ConfigError, match=r"cannot open a window.*expected a display.*'rgb_array' needs none"):
        env.reset()


@pytest.mark.filterwarnings("ignore::ResourceWarning")  # of the video writer
def test_record_video_makes_an_mp4(tmp_path):
    import imageio.v3 as imageio

    env = RecordVideo(mrta_v0.env(scenario=small_scenario(1), render_mode="rgb_array"), str(tmp_path / "videos"), fps=5)
    env.reset()
    first = env.render()
    decisions, _ = play(env)
    last = env.render()
    env.close()
    frames = imageio.imread(tmp_path / "videos" / "rl-video-episode-0.mp4", plugin="FFMPEG")
    steps = len(decisions) + len(env.possible_agents)  # and a None from each when all have terminated
    assert frames.shape == (1 + steps, *SIZE)
    for frame, picture in ((frames[0], first), (frames[-1], last)):  # up to what compression loses
        assert np.abs(frame.astype(int) - picture).mean() < 3.0
    assert np.abs(frames[0].astype(int) - last).mean() > np.abs(frames[-1].astype(int) - last).mean()


def test_without_pygame_the_error_names_the_extra():
    code = """
import sys
from dataclasses import replace
sys.modules["pygame"] = None
from mrta_zoo import mrta_v0
from mrta_zoo.errors import MissingExtraError
for mode in ("human", "rgb_array"):
    env = mrta_v0.env(render_mode=mode)
    try:
        env.reset(seed=0)
        env.render()
    except MissingExtraError as error:
        assert "mrta_zoo[render]" in str(error)
    else:
        raise SystemExit("no error")
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_names_in_pictures(mission):
    named = replace(mission.scenario, task_names=("A", "B" * 90, "<b>{0}", "弁"), robot_names=("Ann", "Bob"))
    twin = Mission(named)
    twin.assign(0)
    twin.assign(1)
    one, other = as_array(draw(mission)), as_array(draw(twin))
    assert (one[150:700, :690] != other[150:700, :690]).any(), "names on the map"
    assert (one[:, 700:] != other[:, 700:]).any(), "names in the column"
    assert (one[:, 1036:] == other[:, 1036:]).all(), "nothing runs over the edge"
    assert (one[:, 690:704] == other[:, 690:704]).all(), "nor into the column"


def test_as_much_of_a_name_as_there_is_room_for():
    assert fitted("valve-A", "3", 17, 100) == "valve-A"
    short = fitted("valve-A of the north hall", "3", 17, 100)
    assert short.startswith("valve-A…")
    assert short.endswith("h hall")
    assert text_width(short, 17) <= 100
    among = ["valve-A of the north hall", "valve-B of the north hall"]
    assert fitted(among[0], "3", 17, 80, among).startswith("valve-A")
    assert fitted("弁", "3", 17, 100) == "3"  # which the font lacks
    assert fitted("valve-A", "3", 17, 0) == "…"


@pytest.mark.parametrize("corner", [(-300.0, -60.0), (512_000.0, 5_403_000.0)])
def test_a_map_may_lie_anywhere(mission, corner):
    here, shift = mission.scenario, np.array(corner)
    moved = Mission(replace(here, task_xy=here.task_xy + shift, robot_xy=here.robot_xy + shift, map_origin=corner))
    moved.assign(0)
    moved.assign(1)
    one, other = (as_array(draw(each))[80:660, 80:660] for each in (mission, moved))
    assert (one != other).mean() < 0.01  # the grid's numbers are others
    picture = as_array(draw(moved))
    assert pixel(picture, 50 - 6 / PIXELS, 80) == rgb(robot_colour(1))


def test_a_mission_in_the_corner_of_a_large_map_fills_the_picture(mission):
    large = as_array(draw(Mission(replace(mission.scenario, map_size=(512010, 5403010)))))
    ink = (large[60:680, 40:676] != rgb(GROUND)).any(axis=2) & (large[60:680, 40:676] != 255).any(axis=2)
    rows, columns = np.flatnonzero(ink.any(axis=1)), np.flatnonzero(ink.any(axis=0))
    assert rows[-1] - rows[0] > 550
    assert columns[-1] - columns[0] > 550


@pytest.mark.parametrize("name", ["a\0b", "two\nlines", "工场", "long " * 40, "$x$ <b>"])
def test_any_name_is_drawn(mission, name):
    assert as_array(draw(Mission(replace(mission.scenario, name=name)))).shape == SIZE


def test_one_late_deadline_leaves_the_other_colours(mission):
    urgent = replace(mission.scenario, deadline=[100, 100, 100, 1e9])
    picture, place = as_array(draw(Mission(urgent))), (20.0, 60.0)
    assert pixel(picture, *place) not in ([255, 255, 255], [245, 246, 248])
    assert pixel(picture, *place)[1] > 80  # not as red as if it was due at once
