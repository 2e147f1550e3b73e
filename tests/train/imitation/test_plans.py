"""Making plans stops at once when it is interrupted, and leaves nobody at work."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import NoReturn

import pytest

from mrta_zoo.errors import ConfigError
from mrta_zoo.train.config import TrainConfig
from mrta_zoo.train.imitation import experts, plans
from mrta_zoo.train.presets import PRESETS

SLOW = '''
import os
import time


def make_shard(config, first, folder):
    """Notes who makes which file when, and takes its time over the file."""
    (folder / f"{first:07d}-{os.getpid()}.begun").touch()
    time.sleep(0.4)
    (folder / f"{first:07d}.done").touch()
'''

RUN = """
import sys

import slow

from mrta_zoo.train.imitation import plans
from mrta_zoo.cli.main import main

if __name__ == "__main__":
    plans.make_shard = slow.make_shard
    sys.exit(main(sys.argv[1:]))
"""


def alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def until(condition: object, seconds: float) -> bool:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():  # type: ignore[operator]
            return True
        time.sleep(0.05)
    return False


def dies(config: object, first: int, folder: Path) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.skipif(os.name != "posix", reason="sends POSIX signals")
def test_a_process_that_dies_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plans, "make_shard", dies)
    with pytest.raises(ConfigError, match="a worker process was killed"):
        plans.make_plans(PRESETS["capam-plus"], tmp_path / "plans")


def test_the_search_is_compiled_for_the_processes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """So that it is said where that cannot be kept: other processes than the first leave it to that."""
    pytest.importorskip("numba")
    begun: list[str] = []
    monkeypatch.setattr("mrta_zoo.policies.classical.local_search.eils.compile_once", lambda: begun.append("compiling"))

    def pool(_: int) -> NoReturn:
        begun.append("processes")
        raise KeyboardInterrupt

    monkeypatch.setattr(plans, "pool_of", pool)
    with pytest.raises(KeyboardInterrupt):
        plans.make_plans(PRESETS["capam-plus"], tmp_path / "plans")
    assert begun == ["compiling", "processes"]


@pytest.mark.skipif(os.name != "posix", reason="sends POSIX signals")
@pytest.mark.usefixtures("signals_heard")
def test_an_interrupt_ends_it_at_once(tmp_path: Path) -> None:
    (tmp_path / "slow.py").write_text(SLOW)
    (tmp_path / "run.py").write_text(RUN)
    flags = ["--preset", "capam-plus", "--imitation-plans", "20000", "--prepare", "--out", "out"]
    process = subprocess.Popen(
        [sys.executable, "run.py", "train", *flags], cwd=tmp_path, stderr=subprocess.PIPE, text=True,
        start_new_session=True,
    )  # fmt: skip
    folder = tmp_path / "out" / "plans"
    try:
        assert until(lambda: len(list(folder.glob("*.done"))) >= 3, 90), "it begins"
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does
        _, said = process.communicate(timeout=20)
        assert process.returncode == 130, said
        assert "Traceback" not in said
        assert "go on with: mrta-zoo train --out out --resume --prepare\n" in said
        (worker,) = {int(each.stem.split("-")[1]) for each in folder.glob("*.begun")}
        assert until(lambda: not alive(worker), 5), "nobody is left"
        assert len(list(folder.glob("*.begun"))) < 12, "of 40"
    finally:
        with contextlib.suppress(ProcessLookupError):  # all of them have ended
            os.killpg(process.pid, signal.SIGKILL)


def test_plans_that_are_there_are_not_made_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(experts, "SHARD", 4)
    config = TrainConfig(
        tasks=(5,), reference_tasks=5, max_robots=2, imitation_updates=1, imitation_plans=4, imitation_batch=2
    )
    made = experts.make_shard(config, 0, tmp_path)
    monkeypatch.setattr(plans, "pool_of", None)  # whoever wants to make plans fails
    got = plans.make_plans(config, tmp_path)
    assert made == tmp_path / "0000000.npz"
    assert [plan.scenario for plan in got] == [experts.expert_scenario(config, number) for number in range(4)]
