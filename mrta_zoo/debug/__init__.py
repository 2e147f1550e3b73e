"""Debugging of episodes: record them, step through them, and find where two of them part."""

from mrta_zoo.debug.advisors import make_advisor
from mrta_zoo.debug.comparison import Comparison, compare
from mrta_zoo.debug.recorder import record
from mrta_zoo.debug.stepper import Stepper

__all__ = ["Comparison", "Stepper", "compare", "make_advisor", "record"]
