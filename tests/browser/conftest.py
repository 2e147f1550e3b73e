"""A headless Chromium for the tests of the replay page; without it or Playwright they are skipped."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from typing import Any

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FLAGS = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
]  # fmt: skip


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """The browser; `open_page.OpenPage` opens a page in it."""
    playwright = pytest.importorskip("playwright.sync_api", reason='needs Playwright: pip install "mrta_zoo[browser]"')
    if CHROMIUM is None:
        pytest.skip("needs Chromium: apt-get install chromium, or your system's equivalent")
    with playwright.sync_playwright() as driver:
        chromium = driver.chromium.launch(executable_path=CHROMIUM, headless=True, args=FLAGS)
        yield chromium
        chromium.close()
