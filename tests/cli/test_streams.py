"""Commands leave standard output and error as they were."""

from __future__ import annotations

import io
import sys
import threading

import pytest
from command_line import stand_in

from mrta_zoo.cli.main import main


def test_streams_are_left_as_they_were(monkeypatch: pytest.MonkeyPatch) -> None:
    out = io.TextIOWrapper(io.BytesIO(), encoding="ascii", errors="strict")
    monkeypatch.setattr("sys.stdout", out)
    monkeypatch.setattr("sys.stderr", None)
    assert main(["solve", "é"]) == 2
    assert main(["--version"]) == 0
    assert (sys.stdout.errors, sys.stderr) == ("strict", None)


@pytest.mark.parametrize("closed", [False, True])
def test_streams_are_left_as_they_were_by_commands_in_several_threads(
    closed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first ends while the second, which found the streams as the first had made them, is still at work."""
    out = None if closed else io.TextIOWrapper(io.BytesIO(), encoding="ascii", errors="strict")
    monkeypatch.setattr("sys.stdout", out)
    first_begun, second_begun, first_over = (threading.Event() for _ in range(3))
    codes = {}

    def first(_: object) -> None:
        first_begun.set()
        assert second_begun.wait(10)

    def second(_: object) -> None:
        second_begun.set()
        assert first_over.wait(10)
        print("é")  # still fit for it
        sys.stdout.flush()

    for name, command in (("first", first), ("second", second)):
        stand_in(name, command, monkeypatch)
    threads = [
        threading.Thread(target=lambda name=name: codes.update({name: main([name])})) for name in ("first", "second")
    ]
    threads[0].start()
    assert first_begun.wait(10)
    threads[1].start()
    threads[0].join()
    first_over.set()
    threads[1].join()
    assert codes == {"first": 0, "second": 0}
    assert sys.stdout is out
    assert out is None or out.errors == "strict"
