"""What is nearly certain, or nearly impossible, is not shown as 100.0 or 0.0."""

from __future__ import annotations

import io
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from factories import small_scenario
from rich.console import Console

from mrta_zoo.debug import Stepper, compare, record
from mrta_zoo.debug.comparison_report import report
from mrta_zoo.debug.percent import percent
from mrta_zoo.debug.screen import screen
from mrta_zoo.debug.session import Session
from mrta_zoo.env.observation import Observation
from mrta_zoo.io import read_trace, write_trace
from mrta_zoo.rules import MaskReason
from mrta_zoo.show.replay.episode import episode_of

SCENARIO = small_scenario(2, tasks=12, robots=3)


@pytest.mark.parametrize(
    ("probability", "text"),
    [
        (0.623, "62.3"), (0.0005, "0.1"), (0.9994, "99.9"), (0.99996, "99.9960"), (0.999979, "99.9979"),
        (1 - 1e-9, ">99.999"), (1.0, ">99.999"), (2.1e-5, "0.0021"), (3.4e-9, "3.4e-07"), (0.0, "<0.1"),
    ],
)  # fmt: skip
def test_texts(probability: float, text: str) -> None:
    assert percent(probability) == text


def test_the_only_choice_is_certain() -> None:
    assert (percent(1.0, only=True), percent(0.99998, only=True)) == ("100.0", "99.9980")


@dataclass
class Thought:
    action: int
    probabilities: npt.NDArray[np.float32]


class Certain:
    """All but certain: each choice is e**9 times as likely as the next; in float32 the first has all there is."""

    memoryless = True
    name = "certain"
    sign = 1

    def decide(self, observation: Observation) -> Thought:
        legal = np.flatnonzero(observation["action_mask"])[:: self.sign]
        probabilities = np.zeros(len(observation["action_mask"]), dtype=np.float32)
        weights = np.exp(-9.0 * np.arange(len(legal)))
        probabilities[legal] = weights / weights.sum()
        return Thought(int(legal[0]), probabilities)

    def act(self, observation: Observation, agent: str = "") -> int:
        return self.decide(observation).action


class Contrary(Certain):
    name = "contrary"
    sign = -1


def texts_of(what: object) -> list[str]:
    console = Console(file=io.StringIO(), width=200, markup=False, highlight=False)
    with console.capture() as captured:
        console.print(what)
    return captured.get().split()


def test_step() -> None:
    shown = texts_of(screen(Session(Stepper(SCENARIO, Certain())), 12, 200))
    # e**-9 = 1.23e-4, of which 0.012 % are left after division by 1 + e**-9 + …; then 1.5e-6 %, 1.9e-10 %
    assert {"99.988", "0.012", "1.5e-06", "1.9e-10"} <= set(shown)
    assert not {"100.0", "0.0000"} & set(shown)


def test_step_knows_all_probabilities_while_the_policy_is_at_hand() -> None:
    # The eleventh task in line has e**-90 = 8.19e-40 of the first one's, and that is 1 - e**-9.
    stepper = Stepper(small_scenario(2, tasks=30, robots=3), Certain())
    for _ in range(2):
        texts = [percent(each.probability) for each in stepper.outlook() if each.reason == MaskReason.CHOOSABLE]
        assert texts[10] == "8.2e-38"
        stepper.follow()
        assert len(stepper.trace().choices[0].probabilities) == 10  # as many as are written down
        stepper.back()
    unlikely = [each.task for each in stepper.outlook() if each.reason == MaskReason.CHOOSABLE][10]
    stepper.take(unlikely)
    assert stepper.trace().choices[0].probabilities[unlikely] == pytest.approx(8.194e-40, rel=1e-3)


def test_replay_and_traces(tmp_path: Path) -> None:
    trace = record(SCENARIO, Certain())
    write_trace(trace, tmp_path / "trace.json")
    read = read_trace(tmp_path / "trace.json")
    assert read.choices == trace.choices
    for decision in episode_of(read).decisions:
        chosen = [each for each in decision.candidates if each.reason == MaskReason.CHOOSABLE]
        texts = [each.percent for each in chosen]
        assert len(set(texts)) == len(texts)
        if len(texts) == 1:
            assert texts == ["100.0"]
        else:
            assert texts[:2] == ["99.988", "0.012"]


def test_compare() -> None:
    found = compare(SCENARIO, Certain(), Contrary())
    shown = [text for part in report(found, ("certain", "contrary"), 2) for text in texts_of(part)]
    assert shown.count("99.988") == 2
    assert "<0.1" not in shown
    assert not {"100.0", "0.0"} & set(shown[shown.index("part") :][:40])
