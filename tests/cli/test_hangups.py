"""Signals while a session is stepped: it is saved, and whoever handles them keeps them."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from command_line import script

from mrta_zoo.cli.main import main
from mrta_zoo.debug.session import Session
from mrta_zoo.io import read_trace


@pytest.mark.usefixtures("signals_heard")
@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGTERM])
def test_a_lost_connection_saves_the_session(mission: str, tmp_path: Path, number: int) -> None:
    session = tmp_path / "session.json"
    code = (
        "import os, sys; from mrta_zoo.cli.main import main; "
        "from mrta_zoo.debug.session import Session; do = Session.do; "
        f"Session.do = lambda self, line: os.kill(os.getpid(), {int(number)}) if line == 'q' else do(self, line); "
        "sys.exit(main(sys.argv[1:]))"
    )
    flags = ["--policy", "edf", "--session", str(session), "--script", script(tmp_path, "f 3\nq")]
    command = [sys.executable, "-c", code, "step", mission, *flags]
    done = subprocess.run(command, capture_output=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (128 + number, b"")
    assert read_trace(session).bookmark == 3


def handlers() -> list[object]:
    return [signal.getsignal(number) for number in sorted(signal.valid_signals())]


@pytest.mark.parametrize("flags", [[], ["--session"]], ids=["", "session"])
def test_signals_are_left_to_who_handles_them(
    flags: list[str], mission: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[object] = []
    do = Session.do

    def watch(session: Session, line: str) -> str:
        seen.append((signal.getsignal(signal.SIGTERM), signal.getsignal(signal.SIGINT)))
        return do(session, line)

    monkeypatch.setattr(Session, "do", watch)
    before = handlers()
    flags = [*flags, str(tmp_path / "session.json")] if flags else []
    arguments = ["step", mission, "--policy", "edf", *flags, "--script", script(tmp_path, "f 2")]
    assert main(arguments) == 0
    (terminate, interrupt) = seen.pop()
    assert interrupt is signal.getsignal(signal.SIGINT)
    assert (terminate is signal.SIG_DFL) == (not flags)  # there is a session to save, or not
    assert handlers() == before
    own = signal.signal(signal.SIGTERM, lambda *_: None)
    try:
        mine = signal.getsignal(signal.SIGTERM)
        assert main(arguments) == 0
        assert seen.pop()[0] is mine is signal.getsignal(signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, own)


@pytest.mark.parametrize("missing", ["", "SIGHUP"])
def test_in_a_thread_and_without_hangups(
    missing: str, mission: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if missing:  # as on Windows
        monkeypatch.delattr(signal, missing)
    codes: list[int] = []
    session = ["--session", str(tmp_path / "session.json"), "--script", script(tmp_path, "f 2")]

    def run() -> None:
        codes.append(main(["step", mission, "--policy", "edf", *session]))

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    run()
    assert codes == [0, 0]
    assert read_trace(tmp_path / "session.json").bookmark == 4
