"""Functions compiled by Numba and, where possible, cached on disk for the next process."""

from __future__ import annotations

import hashlib
import logging
import multiprocessing
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from numba import njit

from mrta_zoo import rules

Function = TypeVar("Function", bound=Callable[..., Any])

NOT_CACHED = (
    "Numba cannot write its cache, so that each process compiles the local search again (some 20 seconds); set "
    "NUMBA_CACHE_DIR to a writable folder with room"
)


def compiled(function: Function) -> Function:
    """`function`, compiled at its first call. It releases the GIL.

    If the cache cannot be written (a read-only installation without a home, a full disk) or is damaged, the function is
    compiled again. The former is logged as a warning, once, which by default goes to standard error.
    """
    made: Any = njit(nogil=True)(function)
    if made is function:  # with NUMBA_DISABLE_JIT
        return function
    try:
        made.enable_caching()
        with suppress(AttributeError):  # a Numba that keeps its index otherwise
            # Numba looks at the function's own file only, but what it compiles holds functions of other files, too.
            made._cache._cache_file._source_stamp = (made._cache._cache_file._source_stamp, sources_digest())
        made._cache = _OptionalCache(made._cache)
    except (RuntimeError, OSError):  # the first is Numba's if there is no folder
        _warn_not_cached()
    result: Function = made
    return result


class _OptionalCache:
    """Numba's cache of one function on disk; if it fails, the function is compiled as if there were none."""

    def __init__(self, kept: Any) -> None:
        self._kept = kept

    def __getattr__(self, name: str) -> Any:
        return getattr(self._kept, name)

    def load_overload(self, *arguments: Any) -> Any:
        try:
            return self._kept.load_overload(*arguments)
        except Exception:  # whatever unpickling damaged files raises
            return None

    def save_overload(self, *arguments: Any) -> None:
        try:
            try:
                self._kept.save_overload(*arguments)
            except Exception:  # a damaged index, perhaps
                self._kept.flush()
                self._kept.save_overload(*arguments)
        except OSError:
            _warn_not_cached()


@cache
def sources_digest() -> str:
    """SHA-256 of all files that have compiled functions, or functions that these call."""
    files = [*sorted(Path(__file__).parent.glob("*.py")), Path(rules.__file__)]
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


@cache
def _warn_not_cached() -> None:
    if multiprocessing.parent_process() is None:  # else the parent has warned already
        logging.getLogger(__name__).warning(NOT_CACHED)
