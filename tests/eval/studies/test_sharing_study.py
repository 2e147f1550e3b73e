"""``mrta-zoo sharing``: the ways of sharing differ in nothing else; a study interrupted and resumed is the same."""

from __future__ import annotations

import csv
import math
import shlex
import shutil
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
import torch
from command_line import changed

from mrta_zoo.cli.main import main
from mrta_zoo.eval.studies.choices import Questionnaire, compared, divergence, members
from mrta_zoo.eval.studies.sharing import MOST, QUESTIONS, TRAINED_ROBOTS, USUAL, all_arms, sharing
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.policies.neural.capam.config import NetworkConfig
from mrta_zoo.policies.neural.sharing import build_network

TINY = shlex.split("--updates 2 --scenarios 4 --samples 2 --tasks 6 --held-out 2 --seeds 2 --workers 1")


def lines(file: Path) -> list[dict[str, str]]:
    with file.open(newline="", encoding="utf-8") as text:
        return list(csv.DictReader(text))


def test_ways_of_sharing_differ_in_nothing_else() -> None:
    arms = all_arms(USUAL)
    assert {name: arm.config.scenarios for name, arm in arms.items()} == {
        "shared": 12, "by-capacity": 12, "independent": 12,
        # 12 / 4 for one network; 12 * 2/4 for two.
        "shared-fewer": 3, "by-capacity-fewer": 6,
    }  # fmt: skip
    shared = asdict(arms["shared"].config)
    for arm in arms.values():
        assert {name for name, value in asdict(arm.config).items() if value != shared[name]} <= {"sharing", "scenarios"}
    # Episodes a network are equal where decisions are to be, and episodes where they are to be.
    for question, measure in (("episodes", lambda arm: arm.episodes), ("decisions", lambda a: a.episodes / a.networks)):
        assert len({measure(arms[name]) for name in QUESTIONS[question].arms}) == 1
    design = sharing(["decisions"], 1, USUAL, 2)
    assert list(design.arms) == ["shared-fewer", "by-capacity-fewer", "independent"]
    assert [arm.networks for arm in design.arms.values()] == [1, 2, MOST]
    assert TRAINED_ROBOTS[-1] == MOST
    runs = {run.variant: run.held_out.robots for run in design.runs(Path("out"))}
    assert list(runs) == ["independent", "by-capacity-fewer", "shared-fewer"]  # what takes longest first
    assert (runs["independent"], runs["shared-fewer"]) == ((1, 2, 3, 4), (1, 2, 3, 4, 6, 8))


def test_divergence_by_hand() -> None:
    # Nothing in common: 1 bit. Equal: 0. (1, 0) and (1/2, 1/2): the mean (3/4, 1/4) has entropy
    # 0.75 log2(4/3) + 0.25 log2(4) = 0.8113, the two have 0 and 1: 0.8113 - 0.5 = 0.3113.
    one = torch.tensor([[1.0, 0.0], [0.3, 0.7], [1.0, 0.0]])
    other = torch.tensor([[0.0, 1.0], [0.3, 0.7], [0.5, 0.5]])
    by_hand = [1.0, 0.0, 0.75 * math.log2(4 / 3) + 0.25 * 2 - 0.5]
    assert divergence(one, other).tolist() == pytest.approx(by_hand, abs=1e-6)
    mean = sum(by_hand) / 3
    # The likeliest tasks differ in the first decision alone; argmax of a tie is the first.
    assert compared([(one, other), (one, one)]) == pytest.approx(
        {"pairs": 2, "decisions": 3, "divergence_bits": mean / 2, "least": 0, "most": mean, "disagreement": 1 / 3 / 2},
        abs=1e-6,
    )


def test_networks_are_asked_about_the_same_moments() -> None:
    generator = TaptcGenerator(tasks=(8, 8), robots=(2, 3))
    scenarios = [generator(np.random.default_rng(seed)) for seed in range(3)]
    asked = Questionnaire(scenarios)
    config = NetworkConfig(embedding=16, heads=2)
    several = members(build_network(config, "independent", 3, seed=0))
    answers = [asked.answers(network) for network in several]
    assert len(answers) == 3
    for answer in answers:
        assert answer.shape == answers[0].shape
        assert answer.sum(-1).allclose(torch.ones(len(answer)))
        assert torch.equal(answer > 0, answers[0] > 0)  # the same tasks may be chosen
    assert ((answers[0] > 0).sum(-1) >= 2).all()
    assert torch.equal(asked.answers(several[0]), answers[0])
    assert len(members(build_network(config, "shared", 3, seed=0))) == 1


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("sharing") / "study"
    assert main(["sharing", "--out", str(out), *TINY]) == 0
    return out


def test_the_study_leaves_rows_report_and_pictures(study: Path) -> None:
    assert {path.name for path in study.glob("[!.]*")} == {
        "manifest.json", "sessions.csv", "runs", "rows.csv", "report.md", "report.html",
        "completion.csv", "choices.csv", "costs.csv",
        *(f"{name}.{suffix}" for name in ("differences", "learning_curves") for suffix in ("png", "svg", "csv")),
    }  # fmt: skip
    rows = lines(study / "rows.csv")
    # 4 arms that serve 1, 2, 3, 4, 6 and 8 robots, and independent networks, which serve 1 to 4; 2 seeds, 2 scenarios.
    assert len(rows) == (4 * 6 + 4) * 2 * 2
    assert {row["robots"] for row in rows if row["variant"] == "independent"} == {"1", "2", "3", "4"}
    report = (study / "report.md").read_text(encoding="utf-8")
    for words in ("no network", "mrta-zoo sharing --out DIR --only episodes,decisions --seeds 2 --updates 2"):
        assert words in report
    costs = {line["arm"]: line for line in lines(study / "costs.csv")}
    one = int(costs["shared"]["parameters"])
    assert [int(costs[arm]["parameters"]) // one for arm in ("by-capacity", "independent")] == [2, 4]
    # 2 updates x 4 scenarios x 2 samples = 16 episodes, a quarter of them for "shared-fewer".
    assert [costs[arm]["episodes"] for arm in ("independent", "shared-fewer")] == ["16", "4"]
    completion = {(line["arm"], line["robots"]): line for line in lines(study / "completion.csv")}
    mine = [int(row["completed"]) for row in rows if (row["variant"], row["robots"]) == ("shared", "3")]
    # 2 runs x 2 scenarios with 6 tasks each.
    assert float(completion["shared", "3"]["percent"]) == pytest.approx(100 * sum(mine) / 24)
    for question in QUESTIONS:  # with two comparisons each, so that the lesser p counts twice
        found = [
            line
            for line in lines(study / "differences.csv")
            if (line["question"], line["robots"]) == (question, "mean")
        ]
        p, adjusted = (min(float(line[column]) for line in found) for column in ("p", "adjusted_p"))
        assert adjusted == pytest.approx(min(1, 2 * p))
    choices = {(line["arm"], line["compared"]): int(line["pairs"]) for line in lines(study / "choices.csv")}
    again = "one network, runs of other seeds"
    # Pairs of 4 networks in 2 runs: 6 x 2; each of 4 networks in 2 runs: 4.
    assert choices["independent", "networks of one run"] == 12
    assert (choices["independent", again], choices["by-capacity", again], choices["shared", again]) == (4, 2, 1)
    assert ("shared", "networks of one run") not in choices


def test_interrupted_and_resumed_it_gives_the_same(study: Path, tmp_path: Path) -> None:
    out = tmp_path / "interrupted"
    shutil.copytree(study, out, ignore=shutil.ignore_patterns(".lock"))
    rows = (out / "rows.csv").read_text().splitlines(keepends=True)
    (out / "rows.csv").write_text("".join(row for row in rows if not row.startswith("shared,0")))  # not yet compared
    shutil.rmtree(out / "runs" / "independent-seed1")  # lost
    assert main(["sharing", "--out", str(out), *TINY]) == 0
    for name in ("rows.csv", "differences.csv", "completion.csv", "choices.csv", "learning_curves.csv"):
        assert (out / name).read_bytes() == (study / name).read_bytes()


def test_one_question_and_one_seed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "one"
    assert main(["sharing", "--out", str(out), *changed(TINY, "--only", "decisions", "--seeds", "1")]) == 0
    assert {path.name for path in (out / "runs").iterdir()} == {
        "independent-seed0", "shared-fewer-seed0", "by-capacity-fewer-seed0",
    }  # fmt: skip
    assert "(too few)" in capsys.readouterr().out  # no intervals
    assert main(["sharing", "--out", str(out), *TINY]) == 2
    assert "only was decisions, now it is episodes,decisions" in capsys.readouterr().err


def test_where_nothing_could_be_chosen_nothing_is_compared(tmp_path: Path) -> None:
    # With one task a mission no robot ever has two to choose from.
    out = tmp_path / "one task"
    tiny = changed(TINY, "--only", "episodes", "--seeds", "1", "--tasks", "1")
    assert main(["sharing", "--out", str(out), *tiny]) == 0
    report = (out / "report.md").read_text(encoding="utf-8")
    assert "nan" not in report
    assert "How differently they choose" not in report


def test_damaged_histories_are_told_in_a_sentence(
    study: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "damaged"
    shutil.copytree(study, out, ignore=shutil.ignore_patterns(".lock"))
    history = out / "runs" / "shared-seed0" / "history.csv"
    history.write_bytes(history.read_bytes()[:40])  # ends in the header
    assert main(["sharing", "--out", str(out), *TINY]) == 2
    error = capsys.readouterr().err
    assert "not a run's history.csv (it has no rows); to have this run done again, delete" in error
    assert error.count("\n") == 1


def test_intervals_of_shares_end_at_none_and_all(study: Path) -> None:
    # Two runs on two scenarios: Student's intervals alone would reach far beyond.
    for line in lines(study / "completion.csv"):
        if line["low"]:
            assert 0 <= float(line["low"]) <= float(line["percent"]) <= float(line["high"]) <= 100
