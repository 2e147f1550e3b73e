"""What a method may be told when it plans."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

from mrta_zoo.bounds import check_seed
from mrta_zoo.errors import ConfigError
from mrta_zoo.rules import MaskRule, check_mask_rule

Decode = Literal["greedy", "sample"]
"""How a learned policy chooses: the likeliest task each time, or drawn from its probabilities."""

MAX_SAMPLES = 10_000
"""More at a time than memory holds; a budget draws as many as there is time for, some at a time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SolverOptions:
    """What any method may be told; each uses what it can.

    Attributes:
        seed: of all draws, from 0 to `bounds.MAX_SEED`. Every scenario starts from it, so that a case has the same plan
            in any company.
        decode: how learned methods choose: "greedy", the likeliest task each time; "sample", the best of several drawn
            missions and the greedy one. None is "sample" if there is a budget, else "greedy".
        samples: missions that "sample" draws in one go, from 1 to `MAX_SAMPLES`.
        budget: seconds a scenario that methods which search may take, > 0; None leaves it to the method.
        mask_rule: what robots may choose, see `rules.MaskRule`. None is "feasible" or, for learned methods, the rule
            they were trained under. Solvers that plan only what is in time do not need it.

    Raises:
        ConfigError: if a value is out of range.
    """

    seed: int = 0
    decode: Decode | None = None
    samples: int = 64
    budget: float | None = None
    mask_rule: MaskRule | None = None

    def __post_init__(self) -> None:
        check_seed(self.seed)
        if self.decode is None:
            object.__setattr__(self, "decode", "greedy" if self.budget is None else "sample")
        if self.decode not in get_args(Decode):
            raise ConfigError(f"decode is {self.decode!r}; expected one of {', '.join(get_args(Decode))}")
        if not 1 <= self.samples <= MAX_SAMPLES:
            raise ConfigError(f"samples is {self.samples}; expected a whole number from 1 to {MAX_SAMPLES}")
        if self.budget is not None and not 0 < self.budget < math.inf:
            raise ConfigError(f"budget is {self.budget:g}; expected a number of seconds > 0")
        if self.mask_rule is not None:
            check_mask_rule(self.mask_rule)
