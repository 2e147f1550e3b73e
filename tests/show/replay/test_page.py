"""The page as a file: self-contained, and safe with any name."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from factories import small_scenario

from mrta_zoo import Plan
from mrta_zoo.errors import ConfigError
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.show.replay import replay_page, write_replay
from mrta_zoo.show.replay.episode import episode_of
from mrta_zoo.show.replay.page import DocumentJson
from mrta_zoo.trace import Trace

SCENARIO = small_scenario(0, name='</script><b>&"$x')
TRACE = Trace.of_plan(SCENARIO, make_solver("nearest").solve(SCENARIO))


def data_of(page: str) -> DocumentJson:
    (text,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    return msgspec.json.decode(text, type=DocumentJson)


def test_it_holds_the_episodes() -> None:
    other = Trace.of_plan(SCENARIO, Plan.of([()] * 3))
    document = data_of(replay_page([TRACE, other]))
    assert document.episodes == [episode_of(TRACE), episode_of(other)]
    assert document.place.name == SCENARIO.name
    assert document.cost == "Eq. 1: the sum of finish / deadline over the tasks missed"
    assert [task[2] for task in document.place.tasks] == SCENARIO.deadline.tolist()


def test_it_shows_where_and_when_the_mission_is() -> None:
    far = (512000.0, 5403000.0)
    scenario = replace(
        SCENARIO, task_xy=SCENARIO.task_xy + far, robot_xy=SCENARIO.robot_xy + far, map_origin=far,
        deadline=[1e9, *SCENARIO.deadline[1:]], task_names=[*"abcdefg", "</script>"], robot_names=["x", "y", "$z$"],
    )  # fmt: skip
    trace = Trace.of_plan(scenario, make_solver("nearest").solve(scenario))
    place = data_of(replay_page([trace])).place
    assert (place.low, place.size) == (far, (50.0, 50.0))
    assert place.tasks[3][:2] == tuple(scenario.task_xy[3])
    assert place.end <= 2 * episode_of(trace).makespan
    assert place.horizon < 1000
    assert (place.task_names[-1], place.robot_names) == ("</script>", ["x", "y", "$z$"])
    assert data_of(replay_page([TRACE])).place.robot_names == ["robot 0", "robot 1", "robot 2"]


def test_it_loads_nothing() -> None:
    page = replay_page([TRACE])
    assert len(page) < 100_000
    assert not re.search(r"(src|href)=|@import|url\(|https?://(?!www\.w3\.org/2000/svg)", page)
    assert "<title>&lt;/script&gt;&lt;b&gt;&amp;&quot;$x</title>" in page
    assert page.count("</script>") == 6  # data, given, lettering, map, charts, replay


def test_a_large_one_stays_small(tmp_path: Path) -> None:
    scenario = UniformGenerator(tasks=(1000, 1000), robots=(70, 70))(np.random.default_rng(0))
    trace = Trace.of_plan(scenario, make_solver("nearest").solve(scenario))
    write_replay([trace], tmp_path / "page.html")
    assert (tmp_path / "page.html").stat().st_size < 1_500_000


def test_errors(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="there are 3 episodes to replay; expected one, or two"):
        replay_page([TRACE] * 3)
    elsewhere = small_scenario(1, name="other")
    with pytest.raises(ConfigError, match=r"different scenarios.*'other'; expected two of the same"):
        replay_page([TRACE, Trace(elsewhere, ())])
    with pytest.raises(ConfigError, match="cannot be written: no such file or directory"):
        write_replay([TRACE], tmp_path / "absent" / "page.html")
