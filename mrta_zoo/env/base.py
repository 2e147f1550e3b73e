"""The part of PettingZoo's interface that the AEC and the parallel environment share."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from importlib.util import find_spec
from typing import Any

import numpy as np
from gymnasium import spaces

from mrta_zoo.env.observation import FloatTable
from mrta_zoo.env.settings import Settings
from mrta_zoo.env.world import World
from mrta_zoo.errors import MissingExtraError
from mrta_zoo.mission import Mission
from mrta_zoo.show.markup import LITERAL
from mrta_zoo.show.render import Viewer, describe, headline


class EnvBase:
    """Spaces, state and rendering on top of a `World`; must come first among the base classes.

    Args:
        settings: the environment's options.
        num_actions: number of every agent's actions; actions are checked against this, not the spaces handed out.
    """

    def __init__(self, settings: Settings, num_actions: int) -> None:
        super().__init__()
        self.settings = settings
        self._world = World(settings, num_actions)
        self.num_actions = num_actions
        self.render_mode = settings.render_mode
        self._viewer = Viewer(settings.render_mode)
        self.possible_agents = list(self._world.names)
        self.action_spaces = dict(self._world.action_spaces)
        self.observation_spaces = dict.fromkeys(self.possible_agents, self._world.observation_space)
        self.state_space = self._world.state_space

    @property
    def mission(self) -> Mission:
        """The mission under way, live, with every detail that observations round or leave out: do not change it."""
        return self._world.mission

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """The space of observations; one object for all agents."""
        self._world.robot(agent)
        return self._world.observation_space

    def action_space(self, agent: str) -> spaces.Discrete:
        """The space of actions; equal for all agents, but each has its own object, and so its own seed."""
        self._world.robot(agent)
        return self._world.action_spaces[agent]

    def state(self) -> FloatTable:
        """(8 max_tasks + 6 max_robots + 3,) float32 in [0, 1]: tasks, robots and mission."""
        return self._world.state()

    def render(self) -> np.ndarray | str | None:
        """The mission as text or a picture, or shown in a window, by `render_mode`; see `render.Viewer.render`."""
        return self._viewer.render(self.mission)

    def _repr_html_(self) -> str:
        """What a notebook shows: the mission as a picture, or as text if pygame is not installed."""
        if not self._world.agents:
            return f"<pre>{escape(f'{self}: no mission yet; call reset()')}</pre>"
        text = f'<pre class="{LITERAL}">{escape(describe(self.mission))}</pre>'
        if find_spec("pygame") is None:
            return text
        try:
            from mrta_zoo.show.render.canvas import as_png  # pygame is heavy and optional
            from mrta_zoo.show.render.picture import draw
        except MissingExtraError:  # it is installed, but broken
            return text

        png = b64encode(as_png(draw(self.mission))).decode()
        return f'<img width="800" alt="{escape(headline(self.mission))}" src="data:image/png;base64,{png}">'

    def close(self) -> None:
        """Close the window of render mode ``"human"``, if it is open."""
        self._viewer.close()
