"""What a method may be told when it plans."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

from mrta_zoo.bounds import check_seed, check_threads
from mrta_zoo.errors import ConfigError
from mrta_zoo.policies.stop import check_budget
from mrta_zoo.rules import MaskRule, check_mask_rule

Decode = Literal["greedy", "sample", "augment", "beam"]
"""How a learned policy chooses: the likeliest task each time; drawn from its probabilities, many times; the likeliest
with the map seen in each of its 8 symmetries; or by beam search."""

DEFAULT_SAMPLES: dict[Decode, int] = {"sample": 64, "augment": 64, "beam": 16}
"""Missions drawn in one go, or the width of the beam."""

MAX_SAMPLES = 10_000
"""More at a time than memory holds; a budget draws as many as there is time for, some at a time."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SolverOptions:
    """What any method may be told; each uses what it can.

    Attributes:
        seed: of all draws, from 0 to `bounds.MAX_SEED`. Every scenario starts from it, so that a case has the same plan
            in any company.
        decode: how learned methods choose: "greedy", the likeliest task each time; "sample", the best of several drawn
            missions and the greedy one; "augment", the best of the greedy ones with the map seen in each of its 8
            symmetries and, with a budget, of missions drawn so; "beam", the best that beam search finishes. None is
            "sample" if there is a budget or a number of samples, else "greedy".
        samples: missions that "sample" (and "augment" with a budget) draws in one go, or the width of the beam, from 1
            to `MAX_SAMPLES`; None is `DEFAULT_SAMPLES`.
        budget: seconds a scenario that methods which search may take, > 0; None leaves it to the method.
        mask_rule: what robots may choose, see `rules.MaskRule`. None is "feasible" or, for learned methods, the rule
            they were trained under. Solvers that plan only what is in time do not need it.
        threads: how many searches local search carries on at a time, from 1 to `bounds.MAX_THREADS`, if there is a
            budget.

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
