"""The page as a file: self-contained, and safe with any name."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import msgspec
import numpy as np
import pytest
from factories import small_scenario

from mrta_zoo import Plan
from mrta_zoo.errors import ConfigError, MissingExtraError
from mrta_zoo.generators import UniformGenerator
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.replay import replay_page, write_replay
from mrta_zoo.replay.episode import episode_of
from mrta_zoo.replay.page import Document
from mrta_zoo.trace import Trace

SCENARIO = small_scenario(0, name='</script><b>&"$x')
TRACE = Trace.of_plan(SCENARIO, make_solver("nearest").solve(SCENARIO))


def data_of(page: str) -> Document:
    (text,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    return msgspec.json.decode(text, type=Document)


def test_it_holds_the_episodes() -> None:
    other = Trace.of_plan(SCENARIO, Plan.of([()] * 3))
    document = data_of(replay_page([TRACE, other]))
    assert document.episodes == [episode_of(TRACE), episode_of(other)]
    assert document.place.name == SCENARIO.name
    assert document.cost == "Eq. 1: the sum of finish / deadline over the tasks missed"
    assert [task[2] for task in document.place.tasks] == SCENARIO.deadline.tolist()


def test_it_loads_nothing() -> None:
    page = replay_page([TRACE])
    own = re.sub(r"<script>\s*/\*\*\s*\* plotly\.js.*?</script>", "", page, flags=re.DOTALL)
    assert len(own) < 0.1 * len(page)
    assert not re.search(r"(src|href)=|@import|url\(|https?://(?!www\.w3\.org/2000/svg)", own)
    assert "<title>&lt;/script&gt;&lt;b&gt;&amp;&quot;$x</title>" in own
    assert own.count("</script>") == 4  # data, map, charts, replay


def test_a_large_one_stays_small(tmp_path: Path) -> None:
    scenario = UniformGenerator(tasks=(1000, 1000), robots=(70, 70))(np.random.default_rng(0))
    trace = Trace.of_plan(scenario, make_solver("nearest").solve(scenario))
    write_replay([trace], tmp_path / "page.html")
    assert (tmp_path / "page.html").stat().st_size < 7_000_000  # two are less than 10 MB: half of one is Plotly


def test_errors(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ConfigError, match="there are 3 episodes to replay; expected one, or two"):
        replay_page([TRACE] * 3)
    elsewhere = small_scenario(1, name="other")
    with pytest.raises(ConfigError, match=r"different scenarios.*'other'; expected two of the same"):
        replay_page([TRACE, Trace(elsewhere, ())])
    with pytest.raises(ConfigError, match="cannot be written: no such file or directory"):
        write_replay([TRACE], tmp_path / "absent" / "page.html")
    monkeypatch.setitem(sys.modules, "plotly", None)
    with pytest.raises(MissingExtraError, match=r'needs plotly.*pip install "mrta_zoo\[replay\]"'):
        replay_page([TRACE])
