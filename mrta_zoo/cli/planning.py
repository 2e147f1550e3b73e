"""The flags that say how methods plan, which several commands have."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

from mrta_zoo.cli.flags import optional
from mrta_zoo.cli.methods import is_episode, read_any_plan, read_any_trace
from mrta_zoo.debug.advisors import Advisor, make_advisor
from mrta_zoo.debug.recorder import record
from mrta_zoo.policies.options import Decode
from mrta_zoo.policies.protocol import Solver
from mrta_zoo.policies.registry import make_solver, used_options
from mrta_zoo.rules import MASK_RULES, MaskRule
from mrta_zoo.scenario import Scenario
from mrta_zoo.show.terminal.console import warn
from mrta_zoo.trace import Trace


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanningFlags:
    """How methods plan. Each method uses the options that apply to it: heuristics the mask rule (random the seed, too),
    ils and exact the budget, eils and pyvrp the budget and the seed, big-mrta none."""

    decode: Annotated[Decode | None, optional("{greedy,sample,augment,beam}")] = None
    """How learned methods choose. greedy: always the most probable task; sample: the best of several sampled missions
    and the greedy one; augment: the best of 8 greedy ones with the map mirrored and rotated, and with --budget also of
    missions sampled that way; beam: the best of a beam search, which with --budget grows wider and wider. By default
    sample if --budget or --samples is given, otherwise greedy."""
    samples: Annotated[int | None, optional("N")] = None
    """For sample, the number of missions to sample at once, 64 by default; with --budget it goes on sampling. For beam,
    its width, 16 by default."""
    budget: Annotated[float | None, optional("SECONDS")] = None
    """Seconds per mission for methods that can use more time. By default they stop by themselves: exact after 60
    seconds at most, pyvrp after 5."""
    seed: int = 0
    """Seed of everything random. The same seed gives the same plan, unless a budget cuts the search off."""
    mask_rule: Annotated[
        MaskRule | None,
        optional(
            f"{{{','.join(MASK_RULES)}}}",
            help="Which of the tasks not yet taken a robot may choose: "
            f"{'; '.join(f'{name}, {rule.help}' for name, rule in MASK_RULES.items())}. By default feasible or, for a "
            "trained policy, what it was trained under. Methods that are neither heuristics nor trained only plan what "
            "is finished by its deadline.",
        ),
    ] = None
    threads: int = 1
    """CPU threads for learned methods. For single missions one is as fast as several, and keeps timings comparable. For
    eils and +polish with --budget, the number of searches in parallel, of which the best counts."""

    def warn_unused(self, methods: Sequence[str], *used: str) -> None:
        """Warn about flags that have no effect.

        Args:
            methods: methods that will plan, or files of plans and traces.
            used: options that the command itself uses.
        """
        known = frozenset(used).union(*(used_options(name) for name in methods if not is_episode(name)))
        if self.decode == "greedy" or (self.decode == "augment" and self.budget is None):
            known -= {"samples"}
        do_not = f"{' and '.join(methods)} {'does' if len(methods) == 1 else 'do'} not"
        for option in ("decode", "samples", "budget", "mask_rule"):
            if getattr(self, option) is not None and option not in known:
                warn(f"{do_not} use --{option.replace('_', '-')}")

    def solver(self, method: str) -> Solver:
        """The method with these options."""
        return make_solver(method, **asdict(self))

    def advisor(self, name: str, scenario: Scenario) -> Advisor:
        """A method with these options, or a plan or trace in a file, as the advisor of a stepper.

        Raises:
            MrtaError: if there is no such method, or the file is malformed or does not fit the scenario.
        """
        if is_episode(name):
            return make_advisor(scenario, read_any_plan(Path(name), scenario), mask_rule=self.mask_rule)
        return make_advisor(scenario, name, **asdict(self))

    def episode(self, name: str, scenario: Scenario) -> Trace:
        """The episode of a method with these options, or of the plan or trace in a file.

        Raises:
            MrtaError: if there is no such method, or the file is malformed or does not fit the scenario.
        """
        if is_episode(name):
            return read_any_trace(Path(name), scenario, self.mask_rule)
        return record(scenario, name, **asdict(self))
