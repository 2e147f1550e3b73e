"""Replay: a page for the browser that plays one trace, or two of the same scenario side by side."""

from __future__ import annotations

from mrta_zoo.show.replay.page import replay_page, write_replay

__all__ = ["replay_page", "write_replay"]
