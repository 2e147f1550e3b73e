"""Files are replaced whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from mrta_zoo.io import atomic
from mrta_zoo.io.atomic import replacing


def test_the_file_changes_at_the_end(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_text("old")
    with replacing(path) as partial:
        partial.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("problem", [RuntimeError, KeyboardInterrupt])
def test_on_failure_nothing_changes(tmp_path: Path, problem: type[BaseException]) -> None:
    path = tmp_path / "file"
    path.write_text("old")

    def fail() -> None:
        with replacing(path) as partial:
            partial.write_text("ne")
            raise problem

    with pytest.raises(problem):
        fail()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_pipe_is_written_to_and_stays(tmp_path: Path) -> None:
    path = tmp_path / "pipe"
    os.mkfifo(path)
    reader = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    with replacing(path) as partial:
        partial.write_text("text")
    assert os.read(reader, 10) == b"text"
    os.close(reader)
    assert path.is_fifo()


@pytest.mark.parametrize("name", ["missing/file", "", "null\0character"])
def test_where_no_file_can_be(tmp_path: Path, name: str) -> None:
    with pytest.raises((OSError, ValueError)), replacing(tmp_path / name) as partial:
        partial.write_text("text")


def write(path: Path, text: str) -> None:
    with replacing(path) as partial:
        partial.write_text(text)


def test_many_may_write_one_file_while_others_read_it(tmp_path: Path) -> None:
    path = tmp_path / "file"
    texts = [letter * 100_000 for letter in "abcdefgh"]
    write(path, texts[0])
    with ThreadPoolExecutor(8) as pool:
        written = [pool.submit(write, path, text) for text in texts * 10]
        seen = [path.read_text() for _ in range(100)]
        for each in written:
            each.result()
    assert set(seen) <= set(texts)
    assert list(tmp_path.iterdir()) == [path]


def test_no_two_partial_files_have_the_same_name(tmp_path: Path) -> None:
    """Whoever writes: another container has the same process ids."""
    with replacing(tmp_path / "file") as one, replacing(tmp_path / "file") as other:
        assert one != other
        one.write_text("1")
        other.write_text("2")
    assert (tmp_path / "file").read_text() == "1"


def test_a_long_name_is_no_longer_meanwhile(tmp_path: Path) -> None:
    write(tmp_path / ("x" * 255), "text")
    assert (tmp_path / ("x" * 255)).read_text() == "text"


@pytest.mark.parametrize("target", ["there", "absent"])
def test_a_link_is_written_through(tmp_path: Path, target: str) -> None:
    for folder in ("data", "here"):
        (tmp_path / folder).mkdir()
    (tmp_path / "data" / "there").write_text("old")
    (tmp_path / "data" / "second").symlink_to(target)
    link = tmp_path / "here" / "link"
    link.symlink_to(Path("..") / "data" / "second")
    write(link, "new")
    assert link.is_symlink()
    assert (tmp_path / "data" / "second").is_symlink()
    assert (tmp_path / "data" / target).read_text() == "new"
    assert [path.name for path in link.parent.iterdir()] == ["link"]


def test_links_in_a_circle_are_no_file(tmp_path: Path) -> None:
    link = tmp_path / "link"
    link.symlink_to(link)
    with pytest.raises(OSError, match="symbolic links"):
        write(link, "text")
    assert link.is_symlink()


@pytest.mark.parametrize("mode", [0o600, 0o664, 0o755])
def test_permissions_stay(tmp_path: Path, mode: int) -> None:
    path = tmp_path / "file"
    path.write_text("old")
    path.chmod(mode)
    old = path.stat()
    os.utime(path, (1, 1))
    write(path, "new")
    assert stat.S_IMODE(path.stat().st_mode) == mode
    assert (path.stat().st_uid, path.stat().st_gid) == (old.st_uid, old.st_gid)
    assert path.stat().st_mtime > 1, "it has changed"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root may give files away")
def test_the_owner_stays(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_text("old")
    os.chown(path, 1234, 4321)
    write(path, "new")
    assert (path.stat().st_uid, path.stat().st_gid) == (1234, 4321)
    assert path.read_text() == "new"


def test_of_somebody_else_it_stays_theirs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "file"
    path.write_text("old and longer")
    inode = path.stat().st_ino
    real = os.stat
    theirs = [*real(path)]
    theirs[stat.ST_UID] += 1
    monkeypatch.setattr(os, "chown", raising(errno.EPERM))
    monkeypatch.setattr(os, "stat", lambda at, **_: os.stat_result(theirs) if at == path else real(at))
    write(path, "new")
    monkeypatch.undo()
    assert (path.stat().st_ino, path.read_text()) == (inode, "new"), "written in place"


def test_a_second_name_is_still_of_the_same_file(tmp_path: Path) -> None:
    path, other = tmp_path / "file", tmp_path / "other"
    path.write_text("old and longer")
    os.link(path, other)
    write(path, "new")
    assert other.read_text() == "new"
    assert path.samefile(other)


def raising(number: int) -> Callable[..., None]:
    def fail(*_: object) -> None:
        raise OSError(number, os.strerror(number))

    return fail


@pytest.mark.parametrize("number", [errno.EBUSY, errno.EXDEV, errno.EPERM])
def test_what_cannot_be_replaced_is_written_in_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    """Such as a file that a container gets mounted by itself."""
    path = tmp_path / "file"
    path.write_text("old and longer")
    monkeypatch.setattr(os, "replace", raising(number))
    write(path, "new")
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_in_a_folder_that_may_not_be_written_to(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "elsewhere").mkdir()
    path = tmp_path / "folder" / "file"
    path.parent.mkdir()
    path.write_text("old and longer")
    real = os.open

    def refusing(at: Path, *rest: int) -> int:
        if at.parent == path.parent:
            raise OSError(errno.EROFS, os.strerror(errno.EROFS))
        return real(at, *rest)

    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "elsewhere"))
    monkeypatch.setattr(os, "open", refusing)
    write(path, "new")
    with pytest.raises(OSError, match="ead-only"):
        write(path.with_name("another"), "new")
    assert path.read_text() == "new"
    assert list(path.parent.iterdir()) == [path]
    assert list((tmp_path / "elsewhere").iterdir()) == []


def test_what_was_there_is_put_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "file"
    path.write_text("old")
    monkeypatch.setattr(os, "replace", raising(errno.EBUSY))
    real = atomic._fill
    fills: list[bytes] = []

    def fill(file: atomic.FileIO, data: bytes) -> None:
        fills.append(data)
        real(file, data[: len(data) // 2] if data == b"new one" else data)
        if data == b"new one":
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(atomic, "_fill", fill)
    with pytest.raises(OSError, match="No space"):
        write(path, "new one")
    assert fills == [b"new one", b"old"]
    assert path.read_text() == "old"


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write to any file")
def test_a_file_that_may_not_be_written_to_is_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "file"
    path.write_text("old")
    path.chmod(0o444)
    with pytest.raises(PermissionError):
        write(path, "new")
    assert path.read_text() == "old"


@pytest.mark.parametrize("temporary", ["absent", "unwritable"])
def test_where_there_is_no_room_but_in_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, temporary: str) -> None:
    """As in a container that may write to one file alone."""
    path = tmp_path / "file"
    path.write_text("old and longer")

    def nowhere() -> str:
        if temporary == "unwritable":
            return "/elsewhere"
        raise FileNotFoundError(errno.ENOENT, "No usable temporary directory found in ['/tmp']")

    monkeypatch.setattr(tempfile, "gettempdir", nowhere)
    monkeypatch.setattr(os, "open", raising(errno.EROFS))
    write(path, "new")
    assert path.read_text() == "new"
    with pytest.raises(UnicodeEncodeError):
        write(path, "ne\ud800")
    assert path.read_text() == "new"
    with pytest.raises(OSError, match="ead-only"):
        write(tmp_path / "another", "new")


def test_many_may_write_a_file_of_two_names(tmp_path: Path) -> None:
    path = tmp_path / "file"
    texts = [letter * size for letter, size in (("a", 10), ("b", 200_000), ("c", 3_000), ("d", 1_000_000))]
    path.write_text("")
    os.link(path, tmp_path / "other")
    with ThreadPoolExecutor(4) as pool:
        for _ in range(25):
            list(pool.map(lambda text: write(path, text), texts))
            assert path.read_text() in texts


@pytest.mark.skipif(os.name == "nt", reason="no advisory locks there")
def test_who_writes_in_place_waits_for_other_processes(tmp_path: Path) -> None:
    import fcntl

    path = tmp_path / "file"
    path.write_text("old")
    os.link(path, tmp_path / "other")
    with path.open("r+") as file, ThreadPoolExecutor(1) as pool:
        fcntl.flock(file, fcntl.LOCK_EX)
        written = pool.submit(write, path, "new")
        time.sleep(0.05)
        assert (written.done(), path.read_text()) == (False, "old")
        fcntl.flock(file, fcntl.LOCK_UN)
        written.result(timeout=10)
    assert path.read_text() == "new"
