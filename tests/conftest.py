"""Puts this folder on the path, so that tests in subfolders can `from strategies import ...`."""

import gc
import os
import signal
from collections.abc import Iterator
from contextlib import suppress

import pytest
import torch

os.environ.setdefault("SDL_VIDEODRIVER", "dummy")  # windows that need no display
with suppress(ModuleNotFoundError):  # the environment of the integrations has none
    from hypothesis import settings

    settings.register_profile("any machine", deadline=None)  # a busy one is no fault
    settings.load_profile("any machine")
torch.set_num_threads(1)  # at the tests' sizes more threads only get in each other's way


@pytest.fixture
def signals_heard() -> Iterator[None]:
    """Ctrl-C and a lost connection reach this process and those it starts, though `nohup` or `&` has both ignored."""
    usual = {signal.SIGINT: signal.default_int_handler}
    if hasattr(signal, "SIGHUP"):  # not on Windows
        usual[signal.SIGHUP] = signal.SIG_DFL
    before = {number: signal.signal(number, handler) for number, handler in usual.items()}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def pytest_collection_finish() -> None:
    """Keep the imports' objects out of every full garbage collection (statsmodels asks for one per call)."""
    gc.collect()
    gc.freeze()
