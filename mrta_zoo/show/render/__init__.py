"""Missions for people: as text, as a picture and in a window."""

from __future__ import annotations

from mrta_zoo.show.render.ansi import describe, headline
from mrta_zoo.show.render.viewer import RENDER_FPS, RENDER_MODES, Viewer

__all__ = ["RENDER_FPS", "RENDER_MODES", "Viewer", "describe", "headline"]
