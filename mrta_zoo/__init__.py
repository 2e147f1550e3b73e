"""Multi-robot task allocation as a PettingZoo environment, with one CapAM policy shared by all robots."""

# ruff: noqa: E402
from mrta_zoo.program import end_in_a_sentence

end_in_a_sentence()  # before the slow imports

from pathlib import Path

from mrta_zoo.plan import Plan
from mrta_zoo.registration import register
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.notebook import attach

__all__ = ["Plan", "Scenario"]
__version__ = "0.1.0"

register()
attach()

# In a checkout, which Python imports from when started there, policies, train and eval lie beside this folder.
_checkout = Path(__file__).parent.parent
if not (_checkout / "mrta_zoo" / "policies").exists() and (_checkout / "policies" / "pretrained").is_dir():
    __path__.append(str(_checkout))
