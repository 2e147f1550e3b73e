"""Files that cannot be opened, that never end, that are named badly, or that were damaged at random."""

import json
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from sentences import check_sentence
from valid_files import AGENTS, PLAN, SCENARIO, TABLE, TASKS

from mrta_zoo import Plan
from mrta_zoo.errors import MrtaError, PlanError, ScenarioError
from mrta_zoo.generators import TaptcGenerator
from mrta_zoo.io import read_cases, read_plan, read_scenario, write_plan, write_scenario


def test_agents_cannot_be_json(tmp_path: Path) -> None:
    (tmp_path / "cas.txt").write_text(TASKS)
    with pytest.raises(ScenarioError, match=r"bots\.json has the suffix '\.json'; expected a \.csv or TAPTC agent"):
        read_scenario(tmp_path / "cas.txt", tmp_path / "bots.json")


@pytest.mark.parametrize("suffix", [".txt", ".json", ".csv"])
def test_file_that_cannot_be_read(tmp_path: Path, suffix: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        read_scenario(tmp_path / f"missing{suffix}", tmp_path / "agents.txt")
    check_sentence(caught.value, f"missing{suffix}: there is no such file")
    (tmp_path / f"folder{suffix}").mkdir()
    with pytest.raises(ScenarioError) as caught:
        read_scenario(tmp_path / f"folder{suffix}")
    check_sentence(caught.value, f"folder{suffix} is a folder; expected a file")
    with pytest.raises(ScenarioError) as caught:
        read_scenario(f"nul\0l{suffix}")
    check_sentence(caught.value, f"nul\\0l{suffix} cannot be read")
    with pytest.raises(ScenarioError) as caught:
        read_scenario("x" * 300 + suffix)
    assert "cannot be read" in str(caught.value)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may read everything")
def test_no_permission(tmp_path: Path) -> None:
    path = tmp_path / "cas.json"
    path.write_text(SCENARIO)
    path.chmod(0)
    with pytest.raises(ScenarioError) as caught:
        read_scenario(path)
    check_sentence(caught.value, "cas.json: no permission")


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no endless file here")
def test_endless_file() -> None:
    with pytest.raises(ScenarioError) as caught:
        read_scenario("/dev/zero")
    check_sentence(caught.value, "/dev/zero is larger than 64 MiB")


TOKENS = (
    b"nan", b"-1", b"1e999", b"0x1", b"1_0", b"", b"\xff", b"\0", b'"', b"[", b"}", b"null", b"\n", b",",
    b"9" * 400, b"0", b"true", b"-", b"1e-400", b"\xc2\xa0", b"\r", b"\x1c", b"9999999", b"{}", b" ",
)  # fmt: skip


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """The file with one to three small damages of the kinds that editors, disks and scripts do."""
    for _ in range(rng.integers(1, 4)):
        kind = rng.integers(6)
        first, last = sorted(int(place) for place in rng.integers(0, len(data) + 1, 2))
        last = min(last, first + 40) if kind != 0 else last
        if kind == 0:
            data = data[:first] if rng.random() < 0.2 else data[:last] + data[last + 3 :]
        elif kind == 1:
            data = data[:first] + data[last:]
        elif kind == 2:
            data = data[:last] + data[first:last] + data[last:]
        elif kind == 3:
            data = data[:first] + TOKENS[rng.integers(len(TOKENS))] + data[first:]
        elif kind == 4:
            data = data[:first] + rng.bytes(2) + data[first + 2 :]
        else:
            words = data.split(b" ")
            words[rng.integers(len(words))] = TOKENS[rng.integers(len(TOKENS))]
            data = b" ".join(words)
    return data


MUTATIONS = int(os.environ.get("MRTA_ZOO_MUTATIONS", "250"))


@pytest.mark.parametrize("kind", ["cas.txt", "agent/cas.txt", "cas.csv", "cas.json", "plan.json", "reference.csv"])
def test_damaged_files_are_read_or_refused(tmp_path: Path, kind: str) -> None:
    """Set MRTA_ZOO_MUTATIONS for more of them."""
    rng = np.random.default_rng(len(kind))
    scenario = TaptcGenerator(tasks=(8, 8), robots=(3, 3), integer=False)(rng, name="cas")
    readers: dict[str, Callable[[], object]] = {
        "cas.txt": lambda: read_scenario(tmp_path / "cas.txt"),
        "agent/cas.txt": lambda: read_scenario(tmp_path / "cas.txt"),
        "cas.csv": lambda: read_scenario(tmp_path / "cas.csv"),
        "cas.json": lambda: read_scenario(tmp_path / "cas.json"),
        "plan.json": lambda: read_plan(tmp_path / "plan.json"),
        "reference.csv": lambda: read_cases(tmp_path, [].append),
    }
    if kind == "plan.json":
        write_plan(Plan.of([[0, 5, 1], [], [7, 3]], "cas", "nearest"), tmp_path / kind)
    elif kind == "reference.csv":
        write_scenario(scenario, tmp_path / "cas.json")
        (tmp_path / kind).write_text("case,tasks,robots,nearest,pyvrp\ncas,8,3,5,6\nother,100,2,30,40\n")
    else:
        write_scenario(scenario, tmp_path / Path(kind).name)
    original = (tmp_path / kind).read_bytes()
    refused = 0
    for _ in range(MUTATIONS):
        (tmp_path / kind).write_bytes(mutated(original, rng))
        try:
            readers[kind]()
        except MrtaError as error:
            check_sentence(error)
            refused += 1
    assert refused > MUTATIONS / 3
    (tmp_path / kind).write_bytes(original)
    assert readers[kind]() is not None


def test_scenario_fixture_is_valid(tmp_path: Path) -> None:
    """The malformed inputs above are one change away from files that can be read."""
    for name, content in (
        ("cas.txt", TASKS),
        ("cas.json", SCENARIO),
        ("cas.csv", TABLE),
        ("plan.json", PLAN),
    ):
        (tmp_path / name).write_text(content)
    (tmp_path / "bots.txt").write_text(AGENTS)
    assert read_scenario(tmp_path / "cas.txt", tmp_path / "bots.txt").num_tasks == 3
    assert read_scenario(tmp_path / "cas.json").num_tasks == 2
    assert read_scenario(tmp_path / "cas.csv").num_tasks == 2
    assert read_plan(tmp_path / "plan.json").routes == ((0, 2), (1,))
    assert json.loads(SCENARIO)["version"] == 1


def test_names_with_control_characters(tmp_path: Path) -> None:
    (tmp_path / "a\x1bb.csv").write_text(TABLE)
    with pytest.raises(ScenarioError, match=r"the scenario's name is 'a\\x1bb'; expected text without control"):
        read_scenario(tmp_path / "a\x1bb.csv")
    (tmp_path / "a\x1bb.csv").rename(tmp_path / "cas.csv")
    reference = tmp_path / "reference.csv"
    for text in ("case,tasks,robots,me\x1b\ncas,2,1,1\n", "case,tasks,robots,me\ncas\x1b,2,1,1\n"):
        reference.write_text(text)
        with pytest.raises(ScenarioError, match=r"reference\.csv, line .*\\x1b'; expected text without control"):
            read_cases(tmp_path)
    with pytest.raises(PlanError, match="method is 'a\\\\tb'; expected text without control characters"):
        write_plan(Plan.of([[0]], "cas", "a\tb"), tmp_path / "plan.json")
