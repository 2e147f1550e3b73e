"""Missions for people: as text and as a picture."""

from __future__ import annotations

import gymnasium
import numpy as np

from mrta_zoo.mission import Mission
from mrta_zoo.render.ansi import describe

__all__ = ["RENDER_MODES", "describe", "render"]

RENDER_MODES = ("ansi", "human", "rgb_array")


def render(mission: Mission, mode: str | None) -> np.ndarray | str | None:
    """Text for ``"ansi"``, a (height, width, 3) uint8 picture for ``"rgb_array"``; ``"human"`` prints the text.

    Raises:
        MissingExtraError: if a picture is asked for and matplotlib is not installed.
    """
    if mode is None:
        gymnasium.logger.warn("You are calling render method without specifying any render mode.")
        return None
    if mode == "rgb_array":
        from mrta_zoo.render.picture import picture  # draws on matplotlib, which is heavy and optional

        return picture(mission)
    text = describe(mission)
    if mode == "human":
        print(text)
        return None
    return text
