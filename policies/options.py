"""Options of methods that plan."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from mrta_zoo.bounds import check_seed, check_threads
from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.stop import check_budget
from mrta_zoo.rules import MaskRule, check_mask_rule

Decode = Literal["greedy", "sample", "augment", "beam"]
"""How a learned policy plans: with the likeliest task each time; as the best of many missions drawn from its
probabilities; as the best with the map in each of its 8 symmetries; or by beam search."""

DEFAULT_SAMPLES: dict[Decode, int] = {"sample": 64, "augment": 64, "beam": 16}
"""Number of missions drawn in one go, or the width of the beam."""

MAX_SAMPLES = 10_000
"""More would not fit into memory at a time. With a budget, missions are drawn in batches while there is time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SolverOptions:
    """Options of any method; each uses those that apply to it.

    Attributes:
        seed: of all random draws, from 0 to `bounds.MAX_SEED`. Every scenario starts from it, so that a case has the
            same plan whatever else is planned.
        decode: how learned methods plan: "greedy", with the likeliest task each time; "sample", the best of several
            drawn missions and the greedy one; "augment", the best of the greedy ones with the map in each of its 8
            symmetries and, with a budget, of missions drawn that way; "beam", the best that beam search finishes. None
            is "sample" if there is a budget or a number of samples, else "greedy".
        samples: number of missions that "sample" (and "augment" with a budget) draws in one go, or the width of the
            beam, from 1 to `MAX_SAMPLES`; None is `DEFAULT_SAMPLES`.
        budget: seconds per scenario for methods that search, > 0; None leaves it to the method.
        mask_rule: what robots may choose, see `rules.MaskRule`. None is "feasible" or, for learned methods, the rule
            under which they were trained. Solvers that plan only tasks in time ignore it.
        threads: number of parallel local searches, from 1 to `bounds.MAX_THREADS`, if there is a budget.

    Raises:
        ConfigError: if a value is out of range.
    """

    seed: int = 0
    decode: Decode | None = None
    samples: int | None = None
    budget: float | None = None
    mask_rule: MaskRule | None = None
    threads: int = 1

    def __post_init__(self) -> None:
        check_seed(self.seed)
        if self.decode is None:
            object.__setattr__(self, "decode", "greedy" if self.budget is None and self.samples is None else "sample")
        if self.decode not in get_args(Decode):
            raise ConfigError(f"decode is {self.decode!r}; expected one of {', '.join(get_args(Decode))}")
        if self.samples is not None and not 1 <= self.samples <= MAX_SAMPLES:
            raise ConfigError(f"samples is {self.samples}; expected a whole number from 1 to {MAX_SAMPLES}")
        if self.budget is not None:
            check_budget(self.budget)
        if self.mask_rule is not None:
            check_mask_rule(self.mask_rule)
        check_threads(self.threads, least=1)
