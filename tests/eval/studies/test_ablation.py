"""``mrta-zoo ablate``: variants differ in one thing; a study killed and resumed is the same study."""

from __future__ import annotations

import csv
import shlex
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest
from command_line import changed

from mrta_zoo.cli.main import main
from mrta_zoo.eval.studies.ablation import CAPAM, QUESTIONS, REFERENCE, ROBOTS, USUAL, ablation, all_arms
from mrta_zoo.eval.studies.held_out import HeldOut
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.scenarios import draw_input

TINY = shlex.split(
    "--only encoder,moments --updates 2 --paper-updates 4 --scenarios 2 --samples 2 --tasks 6 --held-out 2 --seeds 2"
)


def differences(one: TrainConfig, other: TrainConfig) -> set[str]:
    """The fields, those of the network included, in which two configurations differ."""
    mine, theirs = ({**asdict(config), **asdict(config.network)} for config in (one, other))
    return {name for name in mine if mine[name] != theirs[name]} - {"network"}


def test_variants_differ_in_one_thing_from_what_they_are_compared_with() -> None:
    variants = all_arms(USUAL, 600)
    allowed = {
        "encoder": {"encoder"}, "moments": {"moments"}, "plus-encoder": {"encoder"}, "baseline": {"baseline"},
        "decoder": {"decoder", "decision_layers"}, "mask-rule": {"mask_rule"}, "distribution": {"generator"},
    }  # fmt: skip
    for question in QUESTIONS.values():
        for name in question.others:
            found = differences(variants[name].config, variants[question.reference].config)
            extra = {"layers"} if name == "am" else set()  # AM as the paper has it: three layers
            assert found - extra <= allowed[question.name], name
            assert len(found - extra) == 1, name
    assert variants[CAPAM].config.network.decoder == "attention"
    assert variants[REFERENCE].config.network.decoder == "candidates"
    design = ablation(list(QUESTIONS), 2, USUAL, 600, 2)
    assert set(design.arms) == set(variants)
    runs = {(run.variant, run.config.seed): run.distributions for run in design.runs(Path("out"))}
    assert len(runs) == 2 * len(variants)
    assert (runs[REFERENCE, 1], runs[CAPAM, 0]) == (("taptc", "uniform"), ("taptc",))


def test_every_field_of_the_budget_is_a_setting() -> None:
    arms = all_arms(replace(USUAL, updates=7, scenarios=3, samples=4, tasks=11), paper_updates=9)
    config = arms[CAPAM].config
    assert (config.updates, config.scenarios, config.samples, config.tasks) == (9, 3, 4, (11,))
    assert arms["paper-decoder"].config.updates == arms[REFERENCE].config.updates == 7


def test_held_out_scenarios_are_none_of_those_trained_on() -> None:
    few, many = HeldOut(6, 2, ROBOTS).scenarios("taptc", 2), HeldOut(6, 4, ROBOTS).scenarios("taptc", 2)
    assert [each.name for each in many] == [f"taptc-a2-{index:03d}" for index in range(4)]
    for one, other in zip(few, many, strict=False):
        assert np.array_equal(one.task_xy, other.task_xy)
    config = all_arms(replace(USUAL, tasks=6), 600)[CAPAM].config
    seen = {
        xy.tobytes()
        for update in range(50)
        for xy in draw_input(config, TaptcGenerator((6, 6), (2, 2)), update).scenarios.task_xy.numpy()
    }
    assert not seen & {each.task_xy.tobytes() for each in many}
    uniform = HeldOut(6, 2, ROBOTS).scenarios("uniform", 2)
    assert not np.array_equal(uniform[0].task_xy, few[0].task_xy)


@pytest.fixture(scope="module")
def straight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study that nothing interrupted, in this process."""
    out = tmp_path_factory.mktemp("ablation") / "straight"
    assert main(["ablate", "--out", str(out), *changed(TINY, "--workers", "1")]) == 0
    return out


def test_the_study_leaves_rows_report_and_pictures(straight: Path) -> None:
    assert {path.name for path in straight.glob("[!.]*")} == {
        "manifest.json", "sessions.csv", "runs", "rows.csv", "report.md", "report.html", "claims.csv", "completion.csv",
        *(f"{name}.{suffix}" for name in ("differences", "learning_curves") for suffix in ("png", "svg", "csv")),
    }  # fmt: skip
    with (straight / "rows.csv").open(newline="") as lines:
        rows = list(csv.DictReader(lines))
    # 6 variants x 2 seeds x 3 numbers of robots x 2 scenarios.
    assert len(rows) == 6 * 2 * 3 * 2
    assert list(rows[0]) == ["variant", "seed", "distribution", "robots", "scenario", "completed", "tasks"]
    assert {row["tasks"] for row in rows} == {"6"}
    report = (straight / "report.md").read_text(encoding="utf-8")
    for words in (
        "CapAM over AM",
        "P ≥ 2 over P = 1",
        "The gap grows with tasks per robot",
        "mrta-zoo ablate --out DIR",
    ):
        assert words in report
    with (straight / "completion.csv").open(newline="") as lines:
        means = {line["arm"]: line["percent"] for line in csv.DictReader(lines) if line["robots"] == "mean"}
    mine = [row for row in rows if row["variant"] == "capam"]
    # Each number of robots has as many scenarios, so that the mean of means is the mean.
    assert float(means["capam"]) == pytest.approx(100 * sum(int(row["completed"]) for row in mine) / (6 * len(mine)))
    assert list(means) == ["capam", "am-1", "am", "capam-none", "capam-p2", "capam-p1", "nearest"]


def test_a_finished_study_is_not_repeated(straight: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = {path: path.stat().st_mtime_ns for path in (straight / "runs").rglob("*")}
    report = (straight / "report.md").read_bytes()
    assert main(["ablate", "--out", str(straight), *TINY]) == 0
    assert {path: path.stat().st_mtime_ns for path in (straight / "runs").rglob("*")} == before
    assert (straight / "report.md").read_bytes() == report
    assert "trained" not in capsys.readouterr().err


def test_killed_and_resumed_in_processes_it_gives_the_same_rows(straight: Path, tmp_path: Path) -> None:
    out = tmp_path / "killed"
    arguments = ["ablate", "--out", str(out), *changed(TINY, "--only", "moments", "--workers", "2")]
    process = subprocess.Popen(
        [sys.executable, "-m", "mrta_zoo", *arguments], stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL
    )
    try:
        until = time.monotonic() + 180
        while not (out / "rows.csv").exists() and time.monotonic() < until:
            time.sleep(0.01)
    finally:
        process.kill()
    assert process.wait() == -signal.SIGKILL
    done = (out / "rows.csv").read_text().count("\n") - 1
    assert 1 <= done < 6 * 3 * 2  # of 6 runs with 3 numbers of robots and 2 scenarios
    time.sleep(0.5)  # its processes end with it
    # A run that a kill has left before its first checkpoint, and one before its configuration.
    (out / "runs" / "capam-p1-seed1" / "checkpoints").mkdir(parents=True, exist_ok=True)
    assert main([*arguments[:-1], "1"]) == 0
    for name in ("rows.csv", "completion.csv", "learning_curves.csv"):
        heading, *lines = (straight / name).read_text(encoding="utf-8").splitlines()
        mine = [line for line in lines if line.startswith(("capam,", "capam-p1,", "capam-p2,", "nearest,"))]
        assert len(mine) > 1
        assert (out / name).read_text(encoding="utf-8").splitlines() == [heading, *mine]


def fails(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """Run a command that ends with one sentence; that sentence."""
    capsys.readouterr()
    assert main(["ablate", *arguments]) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ")
    assert error.count("\n") == 1
    return error


@pytest.mark.parametrize(
    ("flags", "sentence"),
    [
        (["--paper-updates", "0"], "paper_updates is 0; expected a whole number >= 1"),
        (["--only", "colour"], "there is no question 'colour'; expected some of encoder, moments"),
        (["--only", ","], "only is ','; expected questions separated by commas"),
        (["--only", "encoder,encoder"], "encoder is named twice"),
    ],
)
def test_what_cannot_be_done_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], flags: list[str], sentence: str
) -> None:
    assert sentence in fails(capsys, "--out", str(tmp_path / "out"), *flags)
    assert not (tmp_path / "out").exists()


def test_a_failure_in_a_process_is_said_in_a_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    arguments = ["--out", str(out), *changed(TINY, "--only", "moments", "--seeds", "1"), "--workers"]
    assert main(["ablate", *arguments, "1"]) == 0
    rows, damaged = out / "rows.csv", out / "runs" / "capam-seed0"
    whole = rows.read_text()
    network = damaged / "checkpoints" / "00000004" / "network.safetensors"
    rows.write_text("".join(line for line in whole.splitlines(keepends=True) if not line.startswith("capam,")))
    network.write_bytes(b"garbage")
    assert "network.safetensors: not a readable safetensors file" in fails(capsys, *arguments, "2")
    rows.write_text("variant\n")
    assert "line 1: the columns are ['variant']" in fails(capsys, *arguments, "1")
    first = whole.splitlines()[1]
    for change, sentence in (
        (",7,6", "line 2: completed is 7; expected 0 to 6, the number of tasks"),
        (",0,5", "has a row for variant capam, seed 0, distribution taptc, robots 1, scenario 0, tasks 5, which this"),
    ):
        rows.write_text(whole.replace(first, first.rsplit(",", 2)[0] + change))
        assert sentence in fails(capsys, *arguments, "1")
    rows.write_text(whole)
    (damaged / "policy.safetensors").unlink()
    rows.write_text(whole.replace(first + "\n", ""))  # a run whose rows are not whole is compared again
    network.unlink()
    assert f"to have this run done again, delete {damaged} and repeat" in fails(capsys, *arguments, "1")
    shutil.rmtree(damaged)
    assert main(["ablate", *arguments, "1"]) == 0
    assert rows.read_text() == whole
