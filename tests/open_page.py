"""A replay page opened in a browser, for tests."""

from __future__ import annotations

import re
from typing import Any

UNITS = 520
"""Length of the map's longer side in the units of its SVG, whose y axis points down."""


class OpenPage:
    """A page, with its console messages, errors and network requests."""

    def __init__(self, browser: Any, url: str, width: int = 1400, height: int = 900) -> None:
        self.complaints: list[str] = []
        self.requests: list[str] = []
        self.tab = browser.new_page(viewport={"width": width, "height": height})
        self.tab.set_default_timeout(120_000)  # milliseconds; pages are large, and machines may be busy
        self.tab.on("console", lambda message: self.complaints.append(message.text))
        self.tab.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.tab.on("request", lambda request: self.requests.append(request.url))
        self.tab.goto(url)
        self.tab.wait_for_selector("#progress svg")

    def texts(self, selector: str) -> list[str]:
        """What the elements say, in order."""
        texts: list[str] = self.tab.locator(selector).all_inner_texts()
        return texts

    def slide(self, time: float) -> None:
        """Move the slider to an exact time, as a hand would."""
        self.tab.locator("#slider").evaluate(
            "(slider, time) => { slider.value = time; slider.dispatchEvent(new Event('input')) }", time
        )

    def places(self, side: int, size: float) -> dict[int, tuple[float, float]]:
        """Where the robots are on a map of `size` by `size`, in distance units."""
        moved = self.tab.locator(f"#side-{side} .robot").evaluate_all(
            "marks => marks.map(mark => [Number(mark.dataset.robot), mark.getAttribute('transform')])"
        )
        found = {}
        for robot, transform in moved:
            x, y = (float(number) * size / UNITS for number in re.findall(r"-?\d[\d.e-]*", transform))
            found[robot] = (x, size - y)
        return found

    def statuses(self, side: int) -> list[str]:
        """How the tasks look, in order of index."""
        classes = self.tab.locator(f"#side-{side} .task").evaluate_all(
            "marks => marks.map(mark => mark.getAttribute('class'))"
        )
        return [each.removeprefix("task ") for each in classes]

    def decision(self, side: int) -> str:
        """The heading of the table."""
        return self.texts(f"#side-{side} .decision b")[0]
