"""Multi-robot task allocation as a PettingZoo environment, with one CapAM policy shared by all robots."""

from mrta_zoo.plan import Plan
from mrta_zoo.registration import register
from mrta_zoo.scenario import Scenario

__all__ = ["Plan", "Scenario"]
__version__ = "0.1.0"

register()
