"""Episodes as a page to be looked at in a browser: one or two traces of the same scenario, side by side."""

from __future__ import annotations

from mrta_zoo.show.replay.page import replay_page, write_replay

__all__ = ["replay_page", "write_replay"]
