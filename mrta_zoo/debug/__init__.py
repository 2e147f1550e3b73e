"""Looking into episodes: recording them and stepping through them."""

from mrta_zoo.debug.advisors import make_advisor
from mrta_zoo.debug.recorder import record

__all__ = ["make_advisor", "record"]
