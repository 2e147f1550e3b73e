"""The window of render mode ``"human"``.

Needs pygame (``mrta_zoo[render]``) and a display.
"""

from __future__ import annotations

import os

import pygame

from mrta_zoo.errors import ConfigError

UNSEEN = ("offscreen", "dummy")
DRIVER_VARIABLES = ("SDL_VIDEODRIVER", "SDL_VIDEO_DRIVER")


class Window:
    """Shows one picture after another; opens with the first.

    Once the user has closed it, it stays closed: showing a picture then does nothing, and the mission goes on unseen.

    Args:
        title: in its bar.
        fps: the most pictures per second, > 0; `show` waits accordingly.
    """

    def __init__(self, title: str, fps: int) -> None:
        self._title, self._fps = title, fps
        self._screen: pygame.Surface | None = None
        self._clock = pygame.time.Clock()
        self._dismissed = False

    def __reduce__(self) -> tuple[type[Window], tuple[str, int]]:
        return type(self), (self._title, self._fps)  # the copy of an environment opens its own window

    def show(self, picture: pygame.Surface) -> None:
        """Show `picture`, and handle the events that the window has received meanwhile.

        Raises:
            ConfigError: if there is no display.
        """
        if self._dismissed:
            return
        if self._screen is None or not pygame.display.get_init():  # pygame has one display: another may have closed it
            self._screen = _open(self._title, picture.get_size())
        if any(event.type == pygame.QUIT for event in pygame.event.get()):
            self.close()
            self._dismissed = True
            return
        self._screen.blit(picture, (0, 0))
        pygame.display.flip()
        self._clock.tick(self._fps)

    def close(self) -> None:
        """Close the window, if it is open."""
        if self._screen is not None:
            self._screen = None
            pygame.display.quit()


def _open(title: str, size: tuple[int, int]) -> pygame.Surface:
    try:
        pygame.display.init()
        # Without a display SDL may choose by itself to draw where nobody sees it.
        if pygame.display.get_driver() in UNSEEN and not any(name in os.environ for name in DRIVER_VARIABLES):
            pygame.display.quit()
            raise pygame.error("there is no display")
        screen = pygame.display.set_mode(size)
    except pygame.error as error:
        raise ConfigError(
            f"render_mode 'human' cannot open a window: {error}; expected a display (or, for tests, the environment "
            "variable SDL_VIDEODRIVER=dummy); render_mode 'rgb_array' needs none"
        ) from None
    pygame.display.set_caption(title)
    return screen
