"""Compiled functions need no place on disk, and mind no damage there."""

from __future__ import annotations

import errno
import logging
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("numba")

import numba.core.caching
import numba.core.config

from mrta_zoo.policies.classical.local_search import compiled as module
from mrta_zoo.policies.classical.local_search.compiled import NOT_CACHED, _warn_not_cached, compiled


def twice(number: int) -> int:
    return 2 * number


@pytest.fixture(autouse=True)
def folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Path]:
    """Where Numba keeps what is compiled in a test."""
    monkeypatch.setattr(numba.core.config, "CACHE_DIR", str(tmp_path))
    _warn_not_cached.cache_clear()
    yield tmp_path
    _warn_not_cached.cache_clear()


def hits(function: Callable[..., Any]) -> int:
    """How often a compiled function was found on disk."""
    return sum(function.stats.cache_hits.values())  # type: ignore[attr-defined]


def test_it_is_kept_for_the_next_process(caplog: pytest.LogCaptureFixture) -> None:
    first, second = compiled(twice), compiled(twice)
    assert (first(2), second(2)) == (4, 4)
    assert (hits(first), hits(second)) == (0, 1)
    assert caplog.messages == []


def test_it_is_compiled_again_after_a_change_in_any_file(monkeypatch: pytest.MonkeyPatch) -> None:
    assert compiled(twice)(2) == 4
    monkeypatch.setattr(module, "sources_digest", lambda: "of other sources")
    after, again = compiled(twice), compiled(twice)
    assert (after(2), again(2)) == (4, 4)
    assert (hits(after), hits(again)) == (0, 1)


def test_without_a_place_it_is_compiled_all_the_same_and_that_is_said_once(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.setattr(numba.core.caching._CacheLocator, "ensure_cache_path", refuse)
    assert compiled(twice)(2) == compiled(twice)(2) == 4
    assert caplog.record_tuples == [("mrta_zoo.policies.classical.local_search.compiled", logging.WARNING, NOT_CACHED)]
    assert "NUMBA_CACHE_DIR" in NOT_CACHED


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS, errno.EACCES])
def test_a_place_that_takes_nothing(
    number: int, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(number, "no")

    monkeypatch.setattr(numba.core.caching.IndexDataCacheFile, "_save_data", refuse)
    assert compiled(twice)(2) == compiled(twice)(2) == 4
    assert caplog.messages == [NOT_CACHED]


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("text", [b"", b"torn", None])
def test_damaged_files_are_replaced(
    suffix: str, text: bytes | None, folder: Path, caplog: pytest.LogCaptureFixture
) -> None:
    assert compiled(twice)(2) == 4
    (kept,) = folder.rglob(f"*.{suffix}")
    kept.write_bytes(kept.read_bytes()[:-20] if text is None else text)
    damaged, mended = compiled(twice), compiled(twice)
    assert (damaged(2), mended(2)) == (4, 4)
    assert (hits(damaged), hits(mended)) == (0, 1)
    assert caplog.messages == []


def test_with_compiling_switched_off_it_is_the_function_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("numba.core.config.DISABLE_JIT", 1)

    def plain() -> int:
        return 1

    assert compiled(plain) is plain
