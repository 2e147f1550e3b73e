"""A study of sharing: what was asked for, what came of it, and the differences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from statistics import fmean

import numpy as np

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.plot_history import LearningCurve
from mrta_zoo.eval.significance import SIGNIFICANT, Estimate, estimate_mean, holm
from mrta_zoo.eval.studies.effects import Effect, Runs, arrange, effect_of, equal_weights
from mrta_zoo.eval.studies.held_out import Distribution, HeldOut
from mrta_zoo.eval.studies.job import seconds_of, trained_policy
from mrta_zoo.eval.studies.rows import RunRow
from mrta_zoo.eval.studies.sharing.arms import TRAINED_ROBOTS, Arm, Budget, Question
from mrta_zoo.policies.neural.policy import NeuralPolicy
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.verify import verify

DISTRIBUTION: Distribution = "taptc"
"""Its robots are of two kinds, and there are both in every team that is trained on."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """One arm against the shared one, at the same cost.

    Attributes:
        question: that it belongs to.
        arm: its name.
        effect: arm minus shared, mean over the numbers of robots that were trained on.
        by_robots: the same for each number of robots that both can decide for.
        adjusted: p-value, adjusted for the comparisons of the question; None if there is none.
    """

    question: Question
    arm: str
    effect: Effect
    by_robots: Mapping[int, Estimate]
    adjusted: float | None

    @property
    def sure(self) -> bool:
        """Whether there is a difference after adjustment."""
        return self.adjusted is not None and self.adjusted < SIGNIFICANT


@dataclass(frozen=True, kw_only=True)
class Study:
    """All of it.

    Attributes:
        questions: that were asked.
        arms: that were trained, by name, in the order of the questions.
        budget: of the runs.
        seeds: number of runs of each arm.
        held_out: the scenarios, with all the numbers of robots.
        rows: in order.
        curves: of each (arm, seed).
        folders: of each (arm, seed).
    """

    questions: Sequence[Question]
    arms: Mapping[str, Arm]
    budget: Budget
    seeds: int
    held_out: HeldOut
    rows: Sequence[RunRow]
    curves: Mapping[tuple[str, int], LearningCurve]
    folders: Mapping[tuple[str, int], Path]

    @cached_property
    def runs(self) -> dict[str, Runs]:
        """The runs of each arm: % completed of each scenario."""
        found = arrange(self.rows)
        return {name: found[name, DISTRIBUTION] for name in self.arms}

    @cached_property
    def policies(self) -> dict[tuple[str, int], NeuralPolicy]:
        """What each (arm, seed) has learned."""
        return {key: trained_policy(folder) for key, folder in self.folders.items()}

    def mean(self, arm: str, robots: Sequence[int]) -> Estimate:
        """% completed by an arm, mean over numbers of robots, with an interval that knows of runs and scenarios.

        Student's intervals may reach beyond what a share can be; there they end.
        """
        found = self._effect({arm: 1.0}, robots).difference
        if found.low is None or found.high is None:
            return found
        return replace(found, low=max(found.low, 0.0), high=min(found.high, 100.0))

    def nearest(self, robots: int) -> Estimate:
        """% completed by the nearest-feasible rule, with an interval that knows of scenarios."""
        solver, scenarios = make_solver("nearest"), self.held_out.scenarios(DISTRIBUTION, robots)
        return estimate_mean(
            [100 * verify(each, solver.solve(each)).completed / each.num_tasks for each in scenarios], 0
        )

    def comparisons(self) -> list[Comparison]:
        """Every arm of every question against its shared one."""
        return [each for question in self.questions for each in self._comparisons(question)]

    def _comparisons(self, question: Question) -> list[Comparison]:
        shared, *others = question.arms
        effects = [self._effect({arm: 1.0, shared: -1.0}, TRAINED_ROBOTS) for arm in others]
        adjusted = holm([effect.p for effect in effects])
        return [
            Comparison(
                question=question,
                arm=arm,
                effect=effect,
                by_robots={
                    robots: self._effect({arm: 1.0, shared: -1.0}, [robots]).difference
                    for robots in self.arms[arm].robots
                },
                adjusted=p,
            )
            for arm, effect, p in zip(others, effects, adjusted, strict=True)
        ]

    def _effect(self, coefficients: Mapping[str, float], robots: Sequence[int]) -> Effect:
        # Each arm's own scatter, as arms learn at different speeds. Simulated with three seeds, 94 to 96 of 100 such
        # intervals hold the true difference, also where one arm scatters three times as much as the other; with the
        # scatter pooled over arms it would be 88 then. With two seeds it is 93.
        pool = {name: self.runs[name] for name in coefficients}
        return effect_of(pool, coefficients, equal_weights(robots), {name: name for name in pool})

    def parameters(self, arm: str) -> int:
        """Weights of all networks of an arm together."""
        return sum(parameter.numel() for parameter in self.policies[arm, 0].network.parameters())

    def seconds(self, arm: str) -> float:
        """Wall-clock time of a run, mean over runs."""
        return fmean(seconds_of(self.folders[arm, seed]) for seed in range(self.seeds))

    def decisions(self, arm: str) -> float:
        """About how many decisions each network learned from, mean over its networks.

        Under the mask rule "feasible" a decision is a completed task, so that a mission has as many as it completes.
        """
        a_mission = self.budget.tasks * float(np.mean([self.mean(arm, [each]).mean for each in TRAINED_ROBOTS])) / 100
        return self.arms[arm].episodes * a_mission / self.arms[arm].networks

    def refusal(self, arm: str) -> tuple[int, str] | None:
        """The fewest robots that an arm has no policy for, and what it says then; None if it serves them all."""
        beyond = [robots for robots in self.held_out.robots if robots not in self.arms[arm].robots]
        if not beyond:
            return None
        scenario = self.held_out.scenarios(DISTRIBUTION, beyond[0])[0]
        try:
            self.policies[arm, 0].solve(scenario)
        except ConfigError as error:
            return beyond[0], str(error)
        raise AssertionError(f"{arm} serves {beyond[0]} robots")
