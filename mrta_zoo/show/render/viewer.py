"""The viewer of an environment: renders text, a picture or a window, by render mode."""

from __future__ import annotations

from typing import TYPE_CHECKING

import gymnasium
import numpy as np
import numpy.typing as npt

from mrta_zoo.mission import Mission
from mrta_zoo.show.render.ansi import describe

if TYPE_CHECKING:
    from mrta_zoo.show.render.window import Window

RENDER_MODES = ("ansi", "human", "rgb_array")
RENDER_FPS = 10
"""Frames per second of the window, and of videos by default."""


class Viewer:
    """Renders missions; holds the window, if there is one.

    Args:
        mode: one of `RENDER_MODES`, or None to render nothing.
    """

    def __init__(self, mode: str | None) -> None:
        self.mode = mode
        self._window: Window | None = None

    def render(self, mission: Mission) -> npt.NDArray[np.uint8] | str | None:
        """Text for ``"ansi"``, a (720, 1040, 3) uint8 picture for ``"rgb_array"``; ``"human"`` shows it in a window.

        Raises:
            MissingExtraError: if a picture is asked for and pygame is not installed.
            ConfigError: if a window is asked for and there is no display.
        """
        if self.mode is None:
            gymnasium.logger.warn("You are calling render method without specifying any render mode.")
            return None
        if self.mode == "ansi":
            return describe(mission)
        from mrta_zoo.show.render.canvas import as_array  # pygame is heavy and optional
        from mrta_zoo.show.render.picture import draw

        picture = draw(mission)
        if self.mode == "rgb_array":
            return as_array(picture)
        if self._window is None:
            from mrta_zoo.show.render.window import Window

            self._window = Window("mrta_zoo", RENDER_FPS)
        self._window.show(picture)
        return None

    def close(self) -> None:
        """Close the window, if there is one; rendering again opens another."""
        if self._window is not None:
            self._window.close()
            self._window = None
