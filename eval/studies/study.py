"""A study: what was declared, what was measured, and the differences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from statistics import fmean
from typing import Literal

from mrta_zoo.errors import ConfigError
from mrta_zoo.eval.experiment import Experiment
from mrta_zoo.eval.machine import Machine
from mrta_zoo.eval.manifest import Manifest, make_manifest
from mrta_zoo.eval.plot_history import LearningCurve, read_history
from mrta_zoo.eval.significance import Estimate, estimate_mean
from mrta_zoo.eval.studies.design import Claim, Design, Question
from mrta_zoo.eval.studies.effects import Effect, Runs, adjusted, arrange, effect_of, equal_weights
from mrta_zoo.eval.studies.held_out import Distribution
from mrta_zoo.eval.studies.rows import RUN_KEY, RunRow
from mrta_zoo.eval.studies.run import mendable, trained_policy
from mrta_zoo.policies.neural.policy import NeuralPolicy
from mrta_zoo.policies.registry import make_solver
from mrta_zoo.train import checkpoint
from mrta_zoo.verify import verify

MAX_WORKERS = 1024
Verdict = Literal["supported", "not supported", "undecided"]
MATTERS = 1.0
"""Percentage points below which an advantage is not worth speaking of."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Contrast:
    """One arm against the reference of its question.

    Attributes:
        question: that it belongs to.
        distribution: of the held-out scenarios.
        arm: its name.
        effect: arm minus reference, mean over the numbers of robots that count; its p-value is adjusted for the
            contrasts of the question.
        by_robots: the same for each number of robots that both can decide for.
    """

    question: Question
    distribution: Distribution
    arm: str
    effect: Effect
    by_robots: Mapping[int, Effect]

    def named(self, name: str) -> str:
        """A name of the arm, with the scenarios where the question counts several kinds."""
        return f"{name}, on {self.distribution} scenarios" if len(self.question.distributions) > 1 else name


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """What a study found of a claim.

    Attributes:
        claim: that was tested.
        effect: greater than 0 if it holds; its p-value is adjusted for the number of claims.
    """

    claim: Claim
    effect: Effect

    @property
    def verdict(self) -> Verdict:
        """Supported if significant and as claimed; not supported if an advantage of `MATTERS` is ruled out."""
        difference = self.effect.difference
        if self.effect.significant and difference.mean > 0:
            return "supported"
        if difference.high is not None and difference.high < MATTERS:
            return "not supported"
        return "undecided"


@dataclass(frozen=True, kw_only=True)
class Study:
    """A finished study.

    Attributes:
        design: what was declared.
        manifest: what the rows depend on.
        machines: on which runs were trained.
        rows: of all runs, in order.
        curves: of each (arm, seed), in the order of the runs.
        folders: of each (arm, seed).
    """

    design: Design
    manifest: Manifest
    machines: Sequence[Machine]
    rows: Sequence[RunRow]
    curves: Mapping[tuple[str, int], LearningCurve]
    folders: Mapping[tuple[str, int], Path]

    @cached_property
    def runs(self) -> Mapping[tuple[str, str], Runs]:
        """The runs of each (arm, distribution): % completed of each scenario."""
        return arrange(self.rows)

    @cached_property
    def policies(self) -> dict[tuple[str, int], NeuralPolicy]:
        """What each (arm, seed) has learned."""
        return {key: trained_policy(folder) for key, folder in self.folders.items()}

    def effect(
        self,
        coefficients: Mapping[str, float],
        weights: Mapping[int, float] | None = None,
        distribution: Distribution = "taptc",
        among: Sequence[str] = (),
    ) -> Effect:
        """A weighted sum of arms, such as one minus another.

        Args:
            coefficients: of the arms.
            weights: of the numbers of robots; by default the mean over those that are compared.
            distribution: of the held-out scenarios.
            among: arms whose runs, too, say how much runs scatter, if they scatter alike.
        """
        kinds = {name: self.design.every_arm[name].kind for name in (*among, *coefficients)}
        asked = {kinds[name] for name in coefficients}
        pool = {name: self.runs[name, distribution] for name, kind in kinds.items() if kind in asked}
        return effect_of(pool, coefficients, weights or equal_weights(self.design.compared), kinds)

    def served(self, arm: str, distribution: str = "taptc") -> list[int]:
        """The numbers of robots that an arm was evaluated with."""
        return list(next(iter(self.runs[arm, distribution].values())))

    def mean(self, arm: str, distribution: Distribution, robots: Sequence[int]) -> Estimate:
        """% completed by an arm, mean over numbers of robots, with an interval that knows of runs and scenarios.

        Student's intervals may reach beyond what a share can be; there they end.
        """
        found = self.effect({arm: 1.0}, equal_weights(robots), distribution).difference
        if found.low is None or found.high is None:
            return found
        return replace(found, low=max(found.low, 0.0), high=min(found.high, 100.0))

    def gain(self, arm: str) -> float:
        """Points by which training has improved validation at its best, mean over runs."""
        curves = [curve.completion for (name, _), curve in self.curves.items() if name == arm]
        return 100 * fmean(max(curve) - curve[0] for curve in curves)

    @cached_property
    def contrasts(self) -> list[Contrast]:
        """Every arm of every question against its reference."""
        return [each for question in self.design.questions for each in self._contrasts(question)]

    def _contrasts(self, question: Question) -> list[Contrast]:
        pairs = [(distribution, arm) for distribution in question.distributions for arm in question.others]

        def effect(distribution: Distribution, arm: str, weights: Mapping[int, float] | None = None) -> Effect:
            return self.effect({arm: 1.0, question.reference: -1.0}, weights, distribution, question.arms)

        return [
            Contrast(
                question=question,
                distribution=distribution,
                arm=arm,
                effect=found,
                by_robots={robots: effect(distribution, arm, {robots: 1.0}) for robots in self.served(arm)},
            )
            for (distribution, arm), found in zip(pairs, adjusted([effect(*pair) for pair in pairs]), strict=True)
        ]

    @cached_property
    def answers(self) -> list[Answer]:
        """What was found of each claim whose question was asked."""
        claims = [claim for claim in self.design.claims if claim.question in self.design.questions]
        effects = [self.effect(claim.coefficients, claim.weights, among=claim.question.arms) for claim in claims]
        return [Answer(claim=claim, effect=each) for claim, each in zip(claims, adjusted(effects), strict=True)]

    def nearest(self, distribution: Distribution, robots: Sequence[int]) -> Estimate:
        """% completed by the nearest-feasible rule, with an interval that knows of scenarios."""
        solver, percent, strata = make_solver("nearest"), [], []
        for number in robots:
            for scenario in self.design.held_out.scenarios(distribution, number):
                percent.append(100 * verify(scenario, solver.solve(scenario)).completed / scenario.num_tasks)
                strata.append(number)
        return estimate_mean(percent, 0, strata)

    def seconds(self, arm: str) -> float:
        """Wall-clock time of a run's training, mean over runs."""
        found = []
        for seed in range(self.design.seeds):
            with mendable(self.folders[arm, seed]):
                found.append(checkpoint.seconds_spent(self.folders[arm, seed]))
        return fmean(found)


def perform_study(design: Design, out: Path, workers: int) -> Study:
    """Do the runs that are missing.

    Args:
        design: of the study.
        out: its folder, new, empty, or of the same study.
        workers: runs at a time, each with one CPU thread.

    Raises:
        MrtaError: if the folder holds anything else, a file cannot be read or written, or training diverges.
    """
    if not 1 <= workers <= MAX_WORKERS:
        raise ConfigError(f"workers is {workers}; expected a whole number from 1 to {MAX_WORKERS}")
    runs, manifest = design.runs(out), make_manifest(design.command, design.all_settings, design.cases())
    experiment = Experiment(out, manifest)
    rows = experiment.measure("rows.csv", RunRow, RUN_KEY, [run.cell for run in runs], workers)
    curves = {}
    for run in runs:
        with mendable(run.folder):
            curves[run.key] = read_history(run.folder)
    return Study(
        design=design,
        manifest=manifest,
        machines=experiment.machines,
        rows=rows,
        curves=curves,
        folders={run.key: run.folder for run in runs},
    )
